"""A study: many runs of both FMUs, each determined by the study and its index alone."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import numpy as np
from fmpy.fmi1 import FMICallException

from rps3_study import homing
from rps3_study.couple import Run, run_crossing
from rps3_study.fmu import Fmu, Value
from rps3_study.limits import Limits
from rps3_study.metrics import COORDINATES, figures, joint_circle_radius, pose_error
from rps3_study.montecarlo import DEVIATIONS, Robot
from rps3_study.sweep import Axis, grid
from rps3_study.tasks import tasks

Record = dict[str, Any]
FINISHED, FAILED, CRASHED = "finished", "failed", "crashed"
"""Values of a record's `status`: ran to the end; an FMU refused to go on; the run's process died or raised."""


class Case(NamedTuple):
    """Where an index lies in the study."""

    sample: int
    point: tuple[float, ...]
    mode: int


@dataclass(frozen=True)
class Study:
    """Robots times grid points times control modes.

    The robots run slowest: any first part of a study holds whole robots, and a study of more robots begins with
    the same runs. Every mode and grid point meets the same robots.
    """

    seed: int = 1
    samples: int = 1000
    """Number of robots."""
    spread: float = 0.2
    """Largest relative deviation of a robot from what the controller believes."""
    sensors: float = 1.0
    """Largest scale of the sensors' imperfections."""
    modes: tuple[int, ...] = (1, 2, 3, 4)
    revolute_motors: bool = True
    task: str = "smooth"
    axes: tuple[Axis, ...] = ()

    @property
    def size(self) -> int:
        """Number of runs."""
        return self.samples * len(grid(self.axes)) * len(self.modes)

    def case(self, index: int) -> Case:
        """The case of run `index`.

        Raises:
            IndexError: when there is no such run.
        """
        if not 0 <= index < self.size:
            raise IndexError(f"the study has runs 0 to {self.size - 1}, not {index}")
        points = grid(self.axes)
        rest, mode = divmod(index, len(self.modes))
        sample, point = divmod(rest, len(points))
        return Case(sample, points[point], self.modes[mode])

    def robot(self, sample: int) -> Robot:
        """Robot number `sample`."""
        return Robot.draw(self.seed, sample, self.spread, self.sensors)

    def labels(self, index: int) -> Record:
        """What is known of a run beforehand: the columns that identify it."""
        case = self.case(index)
        robot = self.robot(case.sample)
        return {
            "run": index,
            "sample": case.sample,
            "mode": case.mode,
            "seed": robot.seed,
            "sensor_scale": robot.sensor_scale,
            **{axis.name: value for axis, value in zip(self.axes, case.point, strict=True)},
            **{f"deviation_{name}": robot.deviations[name] for name in DEVIATIONS},
        }

    def as_json(self) -> dict[str, Any]:
        """For a JSON file; `from_json` reads it."""
        return dataclasses.asdict(self)

    @classmethod
    def from_json(cls, values: Mapping[str, Any]) -> Self:
        """What `as_json` gave."""
        axes = tuple(Axis(axis["name"], tuple(axis["values"])) for axis in values["axes"])
        return cls(**{**values, "modes": tuple(values["modes"]), "axes": axes})


def record_of_crash(study: Study, index: int, error: BaseException) -> Record:
    """The record of a run that left none."""
    return {**study.labels(index), "status": CRASHED, "reason": f"{type(error).__name__}: {error}"}


def execute(plant: Fmu, controller: Fmu, study: Study, index: int) -> Record:
    """Makes a run and returns its record; all its values but `seconds` are functions of the arguments."""
    began = time.perf_counter()
    try:
        outcome = _outcome(plant, controller, study, index)
    except FMICallException as error:
        # the run itself reports its failures; this one came on the way to it
        outcome = {"status": FAILED, "reason": f"homing: {error.args[0]}"}
    return {**study.labels(index), **outcome, "seconds": time.perf_counter() - began}


def _outcome(plant: Fmu, controller: Fmu, study: Study, index: int) -> Record:
    case, robot = study.case(index), study.robot(study.case(index).sample)
    task = next(task for task in tasks(controller) if task.key == study.task)
    nominal, believed = _starts(plant), _starts(controller)
    believed |= {**task.parameters, "seed": robot.seed, "sensor_scale": robot.sensor_scale}
    for axis, value in zip(study.axes, case.point, strict=True):
        for target, changes in zip((nominal, believed), axis.assignments(value, plant, controller), strict=True):
            target.update(changes)
    believed |= {"control_mode": case.mode, "revolute_motors": study.revolute_motors}
    actual = {**nominal, "revolute_motors": study.revolute_motors, **robot.plant_parameters(nominal)}

    poses = homing.path(believed)
    positions_believed, positions = (homing.limb_positions(plant, values, poses) for values in (believed, actual))
    limits = homing.own_limits(Limits.of(nominal), positions_believed, positions)
    actual |= limits.parameters()
    actual |= {f"{name}_start": float(value) for name, value in zip(COORDINATES, poses[0], strict=True)}

    run = run_crossing(
        plant,
        controller,
        actual,
        believed,
        stop_time=float(plant.description.defaultExperiment.stopTime),
        disturbance=task.disturbance,
        offsets=homing.encoder_offsets(positions_believed, positions),
    )
    return _figures(run, joint_circle_radius(actual["joint_spacing"]), limits)


def _figures(run: Run, radius: float, limits: Limits) -> Record:
    result = figures(run, radius)
    return {
        "status": FINISHED if run.failure is None else FAILED,
        "reason": run.failure,
        "end_stop": limits.first_contact(run),
        "end_time": float(run.time[-1]) if run.time.size else 0.0,
        "peak_error": result.peak_error,
        "rms_error": result.rms_error,
        "final_error": float(pose_error(run, radius)[-1]) if run.time.size else np.nan,
        "peak_voltage": result.peak_voltage,
        "saturation_time": result.saturation_time,
    }


def _starts(fmu: Fmu) -> dict[str, Value]:
    """All parameters' start values."""
    convert = {"Real": float, "Integer": int, "Boolean": lambda text: text == "true"}
    return {name: convert[fmu.variables[name].type](fmu.variables[name].start) for name in fmu.names("parameter")}
