"""Results for docs/masters.md: what a test marked `master` found goes into a file in RPS3_RESULTS, if that is set."""

import json
import os
import re
from collections.abc import Callable, Generator
from importlib.metadata import version
from pathlib import Path

import pytest

DISTRIBUTIONS = {"FMPy": "fmpy", "fmutool": "fmu-manipulation-toolbox", "libcosim": "libcosimpy", "ECOS": "ecospy"}


@pytest.fixture
def keeps_within(request: pytest.FixtureRequest) -> Callable[[float, float], None]:
    """Files a master's largest distance from the native trajectory and asserts a bound, both in m."""

    def check(distance: float, bound: float) -> None:
        request.node.user_properties += [("distance", float(distance)), ("bound", bound)]
        assert distance <= bound

    return check


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    directory = os.environ.get("RPS3_RESULTS")
    if directory is not None and (report.when == "call" or not report.passed):
        for mark in item.iter_markers("master"):
            name, feature = mark.args
            record = {
                "master": name,
                "version": version(DISTRIBUTIONS[name]),
                "feature": feature,
                "outcome": report.outcome,
                **{key: value for key, value in item.user_properties if key in ("distance", "bound")},
            }
            file = re.sub(r"\W+", "_", f"{name} {feature} {item.nodeid}")
            Path(directory, f"{file}.json").write_text(json.dumps(record), encoding="utf-8")
    return report
