"""Fixtures: the packaged FMUs, from the directory in RPS3_DIST (default: dist/)."""

import csv
import io
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page, sync_playwright
from rps3_study.fmu import Fmu, Value, extracted

pytest_plugins = ["master_results"]
ROOT = Path(__file__).resolve().parents[2]
IDENTIFIERS = ("Rps3Plant", "Rps3Controller")
# software rendering: WebGL without a graphics card; no sandbox: it does not start for root
BROWSER_ARGUMENTS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"]


def pytest_addoption(parser: pytest.Parser) -> None:
    """`--long` for tests with two sizes."""
    parser.addoption("--long", action="store_true", help="the large counts, as `cargo xtask memory` runs them")


@pytest.fixture(scope="session")
def is_long(request: pytest.FixtureRequest) -> bool:
    """Whether the large counts are wanted."""
    return bool(request.config.getoption("--long"))


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


@pytest.fixture(scope="session")
def native() -> dict[str, np.ndarray]:
    """The default crossing of the core coupled without FMI, by variable: examples/trajectory.rs."""
    command = ["cargo", "run", "--quiet", "--package", "rps3", "--example", "trajectory"]
    text = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    header, *rows = csv.reader(io.StringIO(text))
    return dict(zip(header, np.array(rows, dtype=float).T, strict=True))


@pytest.fixture
def page() -> Iterator[Page]:
    """A page of an offline browser; at the end of the test its console must hold no error."""
    browser_program = next(filter(None, map(shutil.which, ("chromium", "google-chrome", "chromium-browser"))), None)
    if browser_program is None:
        pytest.skip("no Chromium on this machine (Debian: apt install chromium)")
    problems: list[str] = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=browser_program, args=BROWSER_ARGUMENTS)
        page = browser.new_context(offline=True, viewport={"width": 1500, "height": 950}).new_page()
        page.on("console", lambda message: problems.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: problems.append(str(error)))
        page.on("requestfailed", lambda request: problems.append(f"{request.url} is asked for and not there"))
        yield page
        browser.close()
    assert not problems
