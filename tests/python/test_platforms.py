"""The release's binaries for other platforms: `cargo xtask package --all-targets --check`.

Each couples the default crossing in its own C host, under an emulator where this machine needs one, and must give the
bits of this machine's own build in FMPy.
"""

import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from conftest import IDENTIFIERS, ROOT
from rps3_study.couple import Run, run_crossing
from rps3_study.fmu import Fmu, extracted

HOW = "`cargo xtask package --all-targets --check` builds and runs other platforms' binaries"
lief = pytest.importorskip("lief", reason=HOW)

STEPS = 1400


class Platform(NamedTuple):
    """How one platform's programs are made and started here."""

    extension: str
    zig_target: str
    start: list[str]
    packages: str


PLATFORMS = {
    "linux64": Platform("so", "x86_64-linux-gnu.2.17", [], ""),
    "win64": Platform("dll", "x86_64-windows-gnu", ["wine"], "wine"),
    "aarch64-linux": Platform(
        "so", "aarch64-linux-gnu.2.17", ["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"], "qemu-user libc6-arm64-cross"
    ),
}


@pytest.fixture(scope="session")
def release() -> Iterator[tuple[Fmu, Fmu]]:
    """Plant and controller of the release."""
    directory = os.environ.get("RPS3_RELEASE")
    if directory is None:
        pytest.skip(HOW)
    with extracted(*(Path(directory) / f"{name}.fmu" for name in IDENTIFIERS)) as (plant, controller):
        yield plant, controller


@pytest.fixture(scope="session")
def native(plant: Fmu, controller: Fmu) -> Run:
    """The default crossing by this machine's own build."""
    run = run_crossing(plant, controller)
    assert run.failure is None
    return run


def binary(fmu: Fmu, platform: str) -> Path:
    identifier = fmu.description.coSimulation.modelIdentifier
    return fmu.directory / "binaries" / platform / f"{identifier}.{PLATFORMS[platform].extension}"


def test_release_has_a_library_for_each_platform_and_no_other(release: tuple[Fmu, Fmu]) -> None:
    for fmu in release:
        files = {path for path in (fmu.directory / "binaries").rglob("*") if path.is_file()}
        assert files == {binary(fmu, platform) for platform in PLATFORMS}


@pytest.mark.parametrize("platform", PLATFORMS)
def test_library_exports_the_44_functions_and_nothing_else(release: tuple[Fmu, Fmu], platform: str) -> None:
    for fmu in release:
        names = {str(symbol.name) for symbol in lief.parse(binary(fmu, platform)).exported_functions}
        assert len(names) == 44 and all(name.startswith("fmi2") for name in names), sorted(names)


@pytest.mark.parametrize("platform", ["linux64", "aarch64-linux"])
def test_library_loads_on_glibc_2_17(release: tuple[Fmu, Fmu], platform: str) -> None:
    for fmu in release:
        needs = lief.parse(binary(fmu, platform)).symbols_version_requirement
        versions = {str(symbol.name) for need in needs for symbol in need.get_auxiliary_symbols()}
        assert versions
        assert all(tuple(map(int, name.removeprefix("GLIBC_").split("."))) <= (2, 17) for name in versions), versions


@pytest.mark.parametrize("platform", PLATFORMS)
def test_library_needs_only_the_system_s_own(release: tuple[Fmu, Fmu], platform: str) -> None:
    system = {"libc", "libm", "libdl", "libpthread", "ld-linux-x86-64", "ld-linux-aarch64"}
    windows = {"kernel32", "ntdll", "msvcrt", "api-ms-win-core-synch-l1-2-0"}
    for fmu in release:
        needed = {str(name).lower().split(".")[0] for name in lief.parse(binary(fmu, platform)).libraries}
        assert needed <= (windows if platform == "win64" else system)


@pytest.mark.parametrize("platform", PLATFORMS)
def test_no_binary_holds_a_path_of_the_machine_that_built_it(release: tuple[Fmu, Fmu], platform: str) -> None:
    for fmu in release:
        contents = binary(fmu, platform).read_bytes()
        assert str(Path.home()).encode() not in contents and str(ROOT).encode() not in contents


def plan(plant: Fmu, controller: Fmu) -> tuple[str, list[str]]:
    """What tests/c/crossing.c is to do, and the names of the values that it records."""

    def references(fmu: Fmu, names: list[str]) -> list[int]:
        return [fmu.variables[name].valueReference for name in names]

    def connected(from_: Fmu, to: Fmu) -> list[int]:
        names = [name for name in to.names("input") if name in from_.names("output")]
        pairs = zip(references(from_, names), references(to, names), strict=True)
        return [len(names), *(reference for pair in pairs for reference in pair)]

    numbers, recorded = [STEPS, *connected(plant, controller), *connected(controller, plant)], []
    for side, fmu in (("plant", plant), ("controller", controller)):
        names = fmu.names("output", "Real")
        numbers += [len(names), *references(fmu, names)]
        recorded += [f"{side}.{name}" for name in names]
    return " ".join(map(str, numbers)), recorded


def headers() -> Path:
    """The standard's headers, as FMPy brings them."""
    return Path(sysconfig.get_path("purelib")) / "fmpy" / "c-code"


def cross(directory: Path, both: tuple[Fmu, Fmu], platform: str) -> np.ndarray:
    """Runs the crossing in the platform's own host; one row a communication point."""
    how = PLATFORMS[platform]
    if how.start and shutil.which(how.start[0]) is None:
        pytest.skip(f"no {how.start[0]} on this machine (Debian: apt install {how.packages})")
    host = directory / "crossing.exe"
    compile_ = [sys.executable, "-m", "ziglang", "cc", "-O1", "-Wall", "-Wextra", "-Werror", "-target", how.zig_target]
    subprocess.run([*compile_, f"-I{headers()}", ROOT / "tests/c/crossing.c", "-o", host], check=True)
    numbers, recorded = plan(*both)
    (directory / "plan.txt").write_text(numbers)
    arguments: list[str] = []
    for fmu in both:
        library = shutil.copy(binary(fmu, platform), directory)
        arguments += [f"./{Path(library).name}", fmu.description.guid]
    done = subprocess.run(
        [*how.start, "./crossing.exe", *arguments, "plan.txt", "result.bin"],
        cwd=directory,
        env=os.environ | {"WINEPREFIX": str(directory / "wine"), "WINEDEBUG": "-all"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    # the variadic logger works: both refusals of a wrong GUID are told
    assert done.stderr.count("{wrong}") == 2, done.stderr
    return np.fromfile(directory / "result.bin").reshape(STEPS, len(recorded))


@pytest.mark.parametrize("platform", PLATFORMS)
def test_default_crossing_has_the_bits_of_this_machine_s_build(
    release: tuple[Fmu, Fmu], native: Run, platform: str, tmp_path: Path
) -> None:
    rows = cross(tmp_path, release, platform)
    for column, name in enumerate(plan(*release)[1]):
        expected, found = native[name][:STEPS].view(np.uint64), rows[:, column].copy().view(np.uint64)
        differs = np.flatnonzero(expected != found)
        assert not differs.size, f"{name} differs from step {differs[0]} on"
    assert len({tuple(row) for row in rows}) > STEPS // 2, "the robot does not move"
