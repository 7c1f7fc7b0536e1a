"""Random robots: what a plant's parameters may be while the controller believes the nominal ones."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rps3_study.fmu import Value

GEOMETRY = ("base_radius", "joint_spacing", "lower_com", "upper_com")
"""Deviations that are the geometry's."""

DEVIATIONS: dict[str, tuple[str, ...]] = {
    **{name: (name,) for name in GEOMETRY},
    # a body that is heavier by a factor has its inertia larger by that factor; the plate's follows in the FMU
    "plate_mass": ("plate_mass", "plate_ixx", "plate_izz"),
    "lower_mass": ("lower_mass", "lower_inertia"),
    "upper_mass": ("upper_mass", "upper_inertia"),
    "friction": ("motor_bm",),
}
"""What varies from robot to robot, and the plant's parameters that vary in proportion."""


@dataclass(frozen=True)
class Robot:
    """One random robot with its sensors."""

    deviations: Mapping[str, float]
    """Relative deviation from the nominal value by the names in `DEVIATIONS`."""
    sensor_scale: float
    """Scale of the imperfections of Table 1; 0 for ideal sensors."""
    seed: int
    """The controller's parameter `seed`: noise and static errors of the sensors, and the swarm's luck."""

    @classmethod
    def draw(cls, study_seed: int, sample: int, spread: float, sensors: float) -> Robot:
        """Robot number `sample`, all its figures uniform and independent.

        Args:
            study_seed: seed of the study.
            sample: number of the robot; equal numbers of one study are equal robots.
            spread: largest relative deviation.
            sensors: largest scale of the sensors' imperfections.
        """
        generator = np.random.default_rng([study_seed, sample])
        deviations = spread * generator.uniform(-1.0, 1.0, len(DEVIATIONS))
        scale = sensors * generator.uniform()
        seed = int(generator.integers(2**31))
        return cls(dict(zip(DEVIATIONS, deviations.tolist(), strict=True)), scale, seed)

    def plant_parameters(self, nominal: Mapping[str, float]) -> dict[str, Value]:
        """The plant's parameters that deviate, from all `nominal` ones."""
        return {
            parameter: nominal[parameter] * (1.0 + deviation)
            for name, deviation in self.deviations.items()
            for parameter in DEVIATIONS[name]
        }
