"""Draws the surface of direct singularities from the CSV of examples/atlas.rs."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

SECTIONS = (0.0, 9.0, 21.0, 30.0)


def draw(table: np.ndarray, path: Path) -> None:
    """Sections at constant direction, and the part of the surface within the joint limits in space."""
    inside = table["within_limits"] == 1
    figure = plt.figure(figsize=(13, 5.5), layout="constrained")
    left = figure.add_subplot(1, 2, 1)
    for k, direction in enumerate(SECTIONS):
        here = table["direction_deg"] == direction
        style = {"linestyle": "none", "marker": ".", "color": f"C{k}"}
        left.plot(table["tilt_deg"][here & ~inside], 100 * table["heave_m"][here & ~inside], **style, alpha=0.25, ms=3)
        left.plot(
            table["tilt_deg"][here & inside], 100 * table["heave_m"][here & inside], **style, label=f"{direction:g} deg"
        )
    left.set(xlabel="tilt (deg)", ylabel="singular heave (cm)", ylim=(-20, 20), title="Sections at constant direction")
    left.legend(title="direction (pale: beyond a joint limit)")
    left.grid(alpha=0.3)
    right = figure.add_subplot(1, 2, 2, projection="3d")
    shown = table[inside]
    direction = np.deg2rad(shown["direction_deg"])
    right.scatter(
        shown["tilt_deg"] * np.cos(direction),
        shown["tilt_deg"] * np.sin(direction),
        100 * shown["heave_m"],
        c=shown["heave_m"],
        s=3,
    )
    right.set(xlabel="tilt_x (deg)", ylabel="tilt_y (deg)", zlabel="heave (cm)", title="Within the joint limits")
    figure.savefig(path, dpi=130)
    plt.close(figure)


def main() -> None:
    """Writes the picture beside the CSV named on the command line."""
    source = Path(sys.argv[1])
    draw(np.genfromtxt(source, delimiter=",", names=True), source.with_suffix(".png"))


if __name__ == "__main__":
    main()
