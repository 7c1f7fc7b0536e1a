"""The programs that are measured: compiled, started, asked in turn."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sysconfig
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Self

import fmpy
import numpy as np
from rps3_study.fmu import Fmu

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ROOT / "benches/peers"
BUILD = ROOT / "target/bench/peers"
PACKAGES = Path(sysconfig.get_paths()["purelib"])


class Program:
    """A program that answers each line of its input with a line of output."""

    def __init__(self, *command: str | Path) -> None:
        self.process = subprocess.Popen(
            [str(word) for word in command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=ROOT
        )

    def line(self) -> str:
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"{self.process.args[0]} ended with {self.process.wait()}")
        return line

    def ask(self, question: str) -> str:
        self.process.stdin.write(question + "\n")
        self.process.stdin.flush()
        return self.line()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.stdin.close()
        self.process.wait()


class Native(Program):
    """benches/native, asked in JSON."""

    def __init__(self) -> None:
        super().__init__(os.environ["RPS3_BENCH"])

    def measure(self, what: str, **arguments: object) -> Any:
        return json.loads(self.ask(json.dumps({"measure": what, **arguments})))


def compiled(compiler: str, source: str, output: str, *options: str | Path) -> Path | None:
    """A program or library made of a file in benches/peers, `None` without the compiler."""
    program = shutil.which(compiler)
    if program is None:
        return None
    BUILD.mkdir(parents=True, exist_ok=True)
    target, path = BUILD / output, SOURCES / source
    # what it includes and how it is compiled counts as well
    sources = [*SOURCES.iterdir(), Path(__file__)]
    if not target.exists() or target.stat().st_mtime < max(file.stat().st_mtime for file in sources):
        subprocess.run([program, str(path), "-o", str(target), *map(str, options)], check=True)
    return target


def pinocchio() -> Path | None:
    """Pinocchio's constraintDynamics, at the optimization level of our own release build."""
    prefix = PACKAGES / "cmeel.prefix"
    # as Pinocchio's own CMake files export them
    definitions = {
        "BOOST_MPL_LIMIT_LIST_SIZE": "30",
        "BOOST_MPL_LIMIT_VECTOR_SIZE": "30",
        "BOOST_MPL_CFG_NO_PREPROCESSED_HEADERS": "",
        "BOOST_FUSION_INVOKE_MAX_ARITY": "12",
    }
    return compiled(
        "g++", "pinocchio.cpp", "pinocchio", "-std=c++17", "-O3", "-DNDEBUG", "-w",
        *(f"-D{name}={value}" for name, value in definitions.items()),
        "-isystem", prefix / "include", "-isystem", prefix / "include/eigen3",
        f"-L{prefix / 'lib'}", "-lpinocchio_default", "-lboost_serialization", f"-Wl,-rpath,{prefix / 'lib'}",
    )  # fmt: skip


def c_fmu(name: str) -> Path | None:
    """The library of an FMU in C that does next to nothing: `minimal_fmu`, or `checked_fmu` with checks like ours."""
    headers = Path(fmpy.__file__).parent / "c-code"
    # where the functions and loops of so short calls begin in a line of the cache takes them up to twice the time
    aligned = ("-falign-functions=64", "-falign-loops=32")
    return compiled("gcc", f"{name}.c", f"{name}.so", "-O3", *aligned, "-shared", "-fPIC", "-isystem", headers)


Times = float | Sequence[float]


def fastest(rounds: int, candidates: Mapping[str, Callable[[], Times]]) -> dict[str, float]:
    """The mean over the operations of each candidate, of each operation the least of `rounds` measurements.

    Candidates are measured in turn. The least is what other work on the machine disturbs least.
    """
    best: dict[str, np.ndarray] = {}
    for _ in range(rounds):
        for name, measure in candidates.items():
            times = np.asarray(measure(), dtype=float)
            best[name] = np.minimum(best.get(name, times), times)
    return {name: float(times.mean()) for name, times in best.items()}


def library(fmu: Fmu) -> str:
    """Path of the shared library of an extracted FMU."""
    (path,) = (fmu.directory / "binaries" / fmpy.platform).glob(f"*{fmpy.sharedLibraryExtension}")
    return str(path)
