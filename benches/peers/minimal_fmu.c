/* The least that an FMU can do, as a measure of what the calls themselves cost: values in an array, time that
 * passes. Compiled against the headers that FMPy ships. */

#include <stdlib.h>
#include "fmi2Functions.h"
#include "no_integers.h"

enum { VARIABLES = 256 };

typedef struct {
  fmi2Real values[VARIABLES];
  fmi2Real time;
} Instance;

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* functions, fmi2Boolean visible, fmi2Boolean logging) {
  (void)name, (void)type, (void)guid, (void)resources, (void)functions, (void)visible, (void)logging;
  return calloc(1, sizeof(Instance));
}

void fmi2FreeInstance(fmi2Component component) { free(component); }

fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean tolerance_defined, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean stop_defined, fmi2Real stop) {
  (void)tolerance_defined, (void)tolerance, (void)stop_defined, (void)stop;
  ((Instance*)component)->time = start;
  return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component component) { return component ? fmi2OK : fmi2Error; }
fmi2Status fmi2ExitInitializationMode(fmi2Component component) { return component ? fmi2OK : fmi2Error; }

fmi2Status fmi2GetReal(fmi2Component component, const fmi2ValueReference references[], size_t count,
                       fmi2Real values[]) {
  const Instance* instance = component;
  for (size_t i = 0; i < count; ++i) {
    if (references[i] >= VARIABLES) return fmi2Error;
    values[i] = instance->values[references[i]];
  }
  return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component component, const fmi2ValueReference references[], size_t count,
                       const fmi2Real values[]) {
  Instance* instance = component;
  for (size_t i = 0; i < count; ++i) {
    if (references[i] >= VARIABLES) return fmi2Error;
    instance->values[references[i]] = values[i];
  }
  return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component component, fmi2Real time, fmi2Real step, fmi2Boolean no_set_state) {
  (void)no_set_state;
  ((Instance*)component)->time = time + step;
  return fmi2OK;
}
