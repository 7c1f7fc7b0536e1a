"""A Co-Simulation step of the plant, and what calls of an FMU cost."""

from __future__ import annotations

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


def calls(native: Native, plant: Fmu, controller: Fmu, rounds: int) -> list[Row]:
    """GetReal, SetReal and an empty DoStep against the least that an FMU can do."""
    minimal = peers.minimal_fmu()
    if minimal is None:
        return []
    plant_outputs = plant.names("output")
    inputs = controller.names("input", "Real")
    measured = {
        "plant": (plant, plant_outputs, plant.names("input")[:6]),
        "controller": (controller, controller.names("output", "Real"), inputs),
    }
    times: dict[str, dict[str, float]] = {}
    for name, (fmu, get, put) in measured.items():
        ours = {
            "library": peers.library(fmu),
            "guid": fmu.description.guid,
            "get": [fmu.variables[variable].valueReference for variable in get],
            "set": [fmu.variables[variable].valueReference for variable in put],
            "step": EMPTY,
        }
        theirs = {**ours, "library": str(minimal), "get": list(range(len(get))), "set": list(range(len(put)))}
        for key in (name, f"{name} minimal"):
            times[key] = dict.fromkeys(("set", "step", "get"), float("inf"))
        for _ in range(rounds):
            for key, request in ((name, ours), (f"{name} minimal", theirs)):
                found = native.measure("calls", **request, rounds=20)
                times[key] = {call: min(least, found[call]) for call, least in times[key].items()}
    calls_of = {
        ("plant", "get"): f"plant: `fmi2GetReal` of {len(plant_outputs)}",
        ("controller", "set"): f"controller: `fmi2SetReal` of {len(inputs)}",
        ("controller", "step"): "controller: `fmi2DoStep` without a tick",
    }
    return [
        Row("FMI calls", "minimal C FMU", times[f"{name} minimal"][call], what, times[name][call])
        for (name, call), what in calls_of.items()
    ]
