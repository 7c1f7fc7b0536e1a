"""The Rust dynamics for comparison, and the mechanism's kinematics written anew.

Nothing of the geometry is taken from the Rust code: orientation by SciPy's rotation vectors, the
platform's horizontal position and velocity from the condition that each spherical joint stays in
its limb's plane.
"""

import json
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

ROOT = Path(__file__).resolve().parents[2]
Array = NDArray[np.float64]

AZIMUTHS = np.deg2rad([0.0, 120.0, 240.0])
RADIAL = np.stack([np.cos(AZIMUTHS), np.sin(AZIMUTHS), np.zeros(3)], axis=1)
UP = np.array([0.0, 0.0, 1.0])
LATERAL = np.cross(UP, RADIAL)

DEFAULTS: dict[str, float | bool] = {
    "base_radius": 0.4172,
    "joint_spacing": 0.3616,
    "plate_radius": 0.2208,
    "plate_mass": 4.0,
    "plate_ixx": 0.05,
    "plate_izz": 0.09,
    "lower_mass": 0.6,
    "lower_com": 0.08,
    "lower_inertia": 2e-3,
    "upper_mass": 0.3,
    "upper_com": 0.10,
    "upper_inertia": 1e-3,
    "screw_lead": 0.010,
    "gear_ratio": 50.0,
    "motor_kt": 0.21,
    "motor_jm": 3.7e-5,
    "motor_bm": 1.3e-5,
    "motor_la": 2.4e-3,
    "motor_ra": 4.8,
    "gravity": 9.81,
    "v_max": 48.0,
    "revolute_motors": True,
}


def random_parameters(rng: np.random.Generator) -> dict[str, float | bool]:
    """Every parameter between half and double its default, the revolute motors unpowered in half of the sets."""
    drawn = {
        name: float(value * 2.0 ** rng.uniform(-1, 1))
        for name, value in DEFAULTS.items()
        if not isinstance(value, bool)
    }
    # keep the platform inside the base, as any mechanism of the kind has it, and its inertia a body's
    drawn["base_radius"] = drawn["joint_spacing"] * rng.uniform(0.9, 1.6)
    drawn["plate_izz"] = drawn["plate_ixx"] * rng.uniform(0.3, 2.0)
    return {**drawn, "revolute_motors": bool(rng.random() < 0.5)}


def random_states(rng: np.random.Generator, parameters: dict[str, float | bool], count: int) -> Array:
    """Rows of 12 states: tilts up to 30 deg in any direction, singular heaves included."""
    r_b = parameters["joint_spacing"] / np.sqrt(3)
    tilt, direction = rng.uniform(0, np.pi / 6, count), rng.uniform(0, 2 * np.pi, count)
    states = np.empty((count, 12))
    states[:, 0] = rng.uniform(-0.2, 0.6, count) * r_b
    states[:, 1], states[:, 2] = tilt * np.cos(direction), tilt * np.sin(direction)
    states[:, 3] = rng.uniform(-0.5, 0.5, count)
    states[:, 4:6] = rng.uniform(-2, 2, (count, 2))
    states[:, 6:12] = rng.uniform(-5, 5, (count, 6))
    if not parameters["revolute_motors"]:
        states[:, 9:12] = 0.0
    return states


@dataclass(frozen=True)
class Motors:
    """Constants of leg and revolute drives seen at the joints."""

    force: Array
    inertia: Array
    friction: Array

    @classmethod
    def of(cls, p: dict[str, float | bool]) -> "Motors":
        """Order: theta_1, d_1, theta_2, ... as the limbs' joints come in the chains."""
        ratio = np.tile([p["gear_ratio"], 2 * np.pi / p["screw_lead"]], 3)
        return cls(ratio * p["motor_kt"], ratio**2 * p["motor_jm"], ratio**2 * p["motor_bm"])


@dataclass(frozen=True)
class Configuration:
    """Positions and velocities of all joints at one state."""

    rotation: Array
    position: Array
    velocity: Array
    omega: Array
    lengths: Array
    angles: Array
    length_rates: Array
    angle_rates: Array
    axial: Array
    normal: Array

    @property
    def joints(self) -> Array:
        """theta_1, d_1, theta_2, ..."""
        return np.stack([self.angles, self.lengths], axis=1).ravel()

    @property
    def joint_rates(self) -> Array:
        return np.stack([self.angle_rates, self.length_rates], axis=1).ravel()


def configuration(p: dict[str, float | bool], state: Array) -> Configuration:
    """All joints at a state (heave, tilt_x, tilt_y and their rates first)."""
    heave, tilt, heave_rate, tilt_rate = state[0], state[1:3], state[3], state[4:6]
    phi, phi_dot = np.append(tilt, 0.0), np.append(tilt_rate, 0.0)
    rotation = Rotation.from_rotvec(phi).as_matrix()
    omega = left_jacobian(phi) @ phi_dot
    arms = RADIAL @ rotation.T * (p["joint_spacing"] / np.sqrt(3))
    horizontal = LATERAL[:, :2]
    # n_i . (P + arm_i) = 0 and its rate: three equations, two unknowns, consistent without torsion
    position = np.append(np.linalg.lstsq(horizontal, -np.sum(LATERAL * arms, axis=1))[0], heave)
    arm_rates = np.cross(omega, arms)
    velocity = np.append(np.linalg.lstsq(horizontal, -np.sum(LATERAL * arm_rates, axis=1))[0], heave_rate)
    lines = position + arms - p["base_radius"] * RADIAL
    lengths = np.linalg.norm(lines, axis=1)
    axial = lines / lengths[:, None]
    normal = np.cross(LATERAL, axial)
    rates = velocity + arm_rates
    return Configuration(
        rotation=rotation,
        position=position,
        velocity=velocity,
        omega=omega,
        lengths=lengths,
        angles=np.arctan2(axial[:, 2], -np.sum(axial * RADIAL, axis=1)),
        length_rates=np.sum(axial * rates, axis=1),
        angle_rates=np.sum(normal * rates, axis=1) / lengths,
        axial=axial,
        normal=normal,
    )


def left_jacobian(phi: Array) -> Array:
    """Angular velocity in the base frame per rate of the rotation vector."""
    angle = np.linalg.norm(phi)
    cross = np.cross(np.eye(3), phi)
    if angle < 1e-4:
        return np.eye(3) + cross / 2 + cross @ cross / 6
    first, second = (1 - np.cos(angle)) / angle**2, (angle - np.sin(angle)) / angle**3
    return np.eye(3) + first * cross + second * cross @ cross


def rust(requests: Sequence[dict[str, object]]) -> list[dict[str, Array]]:
    """Answers of examples/oracle.rs."""
    lines = "".join(json.dumps(request) + "\n" for request in requests)
    command = ["cargo", "run", "--quiet", "--package", "rps3", "--example", "oracle"]
    answer = subprocess.run(command, cwd=ROOT, input=lines, capture_output=True, text=True, check=True)
    return [{name: np.array(rows) for name, rows in json.loads(line).items()} for line in answer.stdout.splitlines()]
