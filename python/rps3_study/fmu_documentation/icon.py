"""The FMUs' icon: the mechanism at the start of the reference run."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle, Polygon

from rps3_study.couple import Run
from rps3_study.geometry import Geometry, rotations

PIXELS = 256
ELEVATION = np.radians(38.0)
AZIMUTH = np.radians(-60.0)
"""Direction from which the mechanism is seen."""


def draw(path: Path, run: Run, geometry: Geometry, *, closed_loop: bool) -> None:
    """Writes the icon as PNG; `closed_loop` adds the arrow of feedback."""
    feet = geometry.base_radius * geometry.radial
    position = np.array([run[f"plant.p_{axis}"][0] for axis in "xyz"])
    joints = position + geometry.joint_radius * geometry.radial @ rotations(run)[0].T
    circle = np.linspace(0.0, 2.0 * np.pi, 73)
    base = geometry.base_radius * np.column_stack([np.cos(circle), np.sin(circle), np.zeros_like(circle)])
    figure = Figure(figsize=(1.0, 1.0), dpi=PIXELS)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(-0.5, 0.5), ylim=(-0.5, 0.5), aspect="equal")
    axes.axis("off")
    axes.add_patch(Polygon(_seen(base), facecolor="#e3e7ec", edgecolor="#8a95a1", linewidth=0.8))
    for foot, joint in zip(_seen(feet), _seen(joints), strict=True):
        axes.plot(*zip(foot, joint, strict=True), color="#b2182b", linewidth=3.2, solid_capstyle="round")
        axes.add_patch(Circle(foot, 0.028, color="#2f3a45"))
    axes.add_patch(Polygon(_seen(joints), facecolor="#5d7389", edgecolor="#2f3a45", linewidth=1.0, zorder=3))
    for joint in _seen(joints):
        axes.add_patch(Circle(joint, 0.02, color="#2f3a45", zorder=4))
    if closed_loop:
        axes.add_patch(Arc((0.0, 0.0), 0.9, 0.9, theta1=35.0, theta2=145.0, color="#0072b2", linewidth=3.2))
        tip = 0.45 * np.array([np.cos(np.radians(35.0)), np.sin(np.radians(35.0))])
        head = tip + 0.07 * np.array([[0.75, -0.95], [0.75, 0.85], [-0.85, 0.35]])
        axes.add_patch(Polygon(head, color="#0072b2"))
    # no note of the program: equal runs give equal files
    figure.savefig(path, transparent=True, metadata={"Software": None})


def _seen(points: np.ndarray) -> np.ndarray:
    """Points (m, base frame) in the plane of the picture: parallel projection."""
    right = np.array([-np.sin(AZIMUTH), np.cos(AZIMUTH), 0.0])
    up = np.array([-np.cos(AZIMUTH) * np.sin(ELEVATION), -np.sin(AZIMUTH) * np.sin(ELEVATION), np.cos(ELEVATION)])
    return points @ np.column_stack([right, up])
