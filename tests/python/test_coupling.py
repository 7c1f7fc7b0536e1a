"""Both FMUs together, through the singularity."""

import numpy as np
import pytest
from rps3_study.couple import Run, run_crossing
from rps3_study.fmu import Fmu, Value
from rps3_study.metrics import figures, joint_circle_radius
from rps3_study.tasks import tasks

RAC, DRAC, HDRAC, MPSO = 1, 2, 3, 4
RADIUS = joint_circle_radius(0.3616)
VARIANTS = pytest.mark.parametrize("revolute_motors", [True, False], ids=["six motors", "three motors"])


def cross(plant: Fmu, controller: Fmu, mode: int, revolute_motors: bool = True, **options: object) -> Run:
    """The default crossing."""
    parameters: dict[str, Value] = {"revolute_motors": revolute_motors, "control_mode": mode}
    return run_crossing(plant, controller, {"revolute_motors": revolute_motors}, parameters, **options)


@VARIANTS
@pytest.mark.parametrize("mode", [RAC, DRAC, HDRAC, MPSO])
def test_default_crossing_is_finished_in_every_mode(
    plant: Fmu, controller: Fmu, mode: int, revolute_motors: bool
) -> None:
    run = cross(plant, controller, mode, revolute_motors)
    assert run.failure is None
    assert run.time[-1] == pytest.approx(1.4)
    assert all(np.isfinite(values).all() for values in run.values.values())


def test_default_crossing_passes_a_direct_singularity(plant: Fmu, controller: Fmu) -> None:
    run = cross(plant, controller, DRAC)
    assert run["plant.sigma_min"].min() < 1e-3 * run["plant.sigma_min"][0]
    assert np.sign(run["plant.det_a"][0]) != np.sign(run["plant.det_a"][-1])


def test_undamped_acceleration_breaks_down_at_the_singularity_where_damped_does_not(
    plant: Fmu, controller: Fmu
) -> None:
    rac, drac = (figures(cross(plant, controller, mode), RADIUS) for mode in (RAC, DRAC))
    limit = float(plant.variables["v_max"].start)
    assert rac.peak_voltage == pytest.approx(limit) and rac.saturation_time > 0
    assert drac.peak_voltage < 0.5 * limit and drac.saturation_time == 0
    assert rac.peak_error > 2 * drac.peak_error


@VARIANTS
def test_tuned_damping_brings_the_robot_to_rest_at_the_end(plant: Fmu, controller: Fmu, revolute_motors: bool) -> None:
    run = cross(plant, controller, MPSO, revolute_motors)
    assert abs(run["plant.heave_dot"][-1]) < 1e-2
    assert run["plant.heave"][-1] == pytest.approx(float(controller.variables["end_heave"].start), abs=1e-3)


@VARIANTS
def test_tuned_damping_tracks_better_than_the_fixed_modes(plant: Fmu, controller: Fmu, revolute_motors: bool) -> None:
    errors = {
        mode: figures(cross(plant, controller, mode, revolute_motors), RADIUS).peak_error
        for mode in (RAC, DRAC, HDRAC, MPSO)
    }
    assert errors[MPSO] < 0.5 * min(errors[RAC], errors[DRAC], errors[HDRAC])


def test_coupled_run_does_not_depend_on_the_communication_step(plant: Fmu, controller: Fmu) -> None:
    at_sample_time = cross(plant, controller, DRAC, stop_time=0.3)
    finer = cross(plant, controller, DRAC, stop_time=0.3, step=1e-4)
    for name in ("plant.heave", "plant.tilt_x", "plant.tilt_y"):
        np.testing.assert_allclose(finer[name][::10], at_sample_time[name], atol=1e-6, err_msg=name)


def test_values_exchanged_at_equal_times_bring_the_voltages_one_step_late(plant: Fmu, controller: Fmu) -> None:
    run = cross(plant, controller, DRAC, stop_time=0.3, exchange="jacobi")
    direct = cross(plant, controller, DRAC, stop_time=0.3)
    assert run.failure is None
    assert not np.array_equal(run["plant.heave"], direct["plant.heave"])
    np.testing.assert_allclose(run["plant.heave"], direct["plant.heave"], atol=1e-3)


def test_push_at_the_singular_pose_is_felt_and_recovered_from(plant: Fmu, controller: Fmu) -> None:
    push = next(task for task in tasks(controller) if task.key == "push")
    run = cross(plant, controller, DRAC, disturbance=push.disturbance)
    calm = cross(plant, controller, DRAC)
    before = run.time < 0.45
    np.testing.assert_array_equal(run["plant.heave"][before], calm["plant.heave"][before])
    assert np.abs(run["plant.heave"] - calm["plant.heave"]).max() > 1e-5
    assert run["plant.heave"][-1] == pytest.approx(calm["plant.heave"][-1], abs=2e-3)


def test_acceleration_feedback_lessens_what_a_push_does(plant: Fmu, controller: Fmu) -> None:
    push = next(task for task in tasks(controller) if task.key == "push")

    def peak(feedback: float) -> float:
        parameters: dict[str, Value] = {"control_mode": DRAC, "k_a": feedback}
        return figures(run_crossing(plant, controller, {}, parameters, disturbance=push.disturbance), RADIUS).peak_error

    assert peak(0.5) < 0.95 * peak(0.0) < 0.95**2 * peak(-0.5)


@pytest.mark.parametrize("mode", [RAC, DRAC, HDRAC, MPSO])
def test_singular_region_is_where_the_smallest_singular_value_is_small_in_every_mode(
    plant: Fmu, controller: Fmu, mode: int
) -> None:
    run = cross(plant, controller, mode)
    inside = run["controller.in_singular_region"] != 0.0
    np.testing.assert_array_equal(
        inside, run["controller.sigma_min"] < float(controller.variables["delta_hd_fixed"].start)
    )
    assert inside.any() and not inside.all()


def test_failed_run_ends_early_and_says_why(plant: Fmu, controller: Fmu) -> None:
    run = run_crossing(plant, controller, {"plate_mass": 0.0}, {"control_mode": DRAC})
    assert run.time.size == 0
    assert run.failure is not None and "plate_mass" in run.failure
