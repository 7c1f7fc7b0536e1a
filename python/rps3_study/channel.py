"""Variables that are exchanged at every step."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from fmpy import fmi2

from rps3_study.fmu import Instance, by_type

_C_TYPES = {"Real": fmi2.fmi2Real, "Integer": fmi2.fmi2Integer, "Boolean": fmi2.fmi2Boolean}


class _Part(NamedTuple):
    """The variables of one type, with the memory of their calls."""

    type_: str
    places: np.ndarray
    """Where their values stand among all of the channel."""
    references: Any
    buffer: Any
    view: np.ndarray
    """The buffer's numbers."""


class Channel:
    """A fixed list of variables of an instance: references and buffers are made once, not at every call."""

    def __init__(self, instance: Instance, names: Sequence[str]) -> None:
        """The channel of these variables, values being in this order."""
        self._slave = instance.slave
        self._parts = []
        for type_, group in by_type(instance.fmu, names).items():
            references = [instance.fmu.variables[name].valueReference for name in group]
            buffer = (_C_TYPES[type_] * len(group))()
            self._parts.append(
                _Part(
                    type_,
                    np.array([list(names).index(name) for name in group]),
                    (fmi2.fmi2ValueReference * len(group))(*references),
                    buffer,
                    np.ctypeslib.as_array(buffer),
                )
            )

    def read(self, into: np.ndarray) -> None:
        """Puts the variables' values into an array of floats."""
        for part in self._parts:
            self._call("Get", part)
            into[part.places] = part.view

    def write(self, values: np.ndarray) -> None:
        """Sets the variables to an array of floats."""
        for part in self._parts:
            part.view[:] = values[part.places]
            self._call("Set", part)

    def _call(self, what: str, part: _Part) -> None:
        function = getattr(self._slave, f"fmi2{what}{part.type_}")
        function(self._slave.component, part.references, len(part.references), part.buffer)
