/* A host in C for every platform: couples both FMUs through the singularity, controller first.
 *
 *   crossing PLANT_LIBRARY PLANT_GUID CONTROLLER_LIBRARY CONTROLLER_GUID PLAN RESULT
 *
 * PLAN is a text of value references: the number of steps; the pairs (plant output, controller input); the pairs
 * (controller output, plant input); the plant's outputs to record; the controller's, each list led by its length.
 * RESULT gets the recorded values of each communication point as doubles.
 */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "fmi2FunctionTypes.h"

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#define STEP 1e-3
#define TOLERANCE 1e-6
#define MOST 128

typedef struct {
    size_t length;
    fmi2ValueReference references[MOST];
} List;

/* What is read from one FMU and written to the other. */
typedef struct {
    List from, to;
} Connections;

typedef struct {
    const char *name;
    fmi2Component component;
    fmi2EnterInitializationModeTYPE *enterInitializationMode;
    fmi2ExitInitializationModeTYPE *exitInitializationMode;
    fmi2DoStepTYPE *doStep;
    fmi2GetRealTYPE *getReal;
    fmi2SetRealTYPE *setReal;
    fmi2TerminateTYPE *terminate;
    fmi2FreeInstanceTYPE *freeInstance;
} Fmu;

static void fail(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    exit(1);
}

static void *load(const char *path) {
#ifdef _WIN32
    void *library = (void *)LoadLibraryA(path);
    if (!library) fail("%s does not load: error %lu", path, GetLastError());
#else
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) fail("%s", dlerror());
#endif
    return library;
}

static void *find(void *library, const char *name) {
#ifdef _WIN32
    void *function = (void *)GetProcAddress((HMODULE)library, name);
#else
    void *function = dlsym(library, name);
#endif
    if (!function) fail("no function %s", name);
    return function;
}

static void logger(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category,
                   fmi2String format, ...) {
    (void)environment;
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "%s, %s, status %d: ", instance, category, (int)status);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

static void require(const Fmu *fmu, fmi2Status status, const char *what) {
    if (status != fmi2OK) fail("%s: %s returned %d", fmu->name, what, (int)status);
}

/* An instance in Initialization Mode. A wrong GUID must have been refused, and logged, before. */
static Fmu instantiate(const char *name, const char *path, const char *guid, fmi2Real stop) {
    void *library = load(path);
    fmi2InstantiateTYPE *create = find(library, "fmi2Instantiate");
    fmi2SetupExperimentTYPE *setup = find(library, "fmi2SetupExperiment");
    Fmu fmu = {
        name,
        NULL,
        find(library, "fmi2EnterInitializationMode"),
        find(library, "fmi2ExitInitializationMode"),
        find(library, "fmi2DoStep"),
        find(library, "fmi2GetReal"),
        find(library, "fmi2SetReal"),
        find(library, "fmi2Terminate"),
        find(library, "fmi2FreeInstance"),
    };
    fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, NULL};
    if (create(name, fmi2CoSimulation, "{wrong}", NULL, &callbacks, fmi2False, fmi2False)) fail("a wrong GUID was taken");
    fmu.component = create(name, fmi2CoSimulation, guid, NULL, &callbacks, fmi2False, fmi2False);
    if (!fmu.component) fail("%s: no instance", name);
    require(&fmu, setup(fmu.component, fmi2True, TOLERANCE, 0.0, fmi2True, stop), "fmi2SetupExperiment");
    require(&fmu, fmu.enterInitializationMode(fmu.component), "fmi2EnterInitializationMode");
    return fmu;
}

static void transfer(const Fmu *from, const Fmu *to, const Connections *connections) {
    fmi2Real values[MOST];
    const List *read = &connections->from, *write = &connections->to;
    require(from, from->getReal(from->component, read->references, read->length, values), "fmi2GetReal");
    require(to, to->setReal(to->component, write->references, write->length, values), "fmi2SetReal");
}

static void record(const Fmu *fmu, const List *list, FILE *result) {
    fmi2Real values[MOST];
    require(fmu, fmu->getReal(fmu->component, list->references, list->length, values), "fmi2GetReal");
    if (fwrite(values, sizeof values[0], list->length, result) != list->length) fail("the result cannot be written");
}

static void step(const Fmu *fmu, int k) {
    require(fmu, fmu->doStep(fmu->component, k * STEP, STEP, fmi2True), "fmi2DoStep");
}

static void end(const Fmu *fmu) {
    require(fmu, fmu->terminate(fmu->component), "fmi2Terminate");
    fmu->freeInstance(fmu->component);
}

static FILE *open(const char *path, const char *mode) {
    FILE *file = fopen(path, mode);
    if (!file) fail("%s cannot be opened", path);
    return file;
}

static unsigned next(FILE *plan) {
    unsigned number;
    if (fscanf(plan, "%u", &number) != 1) fail("the plan is too short");
    return number;
}

static size_t next_length(FILE *plan) {
    size_t length = next(plan);
    if (length > MOST) fail("the plan's lists are too long");
    return length;
}

static List next_list(FILE *plan) {
    List list = {next_length(plan), {0}};
    for (size_t i = 0; i < list.length; i++) list.references[i] = next(plan);
    return list;
}

static Connections next_connections(FILE *plan) {
    Connections c = {{next_length(plan), {0}}, {0, {0}}};
    c.to.length = c.from.length;
    for (size_t i = 0; i < c.from.length; i++) {
        c.from.references[i] = next(plan);
        c.to.references[i] = next(plan);
    }
    return c;
}

int main(int argc, char **argv) {
    if (argc != 7) fail("usage: crossing PLANT GUID CONTROLLER GUID PLAN RESULT");
    FILE *plan = open(argv[5], "r"), *result = open(argv[6], "wb");
    int steps = (int)next(plan);
    Connections measured = next_connections(plan), voltages = next_connections(plan);
    List of_plant = next_list(plan), of_controller = next_list(plan);
    fclose(plan);

    Fmu plant = instantiate("plant", argv[1], argv[2], steps * STEP);
    require(&plant, plant.exitInitializationMode(plant.component), "fmi2ExitInitializationMode");
    Fmu controller = instantiate("controller", argv[3], argv[4], steps * STEP);
    transfer(&plant, &controller, &measured);
    require(&controller, controller.exitInitializationMode(controller.component), "fmi2ExitInitializationMode");
    for (int k = 0; k < steps; k++) {
        record(&plant, &of_plant, result);
        transfer(&plant, &controller, &measured);
        step(&controller, k);
        transfer(&controller, &plant, &voltages);
        record(&controller, &of_controller, result);
        step(&plant, k);
    }
    end(&controller);
    end(&plant);
    if (fclose(result) != 0) fail("the result cannot be written");
    return 0;
}
