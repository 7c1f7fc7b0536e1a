"""Access to an FMI 2.0 FMU by variable names instead of value references."""

from __future__ import annotations

import itertools
import shutil
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from ctypes import byref, c_void_p
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple, Self

import fmpy
from fmpy import fmi2
from fmpy.logging import addLoggerProxy
from fmpy.model_description import ModelDescription, ScalarVariable, read_model_description

Value = float | int | bool


class Message(NamedTuple):
    """What an FMU logged."""

    instance: str
    status: int
    category: str
    text: str


@dataclass(frozen=True)
class Fmu:
    """An extracted FMU."""

    archive: Path
    directory: Path
    description: ModelDescription

    @classmethod
    def extract(cls, archive: str | Path, directory: str | Path | None = None) -> Self:
        """Unpacks an archive into `directory`, by default a temporary one; `remove` deletes it."""
        path = Path(archive)
        unpacked = fmpy.extract(str(path), unzipdir=None if directory is None else str(directory))
        return cls(path, Path(unpacked), read_model_description(str(path)))

    def remove(self) -> None:
        """Deletes the extracted files."""
        shutil.rmtree(self.directory, ignore_errors=True)

    @cached_property
    def variables(self) -> dict[str, ScalarVariable]:
        """All variables by name."""
        return {variable.name: variable for variable in self.description.modelVariables}

    def names(self, causality: str, type_: str | None = None) -> list[str]:
        """Names of all variables of a causality, and of a type where one is given."""
        return [
            v.name
            for v in self.description.modelVariables
            if v.causality == causality and (type_ is None or v.type == type_)
        ]


@contextmanager
def extracted(*archives: str | Path) -> Iterator[list[Fmu]]:
    """Extracts FMUs for the duration of a `with` block."""
    fmus: list[Fmu] = []
    try:
        for archive in archives:
            fmus.append(Fmu.extract(archive))
        yield fmus
    finally:
        for fmu in fmus:
            fmu.remove()


class Instance:
    """A Co-Simulation instance, freed at the end of its `with` block.

    Statuses from fmi2Discard on raise `fmpy.fmi1.FMICallException`; `messages` holds what was logged.
    """

    def __init__(self, fmu: Fmu, name: str | None = None) -> None:
        """Instantiates the FMU with logging on."""
        self.fmu = fmu
        self.messages: list[Message] = []
        self._callbacks, self._environment = _callbacks(self.messages)
        self.slave: Any = self._load(fmu, name)
        self.slave.instantiate(callbacks=self._callbacks, loggingOn=True)

    @staticmethod
    def _load(fmu: Fmu, name: str | None) -> Any:
        return fmi2.FMU2Slave(
            guid=fmu.description.guid,
            unzipDirectory=str(fmu.directory),
            modelIdentifier=fmu.description.coSimulation.modelIdentifier,
            instanceName=name,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.free()

    def free(self) -> None:
        """Frees the instance; the library stays loaded, since other instances may use it."""
        if self.slave is not None:
            self.slave.fmi2FreeInstance(self.slave.component)
            self.slave = None
            _COLLECTORS.pop(self._environment, None)

    def set(self, values: Mapping[str, Value]) -> None:
        """Sets variables by name."""
        for type_, names in by_type(self.fmu, values).items():
            references = [self.fmu.variables[name].valueReference for name in names]
            converted = [_CONVERT[type_](values[name]) for name in names]
            getattr(self.slave, f"set{type_}")(references, converted)

    def get(self, names: Iterable[str]) -> dict[str, Value]:
        """Values of variables by name, in the order asked for."""
        names = list(names)
        result: dict[str, Value] = dict.fromkeys(names, 0.0)
        for type_, group in by_type(self.fmu, names).items():
            references = [self.fmu.variables[name].valueReference for name in group]
            values = getattr(self.slave, f"get{type_}")(references)
            result.update(zip(group, map(_CONVERT[type_], values), strict=True))
        return result

    def __getitem__(self, name: str) -> Value:
        return self.get([name])[name]

    def setup(self, start_time: float = 0.0, stop_time: float | None = None, tolerance: float | None = None) -> None:
        """Sets the experiment up (times in s) and enters Initialization Mode."""
        self.slave.setupExperiment(tolerance=tolerance, startTime=start_time, stopTime=stop_time)
        self.slave.enterInitializationMode()

    def initialize(self, values: Mapping[str, Value] | None = None, **experiment: float | None) -> None:
        """Sets the experiment up, sets values and passes Initialization Mode."""
        self.set(values or {})
        self.setup(**experiment)
        self.slave.exitInitializationMode()

    def step(self, time: float, size: float) -> None:
        """Advances from `time` by `size`, both in s."""
        self.slave.doStep(currentCommunicationPoint=time, communicationStepSize=size)


class ModelInstance(Instance):
    """A Model Exchange instance."""

    @staticmethod
    def _load(fmu: Fmu, name: str | None) -> Any:
        return fmi2.FMU2Model(
            guid=fmu.description.guid,
            unzipDirectory=str(fmu.directory),
            modelIdentifier=fmu.description.modelExchange.modelIdentifier,
            instanceName=name,
        )


_CONVERT = {"Real": float, "Integer": int, "Boolean": bool}
_COLLECTORS: dict[int, list[Message]] = {}
_ENVIRONMENTS = itertools.count(1)


def by_type(fmu: Fmu, names: Iterable[str]) -> dict[str, list[str]]:
    """Names of variables grouped by type, as FMI wants them."""
    groups: dict[str, list[str]] = {}
    for name in names:
        groups.setdefault(fmu.variables[name].type, []).append(name)
    return groups


def _log(environment: int | None, instance: bytes, status: int, category: bytes, text: bytes) -> None:
    """Files a message under the instance it came from; FMPy's own instances have no environment."""
    collector = _COLLECTORS.get(environment or 0)
    if collector is None:
        fmi2.printLogMessage(environment, instance, status, category, text)
    else:
        collector.append(Message(instance.decode(), status, category.decode(), text.decode()))


# FMPy's proxy formats the variadic arguments and then calls the one logger it was given last, in the
# whole process: so there is one logger for all instances.
_LOGGER = fmi2.fmi2CallbackLoggerTYPE(_log)
_PROXY = fmi2.fmi2CallbackFunctions(logger=_LOGGER)
addLoggerProxy(byref(_PROXY))


def _callbacks(collector: list[Message]) -> tuple[fmi2.fmi2CallbackFunctions, int]:
    environment = next(_ENVIRONMENTS)
    _COLLECTORS[environment] = collector
    callbacks = fmi2.fmi2CallbackFunctions(
        logger=_PROXY.logger,
        allocateMemory=fmi2.defaultCallbacks.allocateMemory,
        freeMemory=fmi2.defaultCallbacks.freeMemory,
        componentEnvironment=c_void_p(environment),
    )
    return callbacks, environment
