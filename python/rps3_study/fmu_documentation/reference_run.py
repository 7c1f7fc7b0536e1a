"""Plots of the default experiment with default parameters, both FMUs coupled."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from rps3_study import plots
from rps3_study.couple import Run
from rps3_study.fmu import Fmu
from rps3_study.geometry import Geometry
from rps3_study.metrics import COORDINATES, pose_error
from rps3_study.plots import Panel


def _figures(identifier: str, geometry: Geometry) -> dict[str, list[Panel]]:
    """The figures of an FMU by their captions."""
    shared = plots.figures(geometry.joint_radius)
    if identifier == "Rps3Plant":
        return {
            "Generalized coordinates and the pose error": shared["coordinates"],
            "Axial forces of the limbs on the platform, and the largest voltage": shared["forces"],
            "Limb lengths": [Panel(f"d{limb}, cm", _output(f"plant.d{limb}", 100.0)) for limb in (1, 2, 3)],
        }
    return {
        "Pose error, true and estimated": [
            Panel("pose error, mm", lambda run: pose_error(run, geometry.joint_radius), scale="log"),
            Panel("estimation error, mm", lambda run: _estimation_error(run, geometry.joint_radius)),
        ],
        "Singularity measure and damping factors": shared["damping"],
        "Swarm": shared["swarm"],
    }


def _svg(panels: list[Panel], run: Run, caption: str) -> str:
    """One figure as SVG."""
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / "plot.svg"
        plots.draw(path, caption, {"HDRAC+MPSO": run}, panels)
        return path.read_text(encoding="utf-8")


def drawn(fmu: Fmu, run: Run, geometry: Geometry) -> dict[str, str]:
    """The figures of an FMU as SVG, by their captions."""
    figures = _figures(fmu.description.modelName, geometry)
    return {caption: _svg(panels, run, caption) for caption, panels in figures.items()}


def _output(name: str, factor: float) -> Callable[[Run], np.ndarray]:
    return lambda run: factor * run[name]


def _estimation_error(run: Run, radius: float) -> np.ndarray:
    """Largest error of the estimated pose, tilts at `radius` (m), in mm."""
    scales = (1.0, radius, radius)
    errors = [
        scale * np.abs(run[f"plant.{name}"] - run[f"controller.{name}_est"])
        for name, scale in zip(COORDINATES, scales, strict=True)
    ]
    return 1e3 * np.max(errors, axis=0)
