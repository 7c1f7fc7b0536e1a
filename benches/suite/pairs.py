"""Plant and controller together, by ways of different length."""

from __future__ import annotations

from time import perf_counter

import numpy as np
from rps3_study.fmu import Fmu, Instance

from suite import peers
from suite.peers import Native, fastest
from suite.table import Listing, Row, duration

TICKS = 400
TICK = 1e-3
MODES = {2: "DRAC", 4: "HDRAC with MPSO"}


def through_fmpy(plant: Fmu, controller: Fmu, mode: int) -> list[float]:
    """Seconds of each tick with FMPy, value references looked up beforehand and one call each way."""
    measured = [n for n in plant.names("output") if n in controller.names("input")]
    voltages = [n for n in controller.names("output") if n in plant.names("input")]

    def references(fmu: Fmu, names: list[str]) -> list[int]:
        return [fmu.variables[name].valueReference for name in names]

    from_plant, to_controller = references(plant, measured), references(controller, measured)
    from_controller, to_plant = references(controller, voltages), references(plant, voltages)
    with Instance(plant) as p, Instance(controller) as c:
        p.initialize()
        c.initialize({"control_mode": mode, **p.get(measured)})
        p, c = p.slave, c.slave
        marks = [perf_counter()]
        for k in range(TICKS):
            c.setReal(to_controller, p.getReal(from_plant))
            c.doStep(k * TICK, TICK)
            p.setReal(to_plant, c.getReal(from_controller))
            p.doStep(k * TICK, TICK)
            marks.append(perf_counter())
        return np.diff(marks).tolist()


def measure(native: Native, plant: Fmu, controller: Fmu, rounds: int) -> tuple[list[Row], Listing]:
    """All ways in turn, in two control modes."""
    rows, cells = [], []
    libraries = {"plant": peers.library(plant), "controller": peers.library(controller)}
    archives = {"plant": str(plant.archive), "controller": str(controller.archive)}
    for mode, name in MODES.items():
        inside: dict[str, np.ndarray] = {}

        def in_c(mode: int = mode, inside: dict[str, np.ndarray] = inside) -> list[float]:
            found = native.measure("pair_libraries", **libraries, mode=mode, ticks=TICKS)
            for part in ("plant", "controller"):
                inside[part] = np.minimum(inside.get(part, found[part]), found[part])
            return found["seconds"]

        times = fastest(
            rounds,
            {
                "native": lambda mode=mode: native.measure("pair_native", mode=mode, ticks=TICKS),
                "C": in_c,
                "crate": lambda mode=mode: native.measure("pair_fmi_crate", **archives, mode=mode, ticks=TICKS),
                "FMPy": lambda mode=mode: through_fmpy(plant, controller, mode),
            },
        )
        # timed in that way alone
        shares = {"C": ", ".join(f"{part} {inside[part].mean() / times['C']:.0%}" for part in ("controller", "plant"))}
        ways = {"C": "C functions of the FMUs", "crate": "crate `fmi` 0.8", "FMPy": "FMPy 0.3"}
        for key, way in ways.items():
            rows.append(Row(f"pair, {name}", "in process", times["native"], way, times[key]))
        for key, way in {"native": "in process, without FMI", **ways}.items():
            seconds = times[key]
            cells.append([name, way, duration(seconds), f"{TICK / seconds:.0f}", shares.get(key, "")])
    head = ["control mode", "way", "a tick", "times real time", "of which `fmi2DoStep`"]
    return rows, Listing("pair", head, cells)
