"""What the study runs: control modes, actuation variants and tasks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from rps3_study.couple import Run, run_crossing
from rps3_study.fmu import Fmu, Value

MODES: dict[int, str] = {1: "RAC", 2: "DRAC", 3: "HDRAC", 4: "HDRAC+MPSO"}
"""Names of the values of `control_mode`."""

VARIANTS: dict[str, bool] = {"six motors": True, "three motors": False}
"""Value of `revolute_motors` in both FMUs."""


@dataclass(frozen=True)
class Push:
    """A force of `force` N along z and a moment of `moment` N.m about x while `start` <= t < `end` (s)."""

    force: float
    moment: float
    start: float
    end: float

    def __call__(self, t: float) -> Mapping[str, float]:
        """The plant's load inputs at time t, s."""
        on = self.start <= t < self.end
        return {"f_ext_z": self.force if on else 0.0, "m_ext_x": self.moment if on else 0.0}


@dataclass(frozen=True)
class Task:
    """One motion with what disturbs it."""

    key: str
    title: str
    parameters: Mapping[str, Value] = field(default_factory=dict)
    disturbance: Push | None = None


def tasks(controller: Fmu) -> list[Task]:
    """The study's tasks; the poses come from the controller's start values."""
    at_via: dict[str, Value] = {}
    for coordinate in ("heave", "tilt_x", "tilt_y"):
        at_via[f"end_{coordinate}"] = float(controller.variables[f"via_{coordinate}"].start)
    crossing = Push(force=-100.0, moment=5.0, start=0.455, end=0.495)
    resting = Push(force=-100.0, moment=5.0, start=1.18, end=1.22)
    return [
        Task("smooth", "Crossing, quintic time law", {"profile": 2}),
        Task("constant_speed", "Crossing at constant speed", {"profile": 1}),
        Task(
            "sensors",
            "Crossing at constant speed, sensors with the errors of Table 1",
            {"profile": 1, "sensor_scale": 1.0},
        ),
        Task("push", "Crossing, pushed by 100 N next to the singular pose", {"profile": 2}, crossing),
        Task("stop", "Stop at the singular pose", {"profile": 2, **at_via}),
        Task("stop_push", "Stop at the singular pose, pushed by 100 N there", {"profile": 2, **at_via}, resting),
    ]


def supported_modes(controller: Fmu) -> dict[int, str]:
    """The control modes that the FMU accepts, by the limits of its variable `control_mode`."""
    variable = controller.variables["control_mode"]
    return {mode: name for mode, name in MODES.items() if int(variable.min) <= mode <= int(variable.max)}


def run_task(
    plant: Fmu,
    controller: Fmu,
    task: Task,
    variant: str,
    parameters: Mapping[str, Value],
    progress: Callable[[float], object] | None = None,
) -> Run:
    """Runs a task with the nominal robot.

    Args:
        plant: the Rps3Plant FMU.
        controller: the Rps3Controller FMU.
        task: what to do.
        variant: a key of `VARIANTS`.
        parameters: of the controller, besides the task's.
        progress: as in `run_crossing`.
    """
    motors: dict[str, Value] = {"revolute_motors": VARIANTS[variant]}
    return run_crossing(
        plant,
        controller,
        motors,
        {**motors, **task.parameters, **parameters},
        stop_time=float(plant.description.defaultExperiment.stopTime),
        disturbance=task.disturbance,
        progress=progress,
    )
