"""The mechanism's geometry, as far as the recorded outputs need it to be drawn and judged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.spatial.transform import Rotation

from rps3_study.couple import Run
from rps3_study.fmu import Fmu
from rps3_study.metrics import joint_circle_radius


@dataclass(frozen=True)
class Geometry:
    """Base and platform; limb i lies in the vertical plane at the azimuth (i - 1) 120 deg."""

    base_radius: float
    """Radius a of the circle of the revolute joints A_i, m."""
    joint_radius: float
    """Radius r_b of the circle of the spherical joints B_i, m."""

    @classmethod
    def of(cls, plant: Fmu) -> Self:
        """The geometry of a plant with its start values."""
        base_radius, spacing = (float(plant.variables[name].start) for name in ("base_radius", "joint_spacing"))
        return cls(base_radius, joint_circle_radius(spacing))

    @property
    def radial(self) -> np.ndarray:
        """Unit vectors e_i of the limbs' planes, one a row."""
        azimuths = np.radians([0.0, 120.0, 240.0])
        return np.column_stack([np.cos(azimuths), np.sin(azimuths), np.zeros(3)])


def rotations(run: Run) -> np.ndarray:
    """Rotation matrices of the platform over time, shape (samples, 3, 3)."""
    w, x, y, z = (run[f"plant.q_{part}"] for part in "wxyz")
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def reference_positions(run: Run, joint_radius: float) -> np.ndarray:
    """Where P is to be over time, m, one row a sample: heave, and sideways what the tilt brings along."""
    tilts = np.column_stack([run["controller.tilt_x_ref"], run["controller.tilt_y_ref"], np.zeros(run.time.size)])
    turn = Rotation.from_rotvec(tilts).as_matrix()
    x, y = joint_radius / 2 * (turn[:, 0, 0] - turn[:, 1, 1]), -joint_radius * turn[:, 1, 0]
    return np.column_stack([x, y, run["controller.heave_ref"]])


def degenerate_twists(run: Run, geometry: Geometry) -> tuple[np.ndarray, np.ndarray]:
    """The motion that the limbs resist least, from the recorded poses.

    The right singular vector of the overall Jacobian (limb rates and constraint rates over the platform's
    twist, its angular part scaled by r_b) that belongs to the smallest singular value. At a direct
    singularity the platform can move along it with all limbs locked.

    Returns:
        Unit twists [v; r_b omega] in the base frame, shape (samples, 6), each sign chosen next to the last, and
        the smallest singular values.
    """
    position = np.column_stack([run[f"plant.p_{axis}"] for axis in "xyz"])
    radial = geometry.radial
    arms = np.einsum("tij,kj->tki", rotations(run), geometry.joint_radius * radial)
    limbs = position[:, None, :] + arms - geometry.base_radius * radial
    axial = limbs / np.linalg.norm(limbs, axis=2, keepdims=True)
    lateral = np.broadcast_to(np.cross([0.0, 0.0, 1.0], radial), axial.shape)
    directions = np.concatenate([axial, lateral], axis=1)
    moments = np.cross(np.concatenate([arms, arms], axis=1), directions) / geometry.joint_radius
    _, values, right = np.linalg.svd(np.concatenate([directions, moments], axis=2))
    twists = right[:, -1, :]
    turns = np.sign(np.einsum("ti,ti->t", twists[1:], twists[:-1]))
    twists[1:] *= np.cumprod(np.where(turns == 0.0, 1.0, turns))[:, None]
    return twists, values[:, -1]
