"""Figures of merit of a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rps3_study.couple import Run
from rps3_study.limits import Limits

COORDINATES = ("heave", "tilt_x", "tilt_y")
VOLTAGES = tuple(f"{prefix}{limb}" for prefix in ("v_leg", "v_rev") for limb in (1, 2, 3))


@dataclass(frozen=True)
class Figures:
    """Figures of one run; NaN where it failed before the first step."""

    peak_error: float
    """Largest pose error, mm."""
    rms_error: float
    """Root mean square of the pose error, mm."""
    peak_voltage: float
    """Largest voltage of a motor, V."""
    saturation_time: float
    """Time during which a voltage was at its limit, s."""
    end_stop: bool = False
    """A limb went beyond an end stop."""
    failure: str | None = None
    """Why the run ended early, if it did."""


def joint_circle_radius(joint_spacing: float) -> float:
    """Radius r_b of the circle through the spherical joints, m."""
    return joint_spacing / np.sqrt(3.0)


def coordinate_errors(run: Run, radius: float) -> np.ndarray:
    """Errors of heave and, times `radius` (m), of the tilts over time, shape (3, samples), m."""
    scales = (1.0, radius, radius)
    return np.array(
        [
            scale * (run[f"plant.{name}"] - run[f"controller.{name}_ref"])
            for name, scale in zip(COORDINATES, scales, strict=True)
        ]
    )


def pose_error(run: Run, radius: float) -> np.ndarray:
    """Pose error over time in mm: the largest of |heave error| and `radius` (m) times |tilt errors|."""
    return 1e3 * np.abs(coordinate_errors(run, radius)).max(axis=0)


def figures(run: Run, radius: float, limits: Limits | None = None) -> Figures:
    """Figures of a run; `radius` as in `pose_error`, `limits` are the end stops, where they matter."""
    if run.time.size == 0:
        return Figures(np.nan, np.nan, np.nan, np.nan, failure=run.failure)
    error = pose_error(run, radius)
    voltages = np.abs([run[f"controller.{name}"] for name in VOLTAGES])
    held = np.diff(run.time, append=run.time[-1])
    return Figures(
        peak_error=float(error.max()),
        rms_error=float(np.sqrt(np.mean(error**2))),
        peak_voltage=float(voltages.max()),
        saturation_time=float(held @ run["controller.saturated"]),
        end_stop=limits is not None and limits.first_contact(run) is not None,
        failure=run.failure,
    )
