"""Model Exchange under CVode, its Jacobian by differences or by fmi2GetDirectionalDerivative."""

from __future__ import annotations

from ctypes import POINTER, c_double
from time import perf_counter

import numpy as np
from rps3_study.fmu import Fmu, ModelInstance
from sksundae.cvode import CVODE

from suite.table import Listing, Row

DURATION = 0.3
LOAD = {"f_ext_x": 20.0, "f_ext_y": -10.0, "f_ext_z": 15.0}
TOLERANCES = (1e-4, 1e-6, 1e-8)
STATES = 12
NOMINAL = np.array([0.1] * 3 + [1.0] * 9)


def pointer(values: np.ndarray) -> object:
    """An array as C sees it."""
    return values.ctypes.data_as(POINTER(c_double))


class Problem:
    """The plant under a load from rest, with the voltages that hold it."""

    def __init__(self, plant: Fmu) -> None:
        self.instance = ModelInstance(plant)
        self.slave = self.instance.slave
        self.instance.initialize()
        self.slave.enterEventMode()
        self.slave.newDiscreteStates()
        currents = self.instance.get([f"i_{kind}{i}" for kind in ("leg", "rev") for i in (1, 2, 3)])
        resistance = self.instance["motor_ra"]
        voltages = {name.replace("i_", "v_"): current * resistance for name, current in currents.items()}
        self.instance.set({**voltages, **LOAD})
        self.slave.enterContinuousTimeMode()
        self.start = np.zeros(STATES)
        self.slave.fmi2GetContinuousStates(self.slave.component, pointer(self.start), STATES)
        derivatives = [v for v in plant.description.modelVariables if v.derivative is not None]
        self.derivatives = [v.valueReference for v in derivatives]
        self.state_references = [v.derivative.valueReference for v in derivatives]
        self.values = np.zeros(STATES)

    def right_hand_side(self, t: float, x: np.ndarray, x_dot: np.ndarray) -> None:
        self.slave.setTime(t)
        self.slave.fmi2SetContinuousStates(self.slave.component, pointer(np.ascontiguousarray(x)), STATES)
        self.slave.fmi2GetDerivatives(self.slave.component, pointer(self.values), STATES)
        x_dot[:] = self.values

    def jacobian(self, t: float, x: np.ndarray, _x_dot: np.ndarray, matrix: np.ndarray) -> None:
        self.right_hand_side(t, x, np.empty(STATES))
        for j, reference in enumerate(self.state_references):
            matrix[:, j] = self.slave.getDirectionalDerivative(self.derivatives, [reference], [1.0])


def solve(problem: Problem, tolerance: float, exact: bool) -> tuple[float, int, int, np.ndarray]:
    """Seconds, right-hand sides, Jacobians and the end of one run."""
    count = [0, 0]

    def right_hand_side(t: float, x: np.ndarray, x_dot: np.ndarray) -> None:
        count[0] += 1
        problem.right_hand_side(t, x, x_dot)

    def jacobian(t: float, x: np.ndarray, x_dot: np.ndarray, matrix: np.ndarray) -> None:
        count[1] += 1
        problem.jacobian(t, x, x_dot, matrix)

    options = {"jacfn": jacobian} if exact else {}
    solver = CVODE(right_hand_side, rtol=tolerance, atol=tolerance * NOMINAL, max_num_steps=100_000, **options)
    begin = perf_counter()
    solution = solver.solve([0.0, DURATION], problem.start)
    return perf_counter() - begin, count[0], count[1], np.asarray(solution.y[-1])


def measure(plant: Fmu, rounds: int) -> tuple[list[Row], Listing]:
    """Both kinds of Jacobian at several tolerances, in turn."""
    problem = Problem(plant)
    cells, rows = [], []
    for tolerance in TOLERANCES:
        best = {}
        for _ in range(rounds):
            for exact in (True, False):
                found = solve(problem, tolerance, exact)
                best[exact] = min(best.get(exact, found), found, key=lambda found: found[0])
        with_, without = best[True], best[False]
        cells.append(
            [
                f"{tolerance:.0e}",
                f"{without[1]}",
                f"{with_[1]} and {with_[2]} Jacobians",
                f"{1 - with_[1] / without[1]:.0%}",
                f"{without[0] / with_[0]:.2f}",
            ]
        )
        if tolerance == 1e-6:
            rows.append(
                Row(
                    "Model Exchange, CVode at 1e-6", "Jacobian by directional derivatives", with_[0],
                    "by differences", without[0], f"{with_[1]} instead of {without[1]} right-hand sides",
                )
            )  # fmt: skip
    problem.instance.free()
    head = ["tolerance", "right-hand sides, differences", "with directional derivatives", "saved", "time, b / a"]
    return rows, Listing("model-exchange", head, cells)
