"""Draws what a crossing demands of the motors from the CSV of examples/torque.rs."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

QUANTITIES = {"torque_Nm": "rotor torque (N.m)", "current_A": "current (A)", "voltage_V": "voltage (V)"}
# three motors ask for infinite currents at the singularity: the pictures end here
RANGES = {"torque_Nm": 0.5, "current_A": 2.5, "voltage_V": 48.0}


def draw(table: np.ndarray, path: Path) -> None:
    """One column for six motors, one for three."""
    figure, axes = plt.subplots(len(QUANTITIES), 2, figsize=(11, 9), sharex=True, sharey="row", layout="constrained")
    for column, motors in enumerate((6, 3)):
        rows = table[table["motors"] == motors]
        axes[0, column].set_title(f"{motors} motors")
        for axis, (quantity, label) in zip(axes[:, column], QUANTITIES.items(), strict=True):
            for i in range(1, 4):
                axis.plot(rows["time_s"], rows[f"leg{i}_{quantity}"], f"C{i - 1}", label=f"leg {i}")
                if motors == 6:
                    axis.plot(rows["time_s"], rows[f"rev{i}_{quantity}"], f"C{i - 1}--", label=f"revolute {i}")
            axis.set(ylabel=label, ylim=(-RANGES[quantity], RANGES[quantity]))
            axis.grid(alpha=0.3)
        axes[0, column].legend(ncols=2, fontsize="small")
        axes[-1, column].set_xlabel("time (s)")
    figure.savefig(path, dpi=130)
    plt.close(figure)


def main() -> None:
    """Writes the picture beside the CSV named on the command line."""
    source = Path(sys.argv[1])
    draw(np.genfromtxt(source, delimiter=",", names=True), source.with_suffix(".png"))


if __name__ == "__main__":
    main()
