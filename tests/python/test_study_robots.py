"""What a study runs: random robots, their homing, grids of parameters, and how runs are judged."""

import math

import numpy as np
import pandas as pd
import pytest
from rps3_study import homing, summary
from rps3_study.couple import Run, run_crossing
from rps3_study.fmu import Fmu, Instance, Value
from rps3_study.limits import Limits
from rps3_study.metrics import COORDINATES, pose_error
from rps3_study.montecarlo import DEVIATIONS, Robot
from rps3_study.study import FAILED, FINISHED, Study, execute
from rps3_study.sweep import SET_BY_STUDY, Axis, grid

NOMINAL = {"base_radius": 0.4172, "joint_spacing": 0.3616}


def test_robot_depends_on_seed_and_number_alone() -> None:
    first = Robot.draw(1, 7, 0.2, 1.0)
    assert first == Robot.draw(1, 7, 0.2, 1.0)
    assert first != Robot.draw(1, 8, 0.2, 1.0)
    assert first != Robot.draw(2, 7, 0.2, 1.0)


def test_deviations_fill_their_range_and_are_independent() -> None:
    robots = [Robot.draw(1, sample, 0.2, 1.0) for sample in range(2000)]
    table = pd.DataFrame([{**robot.deviations, "scale": robot.sensor_scale} for robot in robots])
    deviations = table[list(DEVIATIONS)]
    assert deviations.abs().max().max() <= 0.2
    assert (deviations.abs().max() > 0.19).all()
    # 2000 independent pairs: the correlation's deviation is 0.022
    assert np.abs(table.corr().to_numpy() - np.eye(table.shape[1])).max() < 0.1


def test_heavier_body_has_its_inertia_larger_in_proportion() -> None:
    robot = Robot.draw(1, 0, 0.2, 0.0)
    parameters = robot.plant_parameters(dict.fromkeys([name for names in DEVIATIONS.values() for name in names], 1.0))
    assert parameters["lower_inertia"] == parameters["lower_mass"] != 1.0


def test_longer_study_begins_with_the_runs_of_the_shorter() -> None:
    short, long = Study(samples=2), Study(samples=5)
    assert [short.labels(index) for index in range(short.size)] == [long.labels(index) for index in range(short.size)]


def test_every_mode_and_grid_point_meets_the_same_robots() -> None:
    study = Study(samples=3, modes=(1, 4), axes=(Axis("k_p", (1.0, 2.0)), Axis("k_d", (3.0,))))
    cases = [study.case(index) for index in range(study.size)]
    assert len(set(cases)) == study.size == 12
    for mode in study.modes:
        for point in grid(study.axes):
            assert [c.sample for c in cases if (c.mode, c.point) == (mode, point)] == [0, 1, 2]
    with pytest.raises(IndexError):
        study.case(12)


def test_study_survives_its_file() -> None:
    study = Study(samples=3, modes=(1, 4), axes=(Axis("k_p", (1.0, 2.0)),))
    assert Study.from_json(study.as_json()) == study


def test_axis_goes_to_the_fmus_that_have_the_parameter(plant: Fmu, controller: Fmu) -> None:
    assert Axis("v_max", (1.0,)).assignments(1.0, plant, controller) == ({"v_max": 1.0}, {"v_max": 1.0})
    assert Axis("k_p", (1.0,)).assignments(1.0, plant, controller) == ({}, {"k_p": 1.0})
    assert Axis("plant.v_max", (1.0,)).assignments(1.0, plant, controller) == ({"v_max": 1.0}, {})
    for wrong in ("plant.k_p", "robot.k_p", "heave"):
        with pytest.raises(ValueError, match="there is no parameter"):
            Axis(wrong, (1.0,)).check(plant, controller)


def test_every_parameter_that_can_be_varied_reaches_its_fmu(
    plant: Fmu, controller: Fmu, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Passed(Exception):
        """The parameters that the run would have had."""

    def run(_plant: Fmu, _controller: Fmu, *parameters: dict[str, Value], **_: object) -> Run:
        raise Passed(*parameters)

    monkeypatch.setattr("rps3_study.study.run_crossing", run)
    refused = set()
    for side, fmu in (("plant", plant), ("controller", controller)):
        for name in fmu.names("parameter"):
            variable = fmu.variables[name]
            if variable.type == "Boolean":
                value = float(variable.start != "true")
            else:
                value = float(variable.start) + (1.0 if variable.type == "Integer" else 1e-6)
            axis = Axis(f"{side}.{name}", (value,))
            try:
                axis.check(plant, controller)
            except ValueError:
                refused.add(name)
                continue
            study = Study(samples=1, modes=(2,), spread=0.0, sensors=0.0, axes=(axis,))
            with pytest.raises(Passed) as caught:
                execute(plant, controller, study, 0)
            actual, believed = caught.value.args
            assert (actual if side == "plant" else believed)[name] == pytest.approx(value, rel=1e-9), axis.name
    assert refused == set(SET_BY_STUDY)


def test_axis_reads_lists_and_even_spacing() -> None:
    assert Axis.parse("k_p=400,900") == Axis("k_p", (400.0, 900.0))
    assert Axis.parse("k_p=0:1:5") == Axis("k_p", (0.0, 0.25, 0.5, 0.75, 1.0))
    for wrong in ("k_p", "k_p=", "k_p=a", "=1", "k_p=1:2"):
        with pytest.raises(ValueError):
            Axis.parse(wrong)


def test_zeroed_encoders_tell_the_controller_that_it_is_at_the_start(plant: Fmu, controller: Fmu) -> None:
    start = np.array([float(controller.variables[f"start_{name}"].start) for name in COORDINATES])
    believed = homing.limb_positions(plant, NOMINAL, [start])
    own = homing.limb_positions(plant, {"base_radius": 0.43, "joint_spacing": 0.36}, [start])
    offsets = homing.encoder_offsets(believed, own)
    measured = {f"d{limb + 1}": own[0, 0, limb] for limb in range(3)}
    measured |= {f"theta{limb + 1}": own[0, 1, limb] for limb in range(3)}
    with Instance(controller) as instance:
        instance.initialize({"control_mode": 2, **{name: value + offsets[name] for name, value in measured.items()}})
        estimate = list(instance.get([f"{name}_est" for name in COORDINATES]).values())
        np.testing.assert_allclose(estimate, start, atol=1e-9)
    # not zeroed, limbs of other lengths fit a pose that is far away
    with Instance(controller) as instance:
        instance.initialize({"control_mode": 2, **measured})
        assert abs(instance["heave_est"] - start[0]) > 0.01


def test_nominal_robot_keeps_its_stops_and_encoders(plant: Fmu) -> None:
    poses = [np.array([0.05, 0.0, 0.0]), np.array([0.03, 0.1, 0.1])]
    nominal = Limits(np.array([0.1143, -0.11]), np.array([0.3143, 0.58]))
    own = homing.limb_positions(plant, NOMINAL, poses)
    limits = homing.own_limits(nominal, own, own)
    np.testing.assert_allclose(limits.low, nominal.low, rtol=1e-14)
    np.testing.assert_allclose(limits.high, nominal.high, rtol=1e-14)
    assert set(homing.encoder_offsets(own, own).values()) == {0.0}


def test_home_pose_has_the_limbs_of_the_frame(plant: Fmu) -> None:
    horizontal = 0.4172 - 0.3616 / math.sqrt(3)
    ((lengths, angles),) = homing.limb_positions(plant, NOMINAL, [np.array([0.05, 0.0, 0.0])])
    np.testing.assert_allclose(lengths, math.hypot(horizontal, 0.05), rtol=1e-12)
    np.testing.assert_allclose(angles, math.atan2(0.05, horizontal), rtol=1e-12)


def test_extreme_geometry_can_be_initialized(plant: Fmu, controller: Fmu) -> None:
    axes = tuple(Axis(f"plant.{name}", (0.8 * value, 1.2 * value)) for name, value in NOMINAL.items())
    study = Study(samples=1, modes=(2,), spread=0.0, sensors=0.0, axes=axes)
    for index in range(study.size):
        record = execute(plant, controller, study, index)
        assert record["status"] == FINISHED, record["reason"]


def test_nominal_run_of_a_study_is_the_plain_crossing(plant: Fmu, controller: Fmu) -> None:
    record = execute(plant, controller, Study(samples=1, spread=0.0, sensors=0.0, modes=(2,)), 0)
    plain = run_crossing(plant, controller, {}, {"control_mode": 2, "seed": record["seed"]})
    peak = pose_error(plain, 0.3616 / math.sqrt(3)).max()
    assert record["peak_error"] == peak
    assert record["end_stop"] is None


def test_offset_shifts_what_the_controller_measures(plant: Fmu, controller: Fmu) -> None:
    """All limbs longer by 1 mm: the controller believes to be higher and lowers the platform."""
    longer = {f"d{limb}": 1e-3 for limb in (1, 2, 3)}
    run = run_crossing(plant, controller, {}, {"control_mode": 2}, stop_time=0.02, offsets=longer)
    assert run["controller.heave_est"][0] > run["plant.heave"][0] + 1e-3


def test_run_that_an_fmu_refuses_is_a_failed_record(plant: Fmu, controller: Fmu) -> None:
    study = Study(samples=1, modes=(2,), axes=(Axis("controller.k_p", (-1.0,)),))
    record = execute(plant, controller, study, 0)
    assert record["status"] == FAILED
    assert "k_p" in record["reason"]
    assert record["seed"] == study.robot(0).seed


def test_end_stop_that_a_limb_reaches_is_named(plant: Fmu, controller: Fmu) -> None:
    run = run_crossing(plant, controller, {}, {"control_mode": 2}, stop_time=0.02)
    tight = Limits(np.array([0.0, -3.0]), np.array([run["plant.d2"][0] - 1e-6, 3.0]))
    assert Limits.of(tight.parameters()).high[0] == tight.high[0]
    assert tight.first_contact(run) == "d_max by limb 2 at 0.000 s"


def test_success_is_a_finished_run_off_the_stops_within_the_bound() -> None:
    table = pd.DataFrame(
        [
            {"status": "finished", "end_stop": None, "peak_error": 9.0},
            {"status": "finished", "end_stop": None, "peak_error": 11.0},
            {"status": "finished", "end_stop": "d_max by limb 1 at 0.100 s", "peak_error": 9.0},
            {"status": "failed", "end_stop": None, "peak_error": 1.0},
            {"status": "crashed", "end_stop": None, "peak_error": None},
            {"status": "finished", "end_stop": None, "peak_error": math.nan},
        ]
    )
    assert list(summary.outcomes(table, 10.0)) == ["success", "error", "end stop", "failed", "crashed", "error"]


def test_interval_of_a_rate_has_its_textbook_values() -> None:
    # Wilson 1927: 0 of 10 and 81 of 263 (Newcombe 1998, Table I)
    assert summary.wilson(81, 263) == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert summary.wilson(0, 20) == pytest.approx((0.0, 0.1611), abs=5e-5)
