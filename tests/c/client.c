/* A host in C, compiled against the standard's headers: drives a real shared library.
 *
 *   client LIBRARY GUID FIRST LAST run           one Co-Simulation and one Model Exchange run
 *   client LIBRARY GUID FIRST LAST cycles N      N times instantiate, run, free: no growth
 *   client LIBRARY GUID FIRST LAST loads N       N times load, instantiate, run, free, unload: no growth
 *   client LIBRARY GUID FIRST LAST reload N      the same unmeasured, for tools with a heap of their own
 *   client LIBRARY GUID FIRST LAST threads N     N instances on N threads: the bits of serial runs
 *   client LIBRARY GUID FIRST LAST later N       the same, after a first instance in the main thread: for
 *                                                tools that do not see how the first one is made safely
 *   client LIBRARY GUID FIRST LAST traps N       N steps with floating-point exceptions that trap
 *
 * FIRST to LAST are the value references of Real outputs. Ends with 0 if all is well, and says
 * what is wrong on stderr if not. Linux only, for /proc.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fenv.h>
#include <malloc.h>
#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fmi2FunctionTypes.h"

#define MOST_OUTPUTS 256
#define MOST_STATES 32
#define STEP 1e-3

/* The functions that the runs need. */
typedef struct {
    void *handle;
    fmi2InstantiateTYPE *instantiate;
    fmi2FreeInstanceTYPE *freeInstance;
    fmi2SetupExperimentTYPE *setupExperiment;
    fmi2EnterInitializationModeTYPE *enterInitializationMode;
    fmi2ExitInitializationModeTYPE *exitInitializationMode;
    fmi2TerminateTYPE *terminate;
    fmi2ResetTYPE *reset;
    fmi2GetRealTYPE *getReal;
    fmi2SetRealTYPE *setReal;
    fmi2DoStepTYPE *doStep;
    fmi2GetFMUstateTYPE *getFMUstate;
    fmi2SetFMUstateTYPE *setFMUstate;
    fmi2FreeFMUstateTYPE *freeFMUstate;
    fmi2SerializedFMUstateSizeTYPE *serializedFMUstateSize;
    fmi2SerializeFMUstateTYPE *serializeFMUstate;
    fmi2DeSerializeFMUstateTYPE *deSerializeFMUstate;
    fmi2NewDiscreteStatesTYPE *newDiscreteStates;
    fmi2EnterEventModeTYPE *enterEventMode;
    fmi2EnterContinuousTimeModeTYPE *enterContinuousTimeMode;
    fmi2SetTimeTYPE *setTime;
    fmi2GetContinuousStatesTYPE *getContinuousStates;
    fmi2SetContinuousStatesTYPE *setContinuousStates;
    fmi2GetDerivativesTYPE *getDerivatives;
    fmi2CompletedIntegratorStepTYPE *completedIntegratorStep;
} Library;

static const char *path, *guid;
static fmi2ValueReference references[MOST_OUTPUTS];
static size_t outputs;

static void fail(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    exit(1);
}

static void require(fmi2Status status, const char *what) {
    if (status != fmi2OK) fail("%s returned status %d", what, (int)status);
}

static void *symbol(void *handle, const char *name) {
    void *found = dlsym(handle, name);
    if (!found) fail("%s", dlerror());
    return found;
}

static Library load(void) {
    Library l;
    l.handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!l.handle) fail("%s", dlerror());
#define FIND(field, name) l.field = symbol(l.handle, "fmi2" name)
    FIND(instantiate, "Instantiate");
    FIND(freeInstance, "FreeInstance");
    FIND(setupExperiment, "SetupExperiment");
    FIND(enterInitializationMode, "EnterInitializationMode");
    FIND(exitInitializationMode, "ExitInitializationMode");
    FIND(terminate, "Terminate");
    FIND(reset, "Reset");
    FIND(getReal, "GetReal");
    FIND(setReal, "SetReal");
    FIND(doStep, "DoStep");
    FIND(getFMUstate, "GetFMUstate");
    FIND(setFMUstate, "SetFMUstate");
    FIND(freeFMUstate, "FreeFMUstate");
    FIND(serializedFMUstateSize, "SerializedFMUstateSize");
    FIND(serializeFMUstate, "SerializeFMUstate");
    FIND(deSerializeFMUstate, "DeSerializeFMUstate");
    FIND(newDiscreteStates, "NewDiscreteStates");
    FIND(enterEventMode, "EnterEventMode");
    FIND(enterContinuousTimeMode, "EnterContinuousTimeMode");
    FIND(setTime, "SetTime");
    FIND(getContinuousStates, "GetContinuousStates");
    FIND(setContinuousStates, "SetContinuousStates");
    FIND(getDerivatives, "GetDerivatives");
    FIND(completedIntegratorStep, "CompletedIntegratorStep");
#undef FIND
    return l;
}

static void logger(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category,
                   fmi2String format, ...) {
    (void)environment;
    va_list arguments;
    va_start(arguments, format);
    if (status != fmi2OK) {
        fprintf(stderr, "%s, %s, status %d: ", instance, category, (int)status);
        vfprintf(stderr, format, arguments);
        fputc('\n', stderr);
    }
    va_end(arguments);
}

static fmi2Component instantiate(const Library *l, fmi2Type type) {
    /* on the stack: the library has to copy what it is given */
    fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, NULL};
    char name[32], id[64];
    snprintf(name, sizeof name, "client");
    snprintf(id, sizeof id, "%s", guid);
    fmi2Component c = l->instantiate(name, type, id, "file:///nowhere", &callbacks, fmi2False, fmi2False);
    memset(&callbacks, 0xff, sizeof callbacks);
    memset(name, 0xff, sizeof name);
    if (!c) fail("no instance");
    return c;
}

static void initialize(const Library *l, fmi2Component c) {
    require(l->setupExperiment(c, fmi2True, 1e-6, 0.0, fmi2False, 0.0), "fmi2SetupExperiment");
    require(l->enterInitializationMode(c), "fmi2EnterInitializationMode");
    require(l->exitInitializationMode(c), "fmi2ExitInitializationMode");
}

/* FNV-1a over the bits of all outputs. */
static uint64_t hash_outputs(const Library *l, fmi2Component c, uint64_t hash) {
    double values[MOST_OUTPUTS];
    require(l->getReal(c, references, outputs, values), "fmi2GetReal");
    const unsigned char *bytes = (const unsigned char *)values;
    for (size_t i = 0; i < outputs; i++)
        if (!isfinite(values[i])) fail("output %u is not finite", references[i]);
    for (size_t i = 0; i < outputs * sizeof values[0]; i++) hash = (hash ^ bytes[i]) * 1099511628211u;
    return hash;
}

/* Steps from `from` to `to`, counted in steps. The first input follows `seed`. */
static uint64_t advance(const Library *l, fmi2Component c, int from, int to, unsigned seed, uint64_t hash) {
    const fmi2ValueReference input = 1;
    double start;
    require(l->getReal(c, &input, 1, &start), "fmi2GetReal");
    for (int k = from; k < to; k++) {
        double value = start + 1e-4 * (double)((k * (int)(seed + 1)) % 7);
        require(l->setReal(c, &input, 1, &value), "fmi2SetReal");
        require(l->doStep(c, k * STEP, STEP, fmi2True), "fmi2DoStep");
        hash = hash_outputs(l, c, hash);
    }
    require(l->setReal(c, &input, 1, &start), "fmi2SetReal");
    return hash;
}

static uint64_t co_simulation(const Library *l, int steps, unsigned seed) {
    fmi2Component c = instantiate(l, fmi2CoSimulation);
    initialize(l, c);
    uint64_t hash = advance(l, c, 0, steps, seed, 14695981039346656037u);
    require(l->terminate(c), "fmi2Terminate");
    l->freeInstance(c);
    return hash;
}

/* Rollback, in memory and through bytes, and a state that is left to fmi2FreeInstance. */
static void states(const Library *l, int steps) {
    fmi2Component c = instantiate(l, fmi2CoSimulation);
    initialize(l, c);
    fmi2FMUstate state = NULL, copy = NULL, abandoned = NULL;
    size_t size = 0;
    require(l->getFMUstate(c, &state), "fmi2GetFMUstate");
    require(l->getFMUstate(c, &abandoned), "fmi2GetFMUstate");
    require(l->serializedFMUstateSize(c, state, &size), "fmi2SerializedFMUstateSize");
    fmi2Byte *bytes = malloc(size);
    require(l->serializeFMUstate(c, state, bytes, size), "fmi2SerializeFMUstate");
    uint64_t once = advance(l, c, 0, steps, 1, 0);
    require(l->setFMUstate(c, state), "fmi2SetFMUstate");
    uint64_t again = advance(l, c, 0, steps, 1, 0);
    require(l->deSerializeFMUstate(c, bytes, size, &copy), "fmi2DeSerializeFMUstate");
    require(l->setFMUstate(c, copy), "fmi2SetFMUstate");
    uint64_t from_bytes = advance(l, c, 0, steps, 1, 0);
    if (once != again || once != from_bytes) fail("a restored state has another future");
    bytes[size / 2] ^= 1;
    fmi2FMUstate none = NULL;
    if (l->deSerializeFMUstate(c, bytes, size, &none) != fmi2Error || none) fail("a spoiled state was taken");
    require(l->freeFMUstate(c, &state), "fmi2FreeFMUstate");
    require(l->freeFMUstate(c, &copy), "fmi2FreeFMUstate");
    require(l->reset(c), "fmi2Reset");
    initialize(l, c);
    if (advance(l, c, 0, steps, 1, 0) != once) fail("a reset instance has another future");
    free(bytes);
    l->freeInstance(c);
}

/* Explicit Euler with time events. */
static void model_exchange(const Library *l, int steps, size_t n) {
    fmi2Component c = instantiate(l, fmi2ModelExchange);
    initialize(l, c);
    double x[MOST_STATES], der[MOST_STATES];
    fmi2EventInfo event = {0};
    require(l->newDiscreteStates(c, &event), "fmi2NewDiscreteStates");
    require(l->enterContinuousTimeMode(c), "fmi2EnterContinuousTimeMode");
    const double h = STEP / 10;
    for (int k = 1; k <= 10 * steps; k++) {
        require(l->getContinuousStates(c, x, n), "fmi2GetContinuousStates");
        require(l->getDerivatives(c, der, n), "fmi2GetDerivatives");
        require(l->setTime(c, k * h), "fmi2SetTime");
        for (size_t i = 0; i < n; i++) x[i] += h * der[i];
        require(l->setContinuousStates(c, x, n), "fmi2SetContinuousStates");
        fmi2Boolean enter = fmi2False, end = fmi2False;
        require(l->completedIntegratorStep(c, fmi2True, &enter, &end), "fmi2CompletedIntegratorStep");
        if (enter || (event.nextEventTimeDefined && event.nextEventTime <= k * h)) {
            require(l->enterEventMode(c), "fmi2EnterEventMode");
            require(l->newDiscreteStates(c, &event), "fmi2NewDiscreteStates");
            require(l->enterContinuousTimeMode(c), "fmi2EnterContinuousTimeMode");
        }
    }
    hash_outputs(l, c, 0);
    require(l->terminate(c), "fmi2Terminate");
    l->freeInstance(c);
}

/* The number of continuous states: the one size that is not refused. */
static size_t count_states(const Library *l) {
    fmi2CallbackFunctions silent = {NULL, NULL, NULL, NULL, NULL};
    fmi2Component c = l->instantiate("size", fmi2ModelExchange, guid, NULL, &silent, fmi2False, fmi2False);
    if (!c) fail("no instance");
    initialize(l, c);
    double x[MOST_STATES];
    size_t n = 0;
    while (n <= MOST_STATES && l->getContinuousStates(c, x, n) != fmi2OK) n++;
    l->freeInstance(c);
    return n;
}

/* Bytes in use on the heap, and pages in memory. */
static size_t heap(void) { return mallinfo2().uordblks; }

static long pages(void) {
    long size = 0, resident = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%ld %ld", &size, &resident) != 2) fail("/proc/self/statm cannot be read");
    fclose(file);
    return resident;
}

/* `n` times `work`; what the first tenth leaves behind is allowed once. */
static void without_growth(int n, void (*work)(const Library *), const Library *l) {
    int warm = n / 10 + 1;
    for (int k = 0; k < warm; k++) work(l);
    pages(); /* the C library keeps a stream's memory for the next one */
    size_t heap_before = heap();
    long pages_before = pages();
    for (int k = 0; k < n; k++) work(l);
    long grown = (long)(heap() - heap_before), more_pages = pages() - pages_before;
    printf("%d cycles: heap %+ld bytes, resident %+ld pages\n", n, grown, more_pages);
    /* less than a byte a cycle would show in 10 000; what allocator and kernel keep varies by some pages */
    if (grown > 8192 || more_pages > 256) fail("memory grows");
}

static void one_cycle(const Library *l) { co_simulation(l, 2, 0); }

static void one_load(const Library *unused) {
    (void)unused;
    Library l = load();
    co_simulation(&l, 2, 0);
    if (dlclose(l.handle) != 0) fail("%s", dlerror());
}

#define THREAD_STEPS 30
#define THREAD_STACK (128 * 1024)

typedef struct {
    const Library *library;
    unsigned seed;
    uint64_t hash;
} Job;

static void *thread(void *argument) {
    Job *job = argument;
    job->hash = co_simulation(job->library, THREAD_STEPS, job->seed);
    return NULL;
}

static void threads(const Library *l, int n) {
    pthread_t *ids = calloc((size_t)n, sizeof *ids);
    Job *jobs = calloc((size_t)n, sizeof *jobs);
    /* as small a stack as hosts are known to give */
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    if (pthread_attr_setstacksize(&attributes, THREAD_STACK)) fail("no such stack");
    for (int k = 0; k < n; k++) {
        jobs[k] = (Job){l, (unsigned)k % 16, 0};
        if (pthread_create(&ids[k], &attributes, thread, &jobs[k])) fail("no thread");
    }
    pthread_attr_destroy(&attributes);
    for (int k = 0; k < n; k++) pthread_join(ids[k], NULL);
    for (int k = 0; k < n; k++) {
        if (jobs[k].hash != co_simulation(l, THREAD_STEPS, jobs[k].seed)) fail("thread %d has other bits", k);
    }
    free(ids);
    free(jobs);
}

int main(int argc, char **argv) {
    if (argc < 6) fail("usage: client LIBRARY GUID FIRST LAST run|cycles|loads|reload|threads|later|traps [N]");
    path = argv[1];
    guid = argv[2];
    for (unsigned vr = (unsigned)atoi(argv[3]); vr <= (unsigned)atoi(argv[4]); vr++) {
        if (outputs == MOST_OUTPUTS) fail("too many outputs");
        references[outputs++] = vr;
    }
    const char *what = argv[5];
    int n = argc > 6 ? atoi(argv[6]) : 1;
    if (!strcmp(what, "loads")) {
        without_growth(n, one_load, NULL);
        return 0;
    }
    if (!strcmp(what, "reload")) {
        for (int k = 0; k < n; k++) one_load(NULL);
        return 0;
    }
    Library l = load();
    if (!strcmp(what, "run")) {
        co_simulation(&l, n, 0);
        states(&l, n);
        model_exchange(&l, n, count_states(&l));
    } else if (!strcmp(what, "cycles")) {
        without_growth(n, one_cycle, &l);
    } else if (!strcmp(what, "threads")) {
        threads(&l, n);
    } else if (!strcmp(what, "later")) {
        one_cycle(&l);
        threads(&l, n);
    } else if (!strcmp(what, "traps")) {
        feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
        co_simulation(&l, n, 0);
    } else {
        fail("what is %s?", what);
    }
    dlclose(l.handle);
    return 0;
}
