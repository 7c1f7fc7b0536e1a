"""What a study found: tables and plots."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rps3_study import plots
from rps3_study.montecarlo import DEVIATIONS
from rps3_study.records import RunDirectory
from rps3_study.study import CRASHED, FAILED, FINISHED, Study
from rps3_study.tasks import MODES

BOUND = 10.0
"""Largest pose error of a successful run, mm: a fifth of the default crossing's 50 mm in heave."""

SUCCESS, ERROR, STOPPED = "success", "error", "end stop"
"""Values of `outcome` beside `FAILED` and `CRASHED`."""

STRATA = (0.0, 0.05, 0.10, 0.15, 0.20)
"""Borders of the table by geometry: the larger deviation of the two radii."""


def outcomes(table: pd.DataFrame, bound: float) -> pd.Series:
    """How each run ended: `failed` or `crashed`, at an `end stop`, with too large an `error`, or in `success`."""
    finished = table["status"] == FINISHED
    outcome = table["status"].where(~finished, SUCCESS)
    outcome = outcome.mask(finished & ~(table["peak_error"] <= bound), ERROR)
    return outcome.mask(finished & table["end_stop"].notna(), STOPPED)


def wilson(successes: int, runs: int) -> tuple[float, float]:
    """Wilson's 95 % confidence interval of a rate."""
    if runs == 0:
        return 0.0, 1.0
    z = 1.959963984540054
    rate, weight = successes / runs, z * z / runs
    center = (rate + weight / 2) / (1 + weight)
    half = z * math.sqrt(rate * (1 - rate) / runs + weight / runs / 4) / (1 + weight)
    return center - half, center + half


def by_mode(table: pd.DataFrame, study: Study, bound: float) -> str:
    """A Markdown table with a row for each grid point and mode."""
    axes = [axis.name for axis in study.axes]
    header = [*axes, "mode", "runs", "success, %", "95 % interval", "median", "90 %", "99 %", "largest"]
    header += ["above bound", "end stop", "failed", "crashed"]
    rows = []
    for key, group in table.assign(outcome=outcomes(table, bound)).groupby([*axes, "mode"]):
        *point, mode = key
        counts = group["outcome"].value_counts()
        successes = int(counts.get(SUCCESS, 0))
        low, high = wilson(successes, len(group))
        errors = group.loc[group["status"] == FINISHED, "peak_error"]
        quantiles = [f"{errors.quantile(q):.2f}" if len(errors) else "-" for q in (0.5, 0.9, 0.99, 1.0)]
        ends = [int(counts.get(name, 0)) for name in (ERROR, STOPPED, FAILED, CRASHED)]
        rate = [f"{100 * successes / len(group):.1f}", f"{100 * low:.1f} to {100 * high:.1f}"]
        rows.append([*(f"{value:g}" for value in point), MODES[mode], len(group), *rate, *quantiles, *ends])
    return markdown(header, rows)


def by_geometry(table: pd.DataFrame, bound: float) -> str:
    """A Markdown table of success rates (%) over the larger deviation of the two radii."""
    radii = table[["deviation_base_radius", "deviation_joint_spacing"]].abs().max(axis=1)
    table = table.assign(success=outcomes(table, bound) == SUCCESS)
    rows = []
    for low, high in itertools.pairwise(STRATA):
        stratum = table[(radii >= low) & (radii < high)]
        rates = stratum.groupby("mode")["success"].mean()
        shown = [f"{100 * rates[mode]:.0f}" if mode in rates else "-" for mode in MODES]
        rows.append([f"{100 * low:g} to {100 * high:g}", stratum["sample"].nunique(), *shown])
    return markdown(["radii off by, %", "robots", *MODES.values()], rows)


def facts(table: pd.DataFrame) -> str:
    """A Markdown table of how the modes compare robot by robot, and of what decides."""
    finished = table[table["status"] == FINISHED]
    errors = finished.pivot(index="sample", columns="mode", values="peak_error").dropna()
    rows: list[list[object]] = []
    for mode in errors.columns:
        rival = errors.drop(columns=mode).min(axis=1)
        cells = [
            f"{100 * (errors[mode] < errors[other]).mean():.0f}" if other != mode else "-" for other in errors.columns
        ]
        correlations = _correlations(finished[finished["mode"] == mode])
        strongest = max(correlations, key=lambda cause: abs(correlations[cause]))
        second = max(abs(value) for cause, value in correlations.items() if cause != strongest)
        cause = f"{strongest} ({correlations[strongest]:+.2f})"
        rows.append([MODES[mode], *cells, f"{100 * (errors[mode] < rival).mean():.0f}", cause, f"{second:.2f}"])
    header = ["on robots, %, smaller peak error than", *(MODES[mode] for mode in errors.columns), "all others"]
    return markdown([*header, "strongest cause (rank correlation)", "next"], rows)


def markdown(header: list[str], rows: list[list[object]]) -> str:
    """A Markdown table, the first column to the left and the others to the right."""
    lines = [header, ["---", *["---:"] * (len(header) - 1)], *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def write(directory: RunDirectory, bound: float) -> str:
    """Writes `summary.md` and the plots beside the records; returns the summary."""
    study, table = directory.study, directory.table()
    sections = [
        f"{len(table)} of {study.size} runs. Peak pose errors in mm over the runs that finished; a success finishes, "
        f"touches no end stop and keeps the pose error below {bound:g} mm.",
    ]
    if len(table):
        sections.append(by_mode(table, study, bound))
        if study.spread > 0.0 and not study.axes:
            sections.append(by_geometry(table, bound))
        reasons = table.loc[table["status"] != FINISHED, "reason"].value_counts()
        if len(reasons):
            sections.append(markdown(["runs", "reason"], [[count, reason] for reason, count in reasons.items()]))
        sections += [f"![{name}]({name}.svg)" for name in draw(table, study, bound, directory.directory)]
    text = "\n\n".join(sections) + "\n"
    (directory.directory / "summary.md").write_text(text, encoding="utf-8")
    return text


def draw(table: pd.DataFrame, study: Study, bound: float, directory: Path) -> list[str]:
    """Draws what there is to see of the study; returns the figures' names."""
    finished = table[table["status"] == FINISHED]
    figures = {}
    if not len(finished):
        return []
    if study.samples > 1:
        figures["errors"] = _distribution(table, bound)
    if study.samples > 1 and study.spread > 0.0:
        figures["influence"] = _influence(finished)
    if study.axes:
        figures["sweep"] = _sweep(finished, study)
    for name, figure in figures.items():
        plots.save(figure, directory / f"{name}.svg")
    return list(figures)


def _modes(table: pd.DataFrame) -> Iterator[tuple[str, pd.DataFrame]]:
    for mode, group in table.groupby("mode"):
        yield MODES[mode], group


def _distribution(table: pd.DataFrame, bound: float) -> Figure:
    """Share of all runs that finish within an error."""
    figure = Figure(figsize=(7.0, 4.0), layout="constrained")
    axis = figure.subplots()
    for mode, group in _modes(table):
        errors = np.sort(group.loc[group["status"] == FINISHED, "peak_error"])
        axis.step(errors, 100.0 * np.arange(1, len(errors) + 1) / len(group), where="post", label=mode)
    axis.axvline(bound, color="k", linestyle="--", linewidth=0.8, label="bound")
    axis.set(xscale="log", xlabel="peak pose error, mm", ylabel="runs within it, %", ylim=(0.0, 100.0))
    axis.grid(alpha=0.3)
    axis.legend(loc="best", fontsize="small")
    return figure


def _correlations(group: pd.DataFrame) -> dict[str, float]:
    """Rank correlation of the peak error with the size of what varies."""
    causes = {f"deviation_{name}": name for name in DEVIATIONS} | {"sensor_scale": "sensor_scale"}
    ranks = group["peak_error"].rank()
    return {name: float(group[cause].abs().rank().corr(ranks)) for cause, name in causes.items()}


def _influence(finished: pd.DataFrame) -> Figure:
    """Rank correlation of the peak error with the size of what varies, by mode."""
    rows = {mode: _correlations(group) for mode, group in _modes(finished)}
    modes, causes = list(rows), list(next(iter(rows.values())))
    values = np.array([list(row.values()) for row in rows.values()])
    figure = Figure(figsize=(7.0, 3.2), layout="constrained")
    axis = figure.subplots()
    image = axis.imshow(values, cmap="RdBu_r", vmin=-1.0, vmax=1.0, aspect="auto")
    axis.set_xticks(range(len(causes)), causes, rotation=35, ha="right")
    axis.set_yticks(range(len(modes)), modes)
    for (row, column), value in np.ndenumerate(values):
        axis.text(column, row, f"{value:+.2f}", ha="center", va="center", fontsize="x-small")
    figure.colorbar(image, label="rank correlation of\nits size with the peak error")
    return figure


def _sweep(finished: pd.DataFrame, study: Study) -> Figure:
    """Median peak error over each swept parameter, all others mixed."""
    figure = Figure(figsize=(7.0, 3.0 * len(study.axes)), layout="constrained")
    panels: list[Axes] = list(np.atleast_1d(figure.subplots(len(study.axes), 1)))
    for panel, axis in zip(panels, study.axes, strict=True):
        for mode, group in _modes(finished):
            medians = group.groupby(axis.name)["peak_error"].median()
            panel.plot(medians.index, medians, marker="o", label=mode)
        panel.set(xlabel=axis.name, ylabel="median peak error, mm", yscale="log")
        panel.grid(alpha=0.3)
    panels[0].legend(loc="best", fontsize="small")
    return figure
