"""Writes the study's report: CSV files, plots, and the tables in Markdown and HTML."""

from __future__ import annotations

import html
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rps3_study import convergence, design_study, plots, report_page
from rps3_study.couple import Run
from rps3_study.data_url import data_url
from rps3_study.geometry import Geometry
from rps3_study.results import Results
from rps3_study.tasks import Task


@dataclass(frozen=True)
class Case:
    """The runs of one task with one actuation variant, by control mode."""

    task: Task
    variant: str
    runs: Mapping[str, Run]

    @property
    def stem(self) -> str:
        """Stem of this case's file names."""
        return f"{self.task.key}-{self.variant.replace(' ', '-')}"

    @property
    def title(self) -> str:
        """What it is, for people."""
        return f"{self.task.title}, {self.variant}"


@dataclass(frozen=True)
class PaperFigure:
    """Counterpart of a figure in the paper."""

    number: int
    task: str
    """Key of the task."""
    modes: tuple[str, ...]


PAPER_FIGURES = (
    PaperFigure(7, "constant_speed", ("HDRAC", "HDRAC+MPSO")),
    PaperFigure(9, "sensors", ("DRAC",)),
    PaperFigure(10, "sensors", ("HDRAC", "HDRAC+MPSO")),
)
"""7 is a simulation; 9 and 10 are measured, for which runs with the sensors' errors stand in."""


def write(
    directory: Path, cases: list[Case], geometry: Geometry, results: Results, searches: Path | None = None
) -> Path:
    """Writes the report into `directory` and returns its HTML page.

    Args:
        directory: of the report.
        cases: runs.
        geometry: the plant's in all runs.
        results: figures of the runs.
        searches: table of examples/convergence.rs.
    """
    radius = geometry.joint_radius
    for part in ("data", "plots"):
        (directory / part).mkdir(parents=True, exist_ok=True)
    results.write(directory / "results.json")
    markdown = ["# Crossing a direct singularity", "", _INTRODUCTION, ""]
    tables = []
    for case in cases:
        header, rows = table(case, results)
        markdown += [f"## {case.title}", "", markdown_table(header, rows), ""]
        tables.append(f'<div class="case"><h3>{html.escape(case.title)}</h3>\n{html_table(header, rows)}</div>')
        for mode, run in case.runs.items():
            stem = f"{case.stem}-{mode.lower().replace('+', '-')}"
            _write_csv(directory / "data" / f"{stem}.csv", run)
        for image in _draw(directory, case, radius):
            markdown += [f"![{Path(image).stem}]({image})", ""]
    if searches is not None:
        image = directory / "plots/convergence.svg"
        convergence.draw(image, convergence.read(searches))
        markdown += [f"## {convergence.TITLE}", "", "![convergence](plots/convergence.svg)", ""]
        source = data_url("image/svg+xml", image.read_text(encoding="utf-8"))
        picture = f'<img alt="{convergence.TITLE}" src="{source}">'
        tables.append(f'<div class="case"><h3>{convergence.TITLE}</h3>\n{picture}</div>')
    (directory / "report.md").write_text("\n".join(markdown), encoding="utf-8")
    index = directory / "index.html"
    index.write_text(report_page.render(cases, geometry, _INTRODUCTION, tables), encoding="utf-8")
    return index


def _draw(directory: Path, case: Case, radius: float) -> list[str]:
    """Draws a case; returns the images' paths."""
    images = []
    for stem, panels in plots.figures(radius).items():
        images.append(f"plots/{case.stem}-{stem}.svg")
        plots.draw(directory / images[-1], case.title, case.runs, panels)
    for figure in PAPER_FIGURES:
        runs = {mode: case.runs[mode] for mode in figure.modes if mode in case.runs}
        if case.task.key == figure.task and runs:
            images.append(f"plots/figure-{figure.number}-{case.variant.replace(' ', '-')}.svg")
            title = f"Counterpart of Figure {figure.number}. {case.title}"
            plots.draw(directory / images[-1], title, runs, plots.paper_figure(radius), columns=2)
    return images


def table(case: Case, results: Results) -> tuple[list[str], list[list[str]]]:
    """Header and rows of a case's table: modes, with the design study's figures where there are some, and baselines."""
    compared = case.task.key == design_study.TASK
    header = ["scheme", "peak error, mm", "rms error, mm", "peak voltage, V", "saturated, ms"]
    header += ["peak error of the design study, mm"] if compared else []
    header += ["remarks"]
    key = case.task.key, case.variant
    rows = []
    for scheme, result in (results.figures[key] | results.baselines.get(key, {})).items():
        row = [scheme, *map(_number, (result.peak_error, result.rms_error, result.peak_voltage))]
        row.append(_number(1e3 * result.saturation_time))
        if compared:
            row.append(_number(design_study.PEAK_ERROR.get((case.variant, scheme), math.nan)))
        remarks = ["reaches an end stop"] if result.end_stop else []
        remarks += [f"ended early: {result.failure}"] if result.failure else []
        rows.append([*row, "; ".join(remarks)])
    return header, rows


def markdown_table(header: list[str], rows: list[list[str]]) -> str:
    """A table in GitHub's Markdown; all columns but the first and last to the right."""
    rule = ["---", *["---:"] * (len(header) - 2), "---"]
    lines = [header, rule, *([cell.replace("|", "\\|") for cell in row] for row in rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def html_table(header: list[str], rows: list[list[str]]) -> str:
    """The same table in HTML."""
    head = "".join(f"<th>{html.escape(cell)}</th>" for cell in header)
    body = "\n".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>\n{body}\n</tbody></table>"


def _number(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.3g}"


def _write_csv(path: Path, run: Run) -> None:
    np.savetxt(
        path,
        np.column_stack(list(run.values.values())),
        fmt="%.9g",
        delimiter=",",
        header=",".join(run.values),
        comments="",
    )


_INTRODUCTION = (
    "Both FMUs, coupled by FMPy at 1 kHz, controller first at each step. The pose error is the largest of the heave "
    "error and r_b times the tilt errors, r_b being the radius of the spherical joints' circle. RAC: resolved "
    "acceleration; DRAC: damped accelerations; HDRAC: damped velocities as well; fixed factors but for MPSO, which "
    "searches them at each sample. The other rows of the tables are what one would otherwise pick, run in process: "
    "damping that follows the manipulability or the smallest singular value, and computed torque in the platform's own "
    "coordinates. The design study knew the pose exactly and searched a grid in place of the swarm."
)
