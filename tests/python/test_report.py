"""Figures of merit and the report, on runs whose figures are known."""

from pathlib import Path

import numpy as np
import pytest
from rps3_study import report
from rps3_study.couple import Run
from rps3_study.geometry import Geometry
from rps3_study.metrics import COORDINATES, VOLTAGES, Figures, figures
from rps3_study.results import Results
from rps3_study.singularity import passage
from rps3_study.tasks import Push, Task

RADIUS = 0.2
POSE = (*(f"p_{axis}" for axis in "xyz"), *(f"q_{part}" for part in "wxyz"))
FORCES = tuple(f"f_axial{limb}" for limb in (1, 2, 3))
LIMBS = tuple(f"{quantity}{limb}" for quantity in ("d", "theta") for limb in (1, 2, 3))
MOTION = tuple(f"{quantity}_{axis}" for quantity in "vw" for axis in "xyz")
DAMPING = ("rho", "rho_hd", "delta_hd", "lambda_f", "mpso_fitness", "mpso_iterations")
SIGNALS = [f"plant.{n}" for n in (*COORDINATES, *POSE, *FORCES, *LIMBS, *MOTION, "sigma_min")] + [
    f"controller.{n}" for n in (*VOLTAGES, *(f"{c}_ref" for c in COORDINATES), *DAMPING)
]


def made_up_run(failure: str | None = None, length: int = 5) -> Run:
    """Half the time 1 mm too high, half the time 10 mrad too tilted (2 mm at the radius), 12 V and 1 ms saturated."""
    values = {name: np.zeros(5) for name in SIGNALS}
    values["time"] = 1e-3 * np.arange(5)
    values["plant.q_w"] = np.ones(5)
    values["plant.heave"] = np.array([1e-3, 1e-3, 0.0, 0.0, 0.0])
    values["controller.tilt_y_ref"] = np.array([0.0, 0.0, 1e-2, 1e-2, 0.0])
    values["controller.v_rev2"] = np.array([0.0, -12.0, 3.0, 0.0, 0.0])
    values["controller.saturated"] = np.array([0.0, 1.0, 0.0, 0.0, 0.0])
    return Run({name: value[:length] for name, value in values.items()}, failure)


def test_pose_error_takes_the_largest_component_and_tilts_at_the_radius() -> None:
    result = figures(made_up_run(), RADIUS)
    assert result.peak_error == pytest.approx(2.0)
    assert result.rms_error == pytest.approx(np.sqrt((1 + 1 + 4 + 4 + 0) / 5))


def test_voltage_counts_by_size_and_saturation_by_time() -> None:
    result = figures(made_up_run(), RADIUS)
    assert result.peak_voltage == 12.0
    assert result.saturation_time == pytest.approx(1e-3)


def test_push_acts_from_its_start_until_its_end() -> None:
    push = Push(force=-100.0, moment=5.0, start=0.48, end=0.52)
    assert push(0.48) == push(0.519) == {"f_ext_z": -100.0, "m_ext_x": 5.0}
    assert push(0.479) == push(0.52) == {"f_ext_z": 0.0, "m_ext_x": 0.0}


def test_report_holds_table_plots_and_data_and_is_the_same_when_written_again(tmp_path: Path) -> None:
    runs = {"DRAC": made_up_run(), "HDRAC+MPSO": made_up_run("no | such mode", length=0)}
    cases = [report.Case(Task("smooth", "Crossing", {}), "six motors", runs)]
    geometry, case = Geometry(0.4, RADIUS), ("smooth", "six motors")
    results = Results(
        figures={case: {mode: figures(run, RADIUS) for mode, run in runs.items()}},
        passages={case: {mode: passage(run, geometry) for mode, run in runs.items()}},
        baselines={case: {"another": Figures(3.0, 1.0, 24.0, 0.0, end_stop=True)}},
    )
    searches = tmp_path / "convergence.csv"
    searches.write_text(
        "motors,iteration,searching,within_1_percent,median_ratio,ninety_ratio,ninety_nine_ratio\n"
        "6,0,1,0.5,1.1,1.2,3\n6,1,0.5,1,1,1,1\n3,0,1,0.5,1.1,1.2,3\n3,1,0.5,1,1,1,1\n"
    )
    first, second = (
        report.write(tmp_path / name, cases, geometry, results, searches).parent for name in ("first", "second")
    )
    files = sorted(str(path.relative_to(first).as_posix()) for path in first.rglob("*.*"))
    expected = ["data/smooth-six-motors-drac.csv", "plots/smooth-six-motors-damping.svg", "plots/convergence.svg"]
    assert {"index.html", "report.md", *expected} <= set(files)
    for name in files:
        assert (first / name).read_bytes() == (second / name).read_bytes(), name
    text = (first / "report.md").read_text()
    assert "| DRAC | 2 | 1.41 | 12 | 1 | 0.93 |  |" in text
    assert "ended early: no \\| such mode" in text
    assert "![convergence](plots/convergence.svg)" in text
    assert "data:image/svg+xml;base64," in (first / "index.html").read_text()
    assert "| another | 3 | 1 | 24 | 0 |  | reaches an end stop |" in text
    assert Results.read(first / "results.json").baselines == results.baselines
    data = np.genfromtxt(first / "data" / "smooth-six-motors-drac.csv", delimiter=",", names=True, deletechars="")
    assert data["plant.heave"][0] == 1e-3
