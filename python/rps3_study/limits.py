"""End stops of the limbs, and whether a run reaches them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np

from rps3_study.couple import Run
from rps3_study.fmu import Fmu, Value

QUANTITIES = ("d", "theta")


@dataclass(frozen=True)
class Limits:
    """Range of limb lengths (m) and limb angles (rad)."""

    low: np.ndarray
    high: np.ndarray

    @classmethod
    def of(cls, values: Mapping[str, Value]) -> Self:
        """From parameters of the plant."""
        low, high = ([float(values[f"{name}_{end}"]) for name in QUANTITIES] for end in ("min", "max"))
        return cls(np.array(low), np.array(high))

    @classmethod
    def default(cls, plant: Fmu) -> Self:
        """Those of a plant with its start values."""
        names = [f"{name}_{end}" for name in QUANTITIES for end in ("min", "max")]
        return cls.of({name: plant.variables[name].start for name in names})

    def parameters(self) -> dict[str, Value]:
        """As parameters of the plant."""
        return {
            f"{name}_{end}": float(value)
            for end, side in (("min", self.low), ("max", self.high))
            for name, value in zip(QUANTITIES, side, strict=True)
        }

    def first_contact(self, run: Run) -> str | None:
        """The first end stop that a limb reached, and when, if any."""
        contacts = []
        for row, quantity in enumerate(QUANTITIES):
            for limb in (1, 2, 3):
                values = run[f"plant.{quantity}{limb}"]
                for end, beyond in (("min", values < self.low[row]), ("max", values > self.high[row])):
                    if beyond.any():
                        contacts.append((float(run.time[beyond.argmax()]), f"{quantity}_{end} by limb {limb}"))
        return None if not contacts else "{1} at {0:.3f} s".format(*min(contacts))
