"""The master: steps controller and plant together and records both."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from fmpy.fmi1 import FMICallException

from rps3_study.channel import Channel
from rps3_study.fmu import Fmu, Instance, Message, Value

Exchange = Literal["gauss-seidel", "jacobi"]
Disturbance = Callable[[float], Mapping[str, float]]


@dataclass
class Run:
    """A coupled run: trajectories over `time` (s) under the names `plant.<output>` and `controller.<output>`.

    The entry at t holds the plant's outputs at t and the controller's outputs from t on.
    """

    values: dict[str, np.ndarray]
    failure: str | None = None
    messages: list[Message] = field(default_factory=list)

    @property
    def time(self) -> np.ndarray:
        """Communication points, s."""
        return self.values["time"]

    def __getitem__(self, name: str) -> np.ndarray:
        return self.values[name]


def run_crossing(
    plant: Fmu,
    controller: Fmu,
    plant_parameters: Mapping[str, Value] | None = None,
    controller_parameters: Mapping[str, Value] | None = None,
    *,
    step: float = 1e-3,
    stop_time: float = 1.4,
    tolerance: float | None = 1e-6,
    disturbance: Disturbance | None = None,
    exchange: Exchange = "gauss-seidel",
    offsets: Mapping[str, float] | None = None,
    progress: Callable[[float], object] | None = None,
) -> Run:
    """Couples both FMUs by equal variable names from 0 to `stop_time`.

    Args:
        plant: the Rps3Plant FMU.
        controller: the Rps3Controller FMU.
        plant_parameters: parameters of the plant that differ from their starts.
        controller_parameters: parameters of the controller that differ from their starts.
        step: communication step, s.
        stop_time: end of the run, s.
        tolerance: relative tolerance of the plant's solver, none for the FMU's default.
        disturbance: further inputs of the plant (N, N.m) at a time in s.
        exchange: "gauss-seidel": the controller steps first and the plant gets its new voltages;
            "jacobi": both step with the values of the step's start, so voltages arrive one step late.
        offsets: added to what the controller measures, by the name of its input: sensors zeroed elsewhere.
        progress: called with the time reached after each step, s.

    Returns:
        The trajectories. Where a call failed, they end there and `failure` says what happened.
    """
    to_plant = [name for name in plant.names("input") if name in controller.names("output")]
    to_controller = [name for name in controller.names("input") if name in plant.names("output")]
    plant_outputs, controller_outputs = plant.names("output"), controller.names("output")
    columns = ["time", *(f"plant.{n}" for n in plant_outputs), *(f"controller.{n}" for n in controller_outputs)]
    measured = [columns.index(f"plant.{name}") for name in to_controller]
    commanded = [columns.index(f"controller.{name}") for name in to_plant]
    zeroing = np.array([(offsets or {}).get(name, 0.0) for name in to_controller])
    count = round(stop_time / step)
    table = np.empty((count + 1, len(columns)))
    complete = 0
    failure = None

    with Instance(plant, "plant") as p, Instance(controller, "controller") as c:
        plant_side, sensors = Channel(p, plant_outputs), Channel(c, to_controller)
        controller_side, motors = Channel(c, controller_outputs), Channel(p, to_plant)
        try:
            p.initialize(plant_parameters, stop_time=stop_time, tolerance=tolerance)
            c.set(controller_parameters or {})
            c.setup(stop_time=stop_time)
            for k, row in enumerate(table):
                t = k * step
                row[0] = t
                of_plant, of_controller = np.split(row[1:], [len(plant_outputs)])
                if disturbance is not None:
                    p.set(disturbance(t))
                plant_side.read(of_plant)
                if k == 0:
                    sensors.write(row[measured] + zeroing)
                    c.slave.exitInitializationMode()
                if k == count:
                    # there is no tick at the end: the last one's outputs still hold
                    controller_side.read(of_controller)
                    complete += 1
                    break
                sensors.write(row[measured] + zeroing)
                if exchange == "jacobi":
                    controller_side.read(of_controller)
                    motors.write(row[commanded])
                c.step(t, step)
                controller_side.read(of_controller)
                complete += 1
                if exchange == "gauss-seidel":
                    motors.write(row[commanded])
                p.step(t, step)
                if progress is not None:
                    progress(t + step)
        except FMICallException as exception:
            errors = [m.text for m in p.messages + c.messages if m.status > 1]
            failure = " | ".join([f"{exception.args[0]}", *errors])
        messages = p.messages + c.messages
    return Run({name: table[:complete, i].copy() for i, name in enumerate(columns)}, failure, messages)
