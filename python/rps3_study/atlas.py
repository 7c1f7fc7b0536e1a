"""Draws the surface of direct singularities from the CSV of examples/atlas.rs."""

import sys
from pathlib import Path
from xml.etree import ElementTree

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

SECTIONS = (0.0, 9.0, 21.0, 30.0)


def waypoints(description: Path) -> np.ndarray:
    """Default start, singular pose and end of the crossing, a row each: tilt_x, tilt_y (deg), heave (cm)."""
    starts = {
        variable.get("name"): variable[0].get("start")
        for variable in ElementTree.parse(description).iterfind("ModelVariables/ScalarVariable")
    }
    names = [[f"{point}_{c}" for c in ("tilt_x", "tilt_y", "heave")] for point in ("start", "via", "end")]
    points = np.array([[float(starts[name]) for name in row] for row in names])
    return points * [np.rad2deg(1.0), np.rad2deg(1.0), 100.0]


def sheets(table: np.ndarray) -> list[np.ndarray]:
    """The table as grids over (tilt, direction), one for each of the cubic's sorted roots, NaN where there is none."""
    tilts, directions = np.unique(table["tilt_deg"]), np.unique(table["direction_deg"])
    grids = []
    for sheet in np.unique(table["sheet"]):
        rows = table[table["sheet"] == sheet]
        grid = np.full((len(tilts), len(directions)), np.nan, dtype=[(name, float) for name in table.dtype.names])
        place = np.searchsorted(tilts, rows["tilt_deg"]), np.searchsorted(directions, rows["direction_deg"])
        for name in table.dtype.names:
            grid[name][place] = rows[name]
        grids.append(grid)
    return grids


def draw_sections(axes: plt.Axes, grids: list[np.ndarray]) -> None:
    """Singular heaves over the tilt at constant directions, faint beyond a joint limit."""
    for k, direction in enumerate(SECTIONS):
        for grid in grids:
            rows = grid[grid["direction_deg"] == direction]
            heave, inside = 100 * rows["heave_m"], rows["within_limits"] == 1
            axes.plot(rows["tilt_deg"], heave, color=f"C{k}", lw=0.8, alpha=0.35)
            axes.plot(rows["tilt_deg"], np.where(inside, heave, np.nan), color=f"C{k}", lw=2.5)
    legend = [Line2D([], [], color=f"C{k}", lw=2.5, label=f"{d:g} deg") for k, d in enumerate(SECTIONS)]
    axes.legend(handles=legend, title="direction (faint: beyond a joint limit)", loc="lower left")
    axes.set(xlabel="tilt (deg)", ylabel="singular heave (cm)", ylim=(-20, 20), title="Sections at constant direction")
    axes.grid(alpha=0.3)


def draw_surface(axes: plt.Axes, grids: list[np.ndarray], crossing: np.ndarray) -> None:
    """The surface within the joint limits, and the default crossing through it."""
    norm = plt.Normalize(0.0, 10.0)
    for grid in grids:
        inside = grid["within_limits"] == 1
        direction = np.deg2rad(grid["direction_deg"])
        x, y = grid["tilt_deg"] * np.cos(direction), grid["tilt_deg"] * np.sin(direction)
        heave = np.where(inside, 100 * grid["heave_m"], np.nan)
        colors = plt.cm.viridis(norm(np.nan_to_num(heave)))
        axes.plot_surface(x, y, heave, facecolors=colors, rstride=1, cstride=1, alpha=0.75, shade=False, linewidth=0)
    # in front of the surface, through which it passes
    axes.plot(*crossing.T, color="crimson", lw=2.5, zorder=10, label="default crossing")
    via = crossing[1:2].T
    axes.plot(*via, color="crimson", marker="o", zorder=11, linestyle="none", label="its singular pose")
    axes.legend(loc="upper left")
    axes.view_init(elev=22, azim=-65)
    axes.set(xlabel="tilt_x (deg)", ylabel="tilt_y (deg)", zlabel="heave (cm)", title="Within the joint limits")


def draw(table: np.ndarray, crossing: np.ndarray, path: Path) -> None:
    """Both views of the surface as a picture at `path`."""
    grids = sheets(table)
    figure = plt.figure(figsize=(13, 5.5), layout="constrained")
    draw_sections(figure.add_subplot(1, 2, 1), grids)
    draw_surface(figure.add_subplot(1, 2, 2, projection="3d", computed_zorder=False), grids, crossing)
    figure.savefig(path, dpi=130)
    plt.close(figure)


def main() -> None:
    """Writes the picture beside the CSV, the first argument; the second is the controller's model description."""
    source, description = map(Path, sys.argv[1:3])
    table = np.genfromtxt(source, delimiter=",", names=True)
    draw(table, waypoints(description), source.with_suffix(".png"))


if __name__ == "__main__":
    main()
