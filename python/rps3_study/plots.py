"""Plots of runs, modes side by side."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from rps3_study.couple import Run
from rps3_study.metrics import VOLTAGES, pose_error

matplotlib.use("Agg")


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


def _largest_voltage(run: Run) -> np.ndarray:
    return np.max(np.abs([run[f"controller.{name}"] for name in VOLTAGES]), axis=0)


def figures(radius: float) -> dict[str, list[Panel]]:
    """The figures by file stem; `radius` (m) as in `metrics.pose_error`."""
    degrees = float(np.degrees(1.0))
    return {
        "coordinates": [
            Panel("heave, cm", _plant("heave", 100.0), _controller("heave_ref", 100.0)),
            Panel("tilt_x, deg", _plant("tilt_x", degrees), _controller("tilt_x_ref", degrees)),
            Panel("tilt_y, deg", _plant("tilt_y", degrees), _controller("tilt_y_ref", degrees)),
            Panel("pose error, mm", lambda run: pose_error(run, radius), scale="log"),
        ],
        "position": [Panel(f"{axis.upper()} of P, cm", _plant(f"p_{axis}", 100.0)) for axis in "xyz"],
        "velocity": [Panel(f"velocity {axis.upper()}, cm/s", _plant(f"v_{axis}", 100.0)) for axis in "xyz"],
        "forces": [Panel(f"axial force of limb {limb}, N", _plant(f"f_axial{limb}")) for limb in (1, 2, 3)],
        "control": [
            Panel("sigma_min", _plant("sigma_min")),
            Panel("largest |voltage|, V", _largest_voltage),
            Panel("rho", _controller("rho")),
            Panel("rho_hd, 1/s", _controller("rho_hd")),
            Panel("delta_hd", _controller("delta_hd")),
            Panel("lambda_f", _controller("lambda_f")),
        ],
    }


def draw(path: Path, title: str, runs: Mapping[str, Run], panels: list[Panel]) -> None:
    """Writes one figure with a curve for each run, the references dashed, to an SVG file."""
    figure = Figure(figsize=(9.0, 2.1 * len(panels)), layout="constrained")
    figure.suptitle(title)
    axes = np.atleast_1d(figure.subplots(len(panels), 1, sharex=True))
    for axis, panel in zip(axes, panels, strict=True):
        for mode, run in runs.items():
            axis.plot(run.time, panel.quantity(run), label=mode, linewidth=1.2)
        if panel.reference is not None:
            longest = max(runs.values(), key=lambda run: run.time.size)
            axis.plot(longest.time, panel.reference(longest), "k--", label="reference", linewidth=0.8)
        axis.set_ylabel(panel.label)
        axis.set_yscale(panel.scale)
        axis.grid(alpha=0.3)
    axes[0].legend(loc="best", ncols=len(runs) + 1, fontsize="small")
    axes[-1].set_xlabel("time, s")
    # fixed identifiers and no date: equal runs give equal files
    with matplotlib.rc_context({"svg.hashsalt": "rps3"}):
        figure.savefig(path, metadata={"Date": None})
