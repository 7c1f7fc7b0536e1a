"""A Co-Simulation step of the plant, and what calls of an FMU cost."""

from __future__ import annotations

import random

from rps3_study.fmu import Fmu

from suite import peers
from suite.peers import Native, fastest
from suite.table import Listing, Row, duration

TOLERANCE = 1e-6
# the FMU's solver works at a tenth of what is asked for
SOLVER_TOLERANCE = 1e-7
GOAL = 10e-6
STEPS = (1e-4, 1e-3, 1e-2, 1e-1)
# so short that no sample of the controller falls into it: nothing but the layer
EMPTY = 1e-9


def step(native: Native, plant: Fmu, rounds: int) -> tuple[list[Row], Listing]:
    """fmi2DoStep against the solver alone, and both over communication steps of all sizes."""
    library = peers.library(plant)
    rows, cells = [], []
    for size in STEPS:
        found: dict[str, float] = {}

        def alone(size: float = size, found: dict[str, float] = found) -> list[float]:
            found.update(native.measure("solver_step", step=size, tolerance=SOLVER_TOLERANCE))
            return found["seconds"]

        def whole(size: float = size) -> list[float]:
            return native.measure("plant_step", plant=library, step=size, tolerance=TOLERANCE)

        times = fastest(rounds, {"alone": alone, "whole": whole})
        if size == 1e-3:
            section, note = "plant, step of 1 ms", f"{found['evaluations']:.1f} right-hand sides a step"
            rows.append(Row(section, "`fmi2DoStep`", times["whole"], "goal", GOAL))
            rows.append(Row(section, "solver alone", times["alone"], "`fmi2DoStep`", times["whole"], note))
        cells.append(
            [
                duration(size),
                duration(times["whole"]),
                duration(times["alone"]),
                f"{found['evaluations']:.1f}",
                f"{size / times['whole']:.0f}",
            ]
        )
    head = ["communication step", "`fmi2DoStep`", "solver alone", "right-hand sides a step", "times real time"]
    return rows, Listing("communication-step", head, cells)


C_FMUS = {"minimal_fmu": "minimal C FMU", "checked_fmu": "C FMU with like checks"}


def calls(native: Native, plant: Fmu, controller: Fmu, rounds: int) -> list[Row]:
    """GetReal, SetReal and an empty DoStep against the least that an FMU can do, without checks and with like ones."""
    libraries = {name: peers.c_fmu(name) for name in C_FMUS}
    if None in libraries.values():
        return []
    outputs, inputs = plant.names("output", "Real"), controller.names("input", "Real")
    reading, writing = f"plant: `fmi2GetReal` of {len(outputs)}", f"controller: `fmi2SetReal` of {len(inputs)}"
    cases = {
        reading: (plant, "get", outputs),
        f"{reading} in random order": (plant, "get", shuffled(outputs)),
        writing: (controller, "set", inputs),
        f"{writing} in random order": (controller, "set", shuffled(inputs)),
        "controller: `fmi2DoStep` without a tick": (controller, "step", []),
    }
    times: dict[tuple[str, str], float] = {}
    for _ in range(rounds):
        for what, (fmu, call, names) in cases.items():
            references = [fmu.variables[name].valueReference for name in names]
            # the minimal C FMU's variables are numbered from 0 on, those of the other as ours
            numbers = [sorted(references).index(reference) for reference in references]
            measured = {"ours": (peers.library(fmu), references)}
            for name, library in libraries.items():
                measured[name] = (str(library), numbers if name == "minimal_fmu" else references)
            for whose, (library, asked) in measured.items():
                request = {"get": [], "set": [], "step": EMPTY} | ({} if call == "step" else {call: asked})
                found = native.measure("calls", library=library, guid=fmu.description.guid, rounds=20, **request)
                times[what, whose] = min(times.get((what, whose), found[call]), found[call])
    return [
        Row("FMI calls", title, times[what, name], what, times[what, "ours"])
        for what in cases
        for name, title in C_FMUS.items()
    ]


def shuffled(names: list[str]) -> list[str]:
    """The same in an order without order, always the same one."""
    return random.Random(1).sample(names, len(names))
