"""Parameter sweeps: a full grid over values of parameters."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from rps3_study.fmu import Fmu, Value

SIDES = ("plant", "controller")
SET_BY_STUDY = {
    "control_mode": "--modes",
    "revolute_motors": "--motors",
    "heave_start": "start_heave",
    "tilt_x_start": "start_tilt_x",
    "tilt_y_start": "start_tilt_y",
}
"""Parameters that a sweep cannot vary, and what they follow."""


@dataclass(frozen=True)
class Axis:
    """A parameter and the values it takes in turn."""

    name: str
    """`plant.<parameter>`, `controller.<parameter>`, or `<parameter>` for each FMU that has it."""
    values: tuple[float, ...]

    @classmethod
    def parse(cls, text: str) -> Self:
        """From `name=v,v,...` or `name=first:last:count`, the latter evenly spaced.

        Raises:
            ValueError: when `text` is neither.
        """
        name, _, values = text.partition("=")
        try:
            if ":" in values:
                first, last, count = values.split(":")
                numbers = np.linspace(float(first), float(last), int(count)).tolist()
            else:
                numbers = [float(value) for value in values.split(",")]
        except ValueError as error:
            raise ValueError(f"{text!r} is not name=value,value,... or name=first:last:count") from error
        if not name or not numbers:
            raise ValueError(f"{text!r} names no parameter or no values")
        return cls(name, tuple(numbers))

    def check(self, plant: Fmu, controller: Fmu) -> None:
        """Makes sure that there is such a parameter, and that it can be varied.

        Raises:
            ValueError: when neither FMU has it, or the study sets it itself.
        """
        side, parameter = self._place()
        if parameter in SET_BY_STUDY:
            raise ValueError(f"{self.name} follows {SET_BY_STUDY[parameter]} and cannot be varied")
        fmus = [fmu for name, fmu in zip(SIDES, (plant, controller), strict=True) if side in (None, name)]
        if not any(parameter in fmu.names("parameter") for fmu in fmus):
            raise ValueError(f"there is no parameter {self.name}")

    def assignments(self, value: float, plant: Fmu, controller: Fmu) -> tuple[dict[str, Value], dict[str, Value]]:
        """The parameters of plant and controller that `value` means."""
        side, parameter = self._place()
        return tuple(
            {parameter: value} if side in (None, name) and parameter in fmu.names("parameter") else {}
            for name, fmu in zip(SIDES, (plant, controller), strict=True)
        )

    def _place(self) -> tuple[str | None, str]:
        side, dot, parameter = self.name.partition(".")
        if not dot:
            return None, self.name
        return side if side in SIDES else "none", parameter


def grid(axes: Sequence[Axis]) -> list[tuple[float, ...]]:
    """All combinations of values, the last axis running fastest; one empty combination without axes."""
    return list(itertools.product(*(axis.values for axis in axes)))
