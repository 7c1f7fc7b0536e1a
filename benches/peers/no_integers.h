/* The FMUs here have Real variables alone. */

fmi2Status fmi2SetInteger(fmi2Component component, const fmi2ValueReference references[], size_t count,
                          const fmi2Integer values[]) {
  (void)component, (void)references, (void)count, (void)values;
  return fmi2Error;
}
