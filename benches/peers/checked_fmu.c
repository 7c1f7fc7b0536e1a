/* minimal_fmu.c with checks like ours, written as in a C FMU: it knows its components, refuses calls on a busy
 * instance or in the wrong state, arrays that are NULL or overlap, value references without a variable, values that
 * may not be set now or are beyond their limits, before anything is changed, and steps of an improper size, from
 * another time or past the stop time. Its variables have the value references of ours, with the gaps between, and a
 * step looks whether a tick is due. Compiled against the headers that FMPy ships. */

#include <float.h>
#include <math.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include "fmi2Functions.h"
#include "no_integers.h"

enum { REFERENCES = 2048 };
enum { INSTANTIATED = 1, INITIALIZATION = 2, STEP_COMPLETE = 4 };

typedef struct {
  const void* library;
  atomic_flag busy;
  int state;
  fmi2Real time, start, stop, sample_time;
  fmi2Boolean stop_defined;
  uint64_t tick;
  /* all by value reference */
  fmi2Real values[REFERENCES], min[REFERENCES], max[REFERENCES];
  uint8_t known[REFERENCES];
  int settable[REFERENCES];
} Instance;

static const char this_library = 0;

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* functions, fmi2Boolean visible, fmi2Boolean logging) {
  (void)name, (void)type, (void)guid, (void)resources, (void)functions, (void)visible, (void)logging;
  Instance* instance = calloc(1, sizeof(Instance));
  if (!instance) return NULL;
  instance->library = &this_library;
  instance->state = INSTANTIATED;
  instance->sample_time = 1e-3;
  for (size_t i = 0; i < REFERENCES; ++i) {
    instance->known[i] = i % 100 < 60;
    if (!instance->known[i]) continue;
    instance->min[i] = -DBL_MAX;
    instance->max[i] = DBL_MAX;
    instance->settable[i] = INSTANTIATED | INITIALIZATION | STEP_COMPLETE;
  }
  return instance;
}

void fmi2FreeInstance(fmi2Component component) { free(component); }

/* Whether the call may begin: then it ends with `leave`. */
static int enter(fmi2Component component, int states) {
  Instance* instance = component;
  if (!instance || (uintptr_t)instance % _Alignof(Instance) != 0 || instance->library != &this_library) return 0;
  if (atomic_flag_test_and_set_explicit(&instance->busy, memory_order_acquire)) return 0;
  if (instance->state & states) return 1;
  atomic_flag_clear_explicit(&instance->busy, memory_order_release);
  return 0;
}

static fmi2Status leave(fmi2Component component, fmi2Status status) {
  atomic_flag_clear_explicit(&((Instance*)component)->busy, memory_order_release);
  return status;
}

static int proper(const fmi2ValueReference references[], size_t count, const fmi2Real values[]) {
  const uintptr_t r = (uintptr_t)references, v = (uintptr_t)values;
  return count == 0 || (r && v && r % sizeof *references == 0 && v % sizeof *values == 0 && count <= SIZE_MAX / 16 &&
                        (r + count * sizeof *references <= v || v + count * sizeof *values <= r));
}

fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean tolerance_defined, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean stop_defined, fmi2Real stop) {
  (void)tolerance_defined, (void)tolerance;
  if (!enter(component, INSTANTIATED)) return fmi2Error;
  Instance* instance = component;
  instance->time = instance->start = start;
  instance->stop_defined = stop_defined;
  instance->stop = stop;
  return leave(component, fmi2OK);
}

static fmi2Status pass(fmi2Component component, int from, int to) {
  if (!enter(component, from)) return fmi2Error;
  ((Instance*)component)->state = to;
  return leave(component, fmi2OK);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component component) {
  return pass(component, INSTANTIATED, INITIALIZATION);
}

fmi2Status fmi2ExitInitializationMode(fmi2Component component) {
  return pass(component, INITIALIZATION, STEP_COMPLETE);
}

fmi2Status fmi2GetReal(fmi2Component component, const fmi2ValueReference references[], size_t count,
                       fmi2Real values[]) {
  if (!enter(component, INITIALIZATION | STEP_COMPLETE)) return fmi2Error;
  if (!proper(references, count, values)) return leave(component, fmi2Error);
  const Instance* instance = component;
  for (size_t i = 0; i < count; ++i) {
    if (references[i] >= REFERENCES || !instance->known[references[i]]) return leave(component, fmi2Error);
    values[i] = instance->values[references[i]];
  }
  return leave(component, fmi2OK);
}

fmi2Status fmi2SetReal(fmi2Component component, const fmi2ValueReference references[], size_t count,
                       const fmi2Real values[]) {
  if (!enter(component, INSTANTIATED | INITIALIZATION | STEP_COMPLETE)) return fmi2Error;
  if (!proper(references, count, values)) return leave(component, fmi2Error);
  Instance* instance = component;
  for (size_t i = 0; i < count; ++i) {
    const fmi2ValueReference r = references[i];
    if (r >= REFERENCES || !(instance->settable[r] & instance->state)) return leave(component, fmi2Error);
    if (!(instance->min[r] <= values[i] && values[i] <= instance->max[r])) return leave(component, fmi2Error);
  }
  for (size_t i = 0; i < count; ++i) instance->values[references[i]] = values[i];
  return leave(component, fmi2OK);
}

fmi2Status fmi2DoStep(fmi2Component component, fmi2Real time, fmi2Real step, fmi2Boolean no_set_state) {
  (void)no_set_state;
  if (!enter(component, STEP_COMPLETE)) return fmi2Error;
  Instance* instance = component;
  const fmi2Real from = instance->time, to = time + step;
  const fmi2Real tolerance = 1e-6 * step + 64 * DBL_EPSILON * fabs(from);
  const fmi2Real overshoot = 0.1 * (instance->stop - instance->start);
  if (!(step > 0 && step <= 100 && fabs(time - from) <= tolerance && to > from && fabs(to) <= 1e9) ||
      (instance->stop_defined &&
       (from > instance->stop + tolerance || to > instance->stop + overshoot + tolerance)))
    return leave(component, fmi2Error);
  const fmi2Real sample_time = instance->sample_time;
  if (instance->start + (fmi2Real)instance->tick * sample_time < to - 1e-6 * sample_time) ++instance->tick;
  instance->time = to;
  return leave(component, fmi2OK);
}
