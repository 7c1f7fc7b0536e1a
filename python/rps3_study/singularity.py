"""What a run does near the singular pose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rps3_study.couple import Run
from rps3_study.geometry import Geometry, degenerate_twists
from rps3_study.metrics import coordinate_errors

SINGULAR_REGION = 0.1
"""Smallest singular value below which a pose counts as near: the controller's default `delta_hd_fixed`."""
MOVE_TIME = 1.0
"""End of the reference's motion, s: the controller's default `move_time`."""
SAMPLE_TIME = 1e-3
"""Time between ticks, s: the controller's default."""


@dataclass(frozen=True)
class Passage:
    """Figures of a run near the singular pose; NaN where it does not come near.

    Speeds and accelerations along the degenerate direction are components of the platform's twist, rotations times r_b.
    """

    velocity_error: float
    """Largest error of heave rate and r_b times tilt rates near the singular pose, mm/s."""
    speed: float
    """Speed along the degenerate direction at the pose closest to singular, mm/s."""
    acceleration: float
    """Acceleration along it there, m/s2."""
    leftover: float
    """Root mean square of the speed along it while the reference rests, mm/s."""
    final_error: float
    """Pose error at the end, mm."""
    rho: tuple[float, float]
    """Tenth and ninetieth percentile of the damping factor near the singular pose."""
    braking: float
    """Share of the samples there in which the velocity damping takes away more than a tenth of the speed along the
    degenerate direction (4.15)."""


def passage(run: Run, geometry: Geometry) -> Passage:
    """Figures of a run; `geometry` is the plant's."""
    if run.time.size < 2:
        return Passage(*[np.nan] * 5, (np.nan, np.nan), np.nan)
    directions, closeness = degenerate_twists(run, geometry)
    turning = geometry.joint_radius * np.column_stack([run[f"plant.w_{axis}"] for axis in "xyz"])
    twist = np.hstack([np.column_stack([run[f"plant.v_{axis}"] for axis in "xyz"]), turning])
    acceleration = np.gradient(twist, run.time, axis=0)
    errors = 1e3 * coordinate_errors(run, geometry.joint_radius)
    rates = np.abs(np.gradient(errors, run.time, axis=1))
    near, closest, resting = closeness < SINGULAR_REGION, int(closeness.argmin()), run.time > MOVE_TIME
    square = run["controller.rho"] ** 2
    taken = SAMPLE_TIME * run["controller.rho_hd"] * square / (closeness**2 + square + np.finfo(float).tiny)
    speed = 1e3 * np.einsum("ti,ti->t", directions, twist)
    return Passage(
        velocity_error=float(rates[:, near].max()) if near.any() else np.nan,
        speed=float(abs(speed[closest])),
        acceleration=float(abs(directions[closest] @ acceleration[closest])),
        leftover=float(np.sqrt(np.mean(speed[resting] ** 2))) if resting.any() else np.nan,
        final_error=float(np.abs(errors[:, -1]).max()),
        rho=tuple(np.quantile(run["controller.rho"][near], [0.1, 0.9]).tolist()) if near.any() else (np.nan, np.nan),
        braking=float((taken[near] > 0.1).mean()) if near.any() else np.nan,
    )
