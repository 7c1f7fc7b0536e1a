"""Integrators on the plant: error against right-hand sides and time, as table and picture."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.ticker import NullFormatter

from suite.peers import Native
from suite.table import Listing, duration

PROBLEMS = {"held": "voltages that jump each millisecond", "smooth": "0.3 s in one piece"}
# an error that the plant's step must keep, and what it costs
ERROR = 1e-6


def cost_at(points: list[dict[str, float]], quantity: str, error: float = ERROR) -> float | None:
    """The least of a quantity among the tolerances at which the error is below `error`."""
    return min((point[quantity] for point in points if point["error"] <= error), default=None)


def measure(native: Native, rounds: int) -> tuple[list[dict], Listing]:
    """All rows, and for each integrator what an error below 1e-6 costs."""
    rows = native.measure("work_precision", rounds=rounds)
    integrators = list(dict.fromkeys(row["integrator"] for row in rows))
    cells = []
    for integrator in integrators:
        line = [integrator]
        for problem in PROBLEMS:
            points = [row for row in rows if (row["integrator"], row["problem"]) == (integrator, problem)]
            evaluations, seconds = (cost_at(points, quantity) for quantity in ("evaluations", "seconds"))
            line += ["-", "-"] if seconds is None else [f"{evaluations:.1f}", duration(seconds)]
        cells.append(line)
    head = ["integrator", "held: right-hand sides a ms", "time a ms", "smooth: right-hand sides a ms", "time a ms"]
    return rows, Listing("work-precision", head, cells)


def draw(rows: list[dict], path: Path) -> None:
    """Error over right-hand sides (left) and time (right), a row of pictures a problem."""
    plt.rcParams["svg.hashsalt"] = "rps3"
    figure, axes = plt.subplots(len(PROBLEMS), 2, figsize=(11, 9.5), sharey="row", layout="constrained")
    integrators = list(dict.fromkeys(row["integrator"] for row in rows))
    for line, (problem, title) in zip(axes, PROBLEMS.items(), strict=True):
        for axis, (quantity, scale, label) in zip(
            line,
            [("evaluations", 1.0, "right-hand sides a millisecond"), ("seconds", 1e6, "time a millisecond, us")],
            strict=True,
        ):
            for k, integrator in enumerate(integrators):
                points = [row for row in rows if (row["integrator"], row["problem"]) == (integrator, problem)]
                own = integrator.endswith("rps3")
                axis.loglog(
                    [point[quantity] * scale for point in points],
                    [point["error"] for point in points],
                    marker="osD^vPX*<>"[k % 10],
                    markersize=7 if own else 4,
                    linewidth=2.5 if own else 1,
                    color="black" if own else f"C{k - 1}",
                    label=integrator,
                )
            axis.set_xlabel(label)
            axis.set_title(title)
            axis.xaxis.set_minor_formatter(NullFormatter())
            axis.grid(visible=True, which="major", alpha=0.3)
        line[0].set_ylabel("largest error over the states' nominal magnitudes")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None, dpi=110)
    plt.close(figure)
