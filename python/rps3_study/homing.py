"""What is done to a robot before its first run: its stops are set and its encoders zeroed.

A robot whose radii are off by centimetres has limbs of other lengths in every pose. Its end stops belong to its own
motion, and its encoders are incremental: in the start pose, where a jig holds the platform, they are set to what the
controller's geometry says. What a wrong geometry then spoils is the mapping away from there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rps3_study.fmu import Fmu, Instance, Value
from rps3_study.limits import QUANTITIES, Limits
from rps3_study.metrics import COORDINATES

UNLIMITED: dict[str, Value] = {"d_min": 2e-3, "d_max": 1e3, "theta_min": -3.1, "theta_max": 3.1}
SHORTEST = 0.01
"""No stop lets a limb become shorter than this, m."""
POINTS_A_LEG = 21


def path(controller_parameters: Mapping[str, Value]) -> np.ndarray:
    """Poses (heave in m, tilts in rad) along start, via, end, one a row; the first is the start."""
    start, via, end = (
        np.array([float(controller_parameters[f"{point}_{name}"]) for name in COORDINATES])
        for point in ("start", "via", "end")
    )
    share = np.linspace(0.0, 1.0, POINTS_A_LEG)[:, None]
    return np.vstack([start + share * (via - start), via + share * (end - via)])


def limb_positions(plant: Fmu, geometry: Mapping[str, Value], poses: Sequence[np.ndarray]) -> np.ndarray:
    """Lengths (m) and angles (rad) of the limbs, shape (poses, 2, 3), of a plant with this geometry."""
    fixed = {**UNLIMITED, **{name: geometry[name] for name in ("base_radius", "joint_spacing")}}
    names = [f"{quantity}{limb}" for quantity in QUANTITIES for limb in (1, 2, 3)]
    rows = []
    with Instance(plant, "homing") as instance:
        for pose in poses:
            start = {f"{name}_start": float(value) for name, value in zip(COORDINATES, pose, strict=True)}
            instance.initialize({**fixed, **start, "settled_start": False})
            rows.append(list(instance.get(names).values()))
            instance.slave.reset()
    return np.array(rows).reshape(-1, len(QUANTITIES), 3)


def own_limits(nominal: Limits, believed: np.ndarray, own: np.ndarray) -> Limits:
    """Stops as far beyond a robot's own motion as the nominal ones are beyond the nominal motion.

    Args:
        nominal: stops of the nominal robot.
        believed: limb positions of the nominal robot along the path, as from `limb_positions`.
        own: limb positions of the robot along the same path.
    """
    low = nominal.low + own.min(axis=(0, 2)) - believed.min(axis=(0, 2))
    high = nominal.high + own.max(axis=(0, 2)) - believed.max(axis=(0, 2))
    low[0] = max(low[0], SHORTEST)
    return Limits(low, high)


def encoder_offsets(believed: np.ndarray, own: np.ndarray) -> dict[str, float]:
    """What zeroing at the first pose adds to the true limb positions, by the measurement's name."""
    difference = believed[0] - own[0]
    return {
        f"{quantity}{limb + 1}": float(difference[row, limb])
        for row, quantity in enumerate(QUANTITIES)
        for limb in range(3)
    }
