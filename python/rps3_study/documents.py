"""Rewrites the generated parts of the documents: `python -m rps3_study.documents`.

A generated part stands between two comments, `<!-- begin NAME -->` and `<!-- end NAME -->`. Those that come from the
demo's `results.json` and those from a robustness study are rewritten each if its source is there.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from rps3_study import summary
from rps3_study.claims import DRAC, HDRAC, MPSO, PLATFORM, SEARCHED, STIFF, Check, judge_all, number, verdict
from rps3_study.records import RunDirectory
from rps3_study.results import Results
from rps3_study.summary import markdown
from rps3_study.tasks import MODES, VARIANTS

ROOT = Path(__file__).resolve().parents[2]
TITLES = {
    "smooth": "crossing, smooth",
    "constant_speed": "crossing, constant speed",
    "sensors": "the same, sensors of Table 1",
    "push": "crossing, pushed",
    "stop": "stop at the singular pose",
    "stop_push": "stopped there, pushed",
}
README_TASKS = ("smooth", "constant_speed", "stop_push")
TABLES = ("README.md", "docs/claims.md", "docs/study.md")
"""Documents with generated parts."""


def peak_errors(results: Results) -> str:
    """Peak errors of modes and platform coordinates, for the README."""
    header = ["peak pose error, mm", *(f"{TITLES[task]}, {v.split()[0]}" for task in README_TASKS for v in VARIANTS)]
    rows: list[list[object]] = []
    for scheme in (*MODES.values(), PLATFORM):
        cells = []
        for task in README_TASKS:
            for variant in VARIANTS:
                case = task, variant
                figures = (results.figures[case] | results.baselines.get(case, {})).get(scheme)
                cells.append("-" if figures is None else number(figures.peak_error) + "*" * figures.end_stop)
        rows.append([scheme, *cells])
    return markdown(header, rows)


def claims(results: Results) -> str:
    """The table of claims."""
    header = ["place", "claim", "counts as met", "measured", "verdict"]
    lines = [header, ["---"] * len(header)]
    for claim, judgement in judge_all(results):
        lines.append([claim.place, claim.statement, claim.test, judgement.figures, f"**{judgement.verdict}**"])
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def schemes(results: Results) -> str:
    """Peak errors of all schemes in all tasks."""
    parts = []
    for variant in VARIANTS:
        cases = [case for case in results.figures if case[1] == variant]
        names = list(
            dict.fromkeys(name for case in cases for name in (*results.figures[case], *results.baselines.get(case, {})))
        )
        rows: list[list[object]] = []
        for name in names:
            found = [(results.figures[case] | results.baselines.get(case, {})).get(name) for case in cases]
            rows.append([name, *("-" if f is None else number(f.peak_error) + "*" * f.end_stop for f in found)])
        parts.append(markdown([f"{variant}: peak error, mm", *(TITLES[task] for task, _ in cases)], rows))
    return "\n\n".join(parts)


def why(results: Results) -> str:
    """Where fixed HDRAC loses to DRAC."""
    header = ["task", "motors", "DRAC, mm", "HDRAC, mm", "at the singular pose: DRAC, mm/s", "HDRAC, mm/s"]
    header += ["HDRAC+MPSO, mm/s", "left at the end: DRAC, mm", "HDRAC, mm", "braking: HDRAC, %", "HDRAC+MPSO, %"]
    rows: list[list[object]] = []
    for task, variant in results.figures:
        figures, passages = results.figures[task, variant], results.passages[task, variant]
        speeds = [number(passages[mode].speed) for mode in (DRAC, HDRAC, MPSO)]
        ends = [number(passages[mode].final_error) for mode in (DRAC, HDRAC)]
        errors = [number(figures[mode].peak_error) + "*" * figures[mode].end_stop for mode in (DRAC, HDRAC)]
        braking = [share(passages[mode].braking) for mode in (HDRAC, MPSO)]
        rows.append([TITLES[task], variant.split()[0], *errors, *speeds, *ends, *braking])
    return markdown(header, rows)


def share(value: float) -> str:
    """A share in per cent, as coarse as it is reproducible."""
    return "below 10" if value < 0.1 else f"{100 * value:.0f}"


def fixed(results: Results) -> str:
    """The best fixed damping in hindsight."""
    factors = ["rho", "delta_hd", "lambda_f"]
    header = ["task", "motors", "HDRAC+MPSO, mm", "over seeds, mm"]
    header += ["best fixed, mm", *factors, "gains free: mm", *factors, "K_P, 1/s2"]
    rows: list[list[object]] = []
    for (task, variant), compared in results.comparisons.items():
        own = results.figures[task, variant][MPSO].peak_error
        seeds = f"{number(min(compared.over_seeds))} to {number(max(compared.over_seeds))}"
        cells = [
            cell
            for fixed in (compared.best_fixed, compared.best_gains)
            for cell in (number(fixed.peak_error), *map("{:g}".format, (fixed.rho, fixed.delta_hd, fixed.lambda_f)))
        ]
        rows.append([TITLES[task], variant.split()[0], number(own), seeds, *cells, f"{compared.best_gains.k_p:g}"])
    return markdown(header, rows)


def against_platform(results: Results) -> str:
    """What the tuned mode adds to computed torque in platform coordinates."""
    header = ["task", "motors", "HDRAC+MPSO, mm", "platform coordinates, mm", "K_P 3600, mm", "MPSO"]
    header += ["lambda_f searched, mm"]
    rows: list[list[object]] = []
    for (task, variant), schemes in results.baselines.items():
        own = results.figures[task, variant][MPSO].peak_error
        fixed, stiff, searched = (schemes[name].peak_error for name in (PLATFORM, STIFF, SEARCHED))
        ratio = own / min(fixed, stiff)
        outcome = "adds" if ratio < 0.8 else "loses" if ratio > 1.25 else "adds nothing"
        rows.append([TITLES[task], variant.split()[0], *map(number, (own, fixed, stiff)), outcome, number(searched)])
    return markdown(header, rows)


def parts_of_results(results: Results) -> dict[str, str]:
    """Generated parts that come from the demo."""
    return {
        "peak errors": peak_errors(results),
        "claims": claims(results),
        "why": why(results),
        "schemes": schemes(results),
        "fixed": fixed(results),
        "platform": against_platform(results),
    }


def parts_of_study(directory: RunDirectory, bound: float = summary.BOUND) -> dict[str, str]:
    """Generated parts that come from the robustness study."""
    table = directory.table()
    return {
        "robustness by mode": summary.by_mode(table, directory.study, bound),
        "robustness by geometry": summary.by_geometry(table, bound),
        "robustness facts": summary.facts(table),
        "robustness claim": robustness(table, bound),
    }


def robustness(table: pd.DataFrame, bound: float) -> str:
    """The paper's claim of robustness as a sentence."""
    success = (summary.outcomes(table, bound) == summary.SUCCESS).groupby(table["mode"]).mean()
    rates = {MODES[mode]: rate for mode, rate in success.items()}
    own, best = rates[MPSO], max(rate for mode, rate in rates.items() if mode != MPSO)
    checks = [Check(f"{100 * own:.0f} % of the runs succeed", own >= 0.9), Check(f"{100 * best:.0f} %", own > best)]
    return (
        f"Section 6.3, HDRAC with MPSO has great robustness (more successes than any fixed mode, and at least 90 %): "
        f"{checks[0].figures}, with the best fixed mode {checks[1].figures}; **{verdict(checks)}**."
    )


def generated(text: str) -> dict[str, str]:
    """The generated parts of a document, by name."""
    return dict(re.findall(r"<!-- begin ([\w ]+) -->\n(.*?)\n<!-- end \1 -->", text, re.DOTALL))


def replaced(text: str, parts: Mapping[str, str]) -> str:
    """The document with those of its parts replaced that there are."""

    def part(match: re.Match[str]) -> str:
        return f"<!-- begin {match[1]} -->\n{parts.get(match[1], match[2])}\n<!-- end {match[1]} -->"

    return re.sub(r"<!-- begin ([\w ]+) -->\n(.*?)\n<!-- end \1 -->", part, text, flags=re.DOTALL)


def main() -> None:
    """Rewrites what there are sources for."""
    parser = argparse.ArgumentParser(prog="rps3_study.documents", description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--results", type=Path, default=Path("dist/report/results.json"), help="of the demo; default: %(default)s")
    add("--study", type=Path, default=Path("studies/robustness"), help="of the study; default: %(default)s")
    options = parser.parse_args()
    parts: dict[str, str] = {}
    if options.results.exists():
        parts |= parts_of_results(Results.read(options.results))
    if (options.study / "study.json").exists():
        with RunDirectory.open(options.study) as directory:
            parts |= parts_of_study(directory)
    for name in TABLES:
        path = ROOT / name
        before = path.read_text(encoding="utf-8")
        after = replaced(before, parts)
        path.write_text(after, encoding="utf-8", newline="\n")
        state = "rewritten" if after != before else "unchanged"
        fresh = [part for part in generated(before) if part in parts]
        print(f"{name}: {', '.join(fresh) if fresh else 'no source for its parts'} ({state})")


if __name__ == "__main__":
    main()
