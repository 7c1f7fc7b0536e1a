"""Draws how the swarm's search converges within a tick, from the CSV of examples/convergence.rs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from rps3_study import plots

TITLE = "Convergence of the swarm within a tick, default crossing"
SMALLEST = 1e-6
"""What the CSV does not tell from nothing."""
_RATIOS = {
    "median_ratio": "half of the ticks",
    "ninety_ratio": "90 % of the ticks",
    "ninety_nine_ratio": "99 % of the ticks",
}


def read(path: Path) -> np.ndarray:
    """Rows of (motors, iteration, shares of ticks, quantiles of the best fitness over the last)."""
    return np.genfromtxt(path, delimiter=",", names=True)


def draw(path: Path, table: np.ndarray) -> None:
    """Writes the figure to an SVG file: a column for six motors, one for three."""
    figure = Figure(figsize=(10, 6), layout="constrained")
    figure.suptitle(TITLE)
    axes = figure.subplots(2, 2, sharex=True, sharey="row")
    for column, motors in enumerate((6, 3)):
        rows = table[table["motors"] == motors]
        upper, lower = axes[:, column]
        upper.set_title(f"{motors} motors")
        for name, label in _RATIOS.items():
            upper.plot(rows["iteration"], np.maximum(rows[name] - 1.0, SMALLEST), label=label)
        upper.set_yscale("log")
        lower.plot(rows["iteration"], 100.0 * rows["within_1_percent"], label="within 1 % of the last")
        lower.plot(rows["iteration"], 100.0 * rows["searching"], label="still searching")
        lower.set_xlabel("iteration")
        for axis in (upper, lower):
            axis.grid(alpha=0.3)
            axis.legend(fontsize="small")
    axes[0, 0].set_ylabel("excess of the best fitness over the last, at most")
    axes[1, 0].set_ylabel("ticks, %")
    plots.save(figure, path)
