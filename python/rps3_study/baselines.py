"""What one would otherwise pick, beside the controller's modes.

These schemes are no part of the FMUs: `examples/baselines.rs` runs them coupled in process. This module hands it the
tasks and reads its figures:

    python -m rps3_study.baselines | cargo run --release --example baselines
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from rps3_study.fmu import Fmu, extracted
from rps3_study.metrics import COORDINATES, Figures
from rps3_study.tasks import VARIANTS, Task, tasks

REPEATED = "DRAC 0.05"
"""The scheme of the FMU that is among them, for comparison."""


def described(controller: Fmu, task: Task) -> dict[str, Any]:
    """A task as the example reads it."""
    values = {name: variable.start for name, variable in controller.variables.items()} | dict(task.parameters)
    push = task.disturbance
    return {
        "key": task.key,
        "profile": int(values["profile"]),
        "waypoints": [[float(values[f"{point}_{name}"]) for name in COORDINATES] for point in ("start", "via", "end")],
        "push": None
        if push is None
        else {"span": [push.start, push.end], "force": [0.0, 0.0, push.force], "moment": [push.moment, 0.0, 0.0]},
    }


def comparable(task: Task) -> bool:
    """The baselines see exact sensors only."""
    return not any(name.startswith("sensor_") for name in task.parameters)


def read(path: Path) -> dict[tuple[str, str], dict[str, Figures]]:
    """The example's figures, by scheme, for each task's key and variant; `REPEATED` is among them."""
    variants = {revolute_motors: variant for variant, revolute_motors in VARIANTS.items()}
    figures: dict[tuple[str, str], dict[str, Figures]] = {}
    for row in json.loads(path.read_text(encoding="utf-8")):
        case = row.pop("task"), variants[row.pop("revolute_motors")]
        scheme = row.pop("scheme")
        figures.setdefault(case, {})[scheme] = Figures(**row)
    return figures


def only(figures: dict[tuple[str, str], dict[str, Figures]]) -> dict[tuple[str, str], dict[str, Figures]]:
    """Without the scheme that the FMUs have run as well."""
    return {case: {name: row for name, row in schemes.items() if name != REPEATED} for case, schemes in figures.items()}


def main() -> None:
    """Prints the tasks as JSON."""
    parser = argparse.ArgumentParser(prog="rps3_study.baselines", description=__doc__.splitlines()[0])
    parser.add_argument("--dist", type=Path, default=Path("dist"), help="directory that holds the FMUs")
    options = parser.parse_args()
    with extracted(options.dist / "Rps3Controller.fmu") as (controller,):
        print(json.dumps([described(controller, task) for task in tasks(controller) if comparable(task)], indent=2))


if __name__ == "__main__":
    main()
