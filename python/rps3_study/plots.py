"""Plots of runs, modes side by side."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rps3_study.couple import Run
from rps3_study.geometry import reference_positions
from rps3_study.metrics import VOLTAGES, pose_error

matplotlib.use("Agg")


class Style(NamedTuple):
    """How a mode is drawn: colours that the colour-blind tell apart (Okabe and Ito), and dashes for print."""

    colour: str
    dash: str
    """As Plotly names it."""


STYLES = {
    "RAC": Style("#d55e00", "dot"),
    "DRAC": Style("#b98300", "dashdot"),
    "HDRAC": Style("#0072b2", "dash"),
    "HDRAC+MPSO": Style("#009e73", "solid"),
}
REFERENCE = Style("#b4bac1", "solid")
_DASHES = {"dot": ":", "dashdot": "-.", "dash": "--", "solid": "-"}
MARGIN = 0.6
"""A diagram with a reference shows so much beyond the reference's own range, by its size."""


class Panel(NamedTuple):
    """One diagram: its quantity over time, an optional reference, the scale of the vertical axis."""

    label: str
    quantity: Callable[[Run], np.ndarray]
    reference: Callable[[Run], np.ndarray] | None = None
    scale: str = "linear"


def _plant(name: str, factor: float = 1.0) -> Callable[[Run], np.ndarray]:
    return lambda run: factor * run[f"plant.{name}"]


def _controller(name: str, factor: float = 1.0) -> Callable[[Run], np.ndarray]:
    return lambda run: factor * run[f"controller.{name}"]


def _at_least(floor: float, quantity: Callable[[Run], np.ndarray]) -> Callable[[Run], np.ndarray]:
    """For a logarithmic scale: what is practically zero lies on the floor."""
    return lambda run: np.maximum(quantity(run), floor)


def _where_searched(quantity: Callable[[Run], np.ndarray]) -> Callable[[Run], np.ndarray]:
    """Leaves out modes without a swarm."""
    return lambda run: np.where(run["controller.mpso_iterations"] > 0, quantity(run), np.nan)


def _largest_voltage(run: Run) -> np.ndarray:
    return np.max(np.abs([run[f"controller.{name}"] for name in VOLTAGES]), axis=0)


def _translation(axis: int, radius: float) -> Panel:
    name = "xyz"[axis]
    return Panel(
        f"{name.upper()} of P, cm",
        _plant(f"p_{name}", 100.0),
        lambda run: 100.0 * reference_positions(run, radius)[:, axis],
    )


def _velocity(axis: int, radius: float) -> Panel:
    name = "xyz"[axis]
    return Panel(
        f"velocity {name.upper()} of P, cm/s",
        _plant(f"v_{name}", 100.0),
        lambda run: 100.0 * np.gradient(reference_positions(run, radius)[:, axis], run.time),
    )


def figures(radius: float) -> dict[str, list[Panel]]:
    """The figures by file stem; `radius` (m) as in `metrics.pose_error`."""
    degrees = float(np.degrees(1.0))
    return {
        "coordinates": [
            Panel("heave, cm", _plant("heave", 100.0), _controller("heave_ref", 100.0)),
            Panel("tilt_x, deg", _plant("tilt_x", degrees), _controller("tilt_x_ref", degrees)),
            Panel("tilt_y, deg", _plant("tilt_y", degrees), _controller("tilt_y_ref", degrees)),
            Panel("pose error, mm", _at_least(1e-4, lambda run: pose_error(run, radius)), scale="log"),
        ],
        "position": [_translation(axis, radius) for axis in range(3)],
        "velocity": [_velocity(axis, radius) for axis in range(3)],
        "forces": [
            *(Panel(f"axial force of limb {limb}, N", _plant(f"f_axial{limb}")) for limb in (1, 2, 3)),
            Panel("largest |voltage|, V", _largest_voltage),
        ],
        "damping": [
            Panel("sigma_min", _at_least(1e-5, _plant("sigma_min")), scale="log"),
            Panel("rho (1e-6: none)", _at_least(1e-6, _controller("rho")), scale="log"),
            Panel("delta_hd (1e-6: none)", _at_least(1e-6, _controller("delta_hd")), scale="log"),
            Panel("rho_hd, 1/s", _controller("rho_hd")),
            Panel("lambda_f (1e-6: none)", _at_least(1e-6, _controller("lambda_f")), scale="log"),
        ],
        "swarm": [
            Panel("best fitness, m2", _where_searched(_controller("mpso_fitness")), scale="log"),
            Panel("iterations a sample", _where_searched(_controller("mpso_iterations"))),
        ],
    }


def paper_figure(radius: float) -> list[Panel]:
    """The paper's Figures 7, 9 and 10: position and velocity along X, Y and Z, in two columns."""
    return [panel(axis, radius) for axis in range(3) for panel in (_translation, _velocity)]


def window(panel: Panel, runs: Mapping[str, Run]) -> tuple[float, float] | None:
    """Vertical range of a diagram with a reference: a mode that leaves it must not flatten the others."""
    longest = max(runs.values(), key=lambda run: run.time.size)
    if panel.reference is None or longest.time.size == 0:
        return None
    wanted = panel.reference(longest)
    beyond = MARGIN * (wanted.max() - wanted.min())
    seen = np.concatenate([wanted, *(panel.quantity(run) for run in runs.values())])
    low, high = max(seen.min(), wanted.min() - beyond), min(seen.max(), wanted.max() + beyond)
    edge = 0.04 * (high - low)
    return (float(low - edge), float(high + edge)) if edge > 0.0 else None


def draw(path: Path, title: str, runs: Mapping[str, Run], panels: list[Panel], columns: int = 1) -> None:
    """Writes one figure with a curve for each run, the references in grey, to an SVG file."""
    rows = len(panels) // columns
    figure = Figure(figsize=(4.5 * (1 + columns), 2.1 * rows), layout="constrained")
    figure.suptitle(title)
    axes: list[Axes] = list(np.atleast_1d(figure.subplots(rows, columns, sharex=True)).flat)
    for axis, panel in zip(axes, panels, strict=True):
        if panel.reference is not None:
            longest = max(runs.values(), key=lambda run: run.time.size)
            axis.plot(longest.time, panel.reference(longest), REFERENCE.colour, label="reference", linewidth=3.5)
        for mode, run in runs.items():
            colour, dash = STYLES[mode]
            values = panel.quantity(run)
            if np.isfinite(values).any():
                axis.plot(run.time, values, color=colour, linestyle=_DASHES[dash], label=mode, linewidth=1.2)
        axis.set_ylabel(panel.label)
        axis.set_yscale(panel.scale)
        axis.set_ylim(window(panel, runs))
        axis.grid(alpha=0.3)
    for axis in axes[-columns:]:
        axis.set_xlabel("time, s")
    seen = {label: handle for axis in axes for handle, label in zip(*axis.get_legend_handles_labels(), strict=True)}
    handles = {label: seen[label] for label in ("reference", *STYLES) if label in seen}
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=len(STYLES) + 1, fontsize="small")
    save(figure, path)


def save(figure: Figure, path: Path) -> None:
    """Writes an SVG file with fixed identifiers and no date: equal figures give equal files."""
    with matplotlib.rc_context({"svg.hashsalt": "rps3"}):
        figure.savefig(path, metadata={"Date": None})
