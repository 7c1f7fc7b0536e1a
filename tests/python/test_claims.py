"""The documents' figures and verdicts are those of a fresh run."""

import dataclasses
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT
from rps3_study import baselines, documents
from rps3_study.claims import CLAIMS, FAILS, HOLDS, IN_PART, Check, number, verdict
from rps3_study.demo import measure
from rps3_study.fmu import Fmu
from rps3_study.metrics import Figures
from rps3_study.results import Case, Results
from rps3_study.tasks import MODES, VARIANTS, tasks

# Two digits are printed. Where a figure is sensitive (undamped modes at the singularity, three motors at the voltage
# limit) other last bits in the plant's solver move it by a tenth; verdicts have no tolerance.
TOLERANCE = 0.2
REFRESH = "run `cargo xtask demo`, then `python -m rps3_study.documents`"
NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?")


@pytest.fixture(scope="module")
def fresh(plant: Fmu, controller: Fmu) -> Results:
    _, results = measure(plant, controller, tasks(controller), list(MODES))
    return results


@pytest.fixture(scope="module")
def in_process(dist: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[Case, dict[str, Figures]]:
    """Figures of the example that `cargo test` has built."""
    program = ROOT / "target/debug/examples" / ("baselines.exe" if os.name == "nt" else "baselines")
    if not program.exists():
        pytest.skip(f"{program} is not there: cargo build --example baselines")
    described = [sys.executable, "-m", "rps3_study.baselines", "--dist", str(dist)]
    described = subprocess.run(described, check=True, capture_output=True).stdout
    path = tmp_path_factory.mktemp("baselines") / "baselines.json"
    path.write_bytes(subprocess.run([program], input=described, check=True, capture_output=True).stdout)
    return baselines.read(path)


def document(name: str) -> dict[str, str]:
    return documents.generated((ROOT / name).read_text(encoding="utf-8"))


def alike(written: str, measured: str) -> bool:
    """Equal text, and numbers that differ by the tolerance at most."""
    if NUMBER.sub("#", written) != NUMBER.sub("#", measured):
        return False
    pairs = zip(NUMBER.findall(written), NUMBER.findall(measured), strict=True)
    return all(float(a) == pytest.approx(float(b), rel=TOLERANCE, abs=1e-3) for a, b in pairs)


@pytest.mark.parametrize("part", ["claims", "why", "fixed"])
def test_claims_page_has_the_figures_and_verdicts_of_a_fresh_run(fresh: Results, part: str) -> None:
    written, measured = document("docs/claims.md")[part], documents.parts_of_results(fresh)[part]
    rows = list(zip(written.splitlines(), measured.splitlines(), strict=True))
    assert [pair for pair in rows if not alike(*pair)] == [], REFRESH


@pytest.mark.parametrize(
    ("name", "part"), [("docs/claims.md", "schemes"), ("docs/claims.md", "platform"), ("README.md", "peak errors")]
)
def test_tables_of_schemes_have_the_figures_of_a_fresh_run(
    fresh: Results, in_process: dict[Case, dict[str, Figures]], name: str, part: str
) -> None:
    complete = dataclasses.replace(fresh, baselines=baselines.only(in_process))
    rows = zip(document(name)[part].splitlines(), documents.parts_of_results(complete)[part].splitlines(), strict=True)
    assert [pair for pair in rows if not alike(*pair)] == [], REFRESH


def test_scheme_that_runs_both_ways_is_the_same_in_process_as_with_the_fmus(
    fresh: Results, in_process: dict[Case, dict[str, Figures]]
) -> None:
    for case, schemes in in_process.items():
        repeated, packaged = schemes[baselines.REPEATED], fresh.figures[case]["DRAC"]
        # the FMU's solver works at a tenth of the tolerance
        assert repeated.peak_error == pytest.approx(packaged.peak_error, rel=1e-3), case
        assert repeated.end_stop == packaged.end_stop


def test_verdict_says_whether_all_some_or_no_conditions_are_met() -> None:
    met, not_met = Check("", True), Check("", False)
    assert verdict([met, met]) == HOLDS
    assert verdict([met, not_met]) == IN_PART
    assert verdict([not_met]) == FAILS


def test_worse_figures_change_the_verdict(fresh: Results) -> None:
    """A tuned mode as bad as RAC with three motors loses the claims that it owes to its accuracy."""
    spoiled = Results(
        figures={case: {**row, "HDRAC+MPSO": row["RAC"]} for case, row in fresh.figures.items()},
        passages={case: {**row, "HDRAC+MPSO": row["RAC"]} for case, row in fresh.passages.items()},
        comparisons=fresh.comparisons,
    )
    changed = [claim for claim in CLAIMS if claim.judge(fresh).verdict != claim.judge(spoiled).verdict]
    assert {"No path has to avoid the singular point."} <= {claim.statement for claim in changed}
    assert not alike(documents.claims(fresh), documents.claims(spoiled))


def test_numbers_have_two_digits_and_no_exponent() -> None:
    assert [number(value) for value in (44.93, 0.0817, 123.4, 3e-6, 0.0, float("nan"))] == [
        "45",
        "0.082",
        "120",
        "below 0.0001",
        "0",
        "-",
    ]


def test_generated_parts_are_replaced_and_the_rest_is_kept() -> None:
    text = "before\n<!-- begin a b -->\nold\n<!-- end a b -->\n<!-- begin c -->\nkept\n<!-- end c -->\nafter\n"
    assert documents.generated(text) == {"a b": "old", "c": "kept"}
    assert documents.replaced(text, {"a b": "new\nlines"}) == text.replace("old", "new\nlines")


def test_every_task_and_variant_is_measured(fresh: Results, controller: Fmu) -> None:
    cases = {(task.key, variant) for task in tasks(controller) for variant in VARIANTS}
    assert set(fresh.figures) == set(fresh.passages) == cases
    assert all(list(row) == list(MODES.values()) for row in fresh.figures.values())
