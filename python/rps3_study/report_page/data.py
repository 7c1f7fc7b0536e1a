"""What the page's scripts draw: every second sample of every run, as numbers in single precision."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rps3_study import plots
from rps3_study.couple import Run
from rps3_study.geometry import Geometry, degenerate_twists
from rps3_study.metrics import pose_error
from rps3_study.singularity import SINGULAR_REGION

if TYPE_CHECKING:
    from rps3_study.report import Case

STRIDE = 2
"""Of so many samples one is drawn; tables and CSV files take all."""
FORCES = tuple(f"plant.f_axial{limb}" for limb in (1, 2, 3))


def payload(cases: Sequence[Case], geometry: Geometry) -> dict[str, Any]:
    """Everything the scripts need, ready for JSON."""
    modes = list(dict.fromkeys(mode for case in cases for mode in case.runs))
    return {
        "geometry": {"baseRadius": geometry.base_radius, "jointRadius": geometry.joint_radius},
        "singularRegion": SINGULAR_REGION,
        "modes": modes,
        "styles": {mode: plots.STYLES[mode]._asdict() for mode in modes} | {"reference": plots.REFERENCE._asdict()},
        "groups": [
            {
                "title": title,
                "panels": [{"label": p.label, "scale": p.scale, "reference": p.reference is not None} for p in panels],
            }
            for title, panels in plots.figures(geometry.joint_radius).items()
            if any(_anything(panel, run) for panel in panels for case in cases for run in case.runs.values())
        ],
        "cases": [_case(case, geometry) for case in cases],
    }


def _anything(panel: plots.Panel, run: Run) -> bool:
    """There is something to see: modes without a swarm show none."""
    return bool(np.isfinite(panel.quantity(run)).any())


def _case(case: Case, geometry: Geometry) -> dict[str, Any]:
    panels = plots.figures(geometry.joint_radius)
    longest = max(case.runs.values(), key=lambda run: run.time.size)
    return {
        "task": case.task.title,
        "variant": case.variant,
        "time": _pack(longest.time),
        "forceScale": _force_scale(case),
        "references": {
            f"{title}/{i}": _pack(panel.reference(longest))
            for title, group in panels.items()
            for i, panel in enumerate(group)
            if panel.reference is not None
        },
        "windows": {
            f"{title}/{i}": plots.window(panel, case.runs)
            for title, group in panels.items()
            for i, panel in enumerate(group)
            if panel.reference is not None
        },
        "runs": {mode: _run(run, geometry) for mode, run in case.runs.items()},
    }


def _run(run: Run, geometry: Geometry) -> dict[str, Any]:
    """One run: `pose` (p, q as x, y, z, w) and `twist` (v, r_b omega) hold several numbers a sample."""
    columns = [run[f"plant.{name}"] for name in ("p_x", "p_y", "p_z", "q_x", "q_y", "q_z", "q_w")]
    twists, _ = degenerate_twists(run, geometry)
    return {
        "failure": run.failure,
        "pose": _pack(np.column_stack(columns)),
        "twist": _pack(twists),
        "forces": _pack(np.column_stack([run[name] for name in FORCES])),
        "error": _pack(pose_error(run, geometry.joint_radius)),
        "sigma": _pack(run["plant.sigma_min"]),
        "panels": {
            f"{title}/{i}": _pack(panel.quantity(run))
            for title, group in plots.figures(geometry.joint_radius).items()
            for i, panel in enumerate(group)
        },
    }


def _force_scale(case: Case) -> float:
    """Axial force at the ends of the colour scale, N: exceeded in one sample of fifty, on two digits."""
    sizes = np.abs(np.concatenate([run[name] for run in case.runs.values() for name in FORCES]))
    return float(f"{np.quantile(sizes, 0.98):.1e}") if sizes.size else 1.0


def _pack(values: np.ndarray) -> str:
    """Little-endian single precision in base64."""
    return base64.b64encode(np.ascontiguousarray(values[::STRIDE], dtype="<f4").tobytes()).decode("ascii")
