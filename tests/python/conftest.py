"""Fixtures: the packaged FMUs, from the directory in RPS3_DIST (default: dist/)."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from rps3_study.fmu import Fmu, Value, extracted

ROOT = Path(__file__).resolve().parents[2]
IDENTIFIERS = ("Rps3Plant", "Rps3Controller")


@pytest.fixture(scope="session")
def dist() -> Path:
    """Directory of the archives."""
    directory = Path(os.environ.get("RPS3_DIST", ROOT / "dist"))
    missing = [name for name in IDENTIFIERS if not (directory / f"{name}.fmu").exists()]
    if missing:
        pytest.exit(f"{', '.join(missing)} not in {directory}: run `cargo xtask package`", returncode=2)
    return directory


@pytest.fixture(scope="session")
def fmus(dist: Path) -> Iterator[dict[str, Fmu]]:
    """Both FMUs, extracted, by model identifier."""
    with extracted(*(dist / f"{name}.fmu" for name in IDENTIFIERS)) as both:
        yield dict(zip(IDENTIFIERS, both, strict=True))


@pytest.fixture(scope="session")
def plant(fmus: dict[str, Fmu]) -> Fmu:
    """The Rps3Plant FMU."""
    return fmus["Rps3Plant"]


@pytest.fixture(scope="session")
def controller(fmus: dict[str, Fmu]) -> Fmu:
    """The Rps3Controller FMU."""
    return fmus["Rps3Controller"]


@pytest.fixture(params=IDENTIFIERS)
def fmu(request: pytest.FixtureRequest, fmus: dict[str, Fmu]) -> Fmu:
    """Each of the FMUs in turn."""
    return fmus[request.param]


@pytest.fixture
def settings(fmu: Fmu) -> dict[str, Value]:
    """Parameters with which the FMU at hand runs fast and without random numbers."""
    return {"control_mode": 2} if "control_mode" in fmu.variables else {}
