"""Co-Simulation of each FMU alone."""

import numpy as np
import pytest
from fmpy import simulate_fmu
from rps3_study.fmu import Fmu, Instance, Value

TOLERANCE = 1e-6
VOLTAGES = {"v_leg1": 3.0, "v_leg2": -2.0, "v_leg3": 1.0, "v_rev1": 4.0, "v_rev2": -5.0, "v_rev3": 2.0}


def final_outputs(plant: Fmu, step: float, stop: float) -> dict[str, float]:
    """Outputs of the plant at `stop` (s) under constant voltages, reached in steps of `step` (s)."""
    with Instance(plant) as instance:
        instance.initialize(tolerance=TOLERANCE)
        instance.set(VOLTAGES)
        for k in range(round(stop / step)):
            instance.step(k * step, step)
        return instance.get(plant.names("output"))


@pytest.mark.master("FMPy", "CS")
def test_fmpy_runs_the_default_experiment(fmu: Fmu, settings: dict[str, Value]) -> None:
    result = simulate_fmu(str(fmu.archive), fmi_type="CoSimulation", start_values=settings)
    assert result["time"][-1] == pytest.approx(float(fmu.description.defaultExperiment.stopTime))
    assert all(np.isfinite(result[name]).all() for name in result.dtype.names)


@pytest.mark.parametrize("step", [1e-4, 1e-2])
def test_results_do_not_depend_on_the_communication_step(plant: Fmu, step: float) -> None:
    stop = 0.1
    reference, other = final_outputs(plant, 1e-3, stop), final_outputs(plant, step, stop)
    for name, value in reference.items():
        nominal = float(plant.variables[name].nominal or 1.0)
        assert other[name] == pytest.approx(value, abs=10 * TOLERANCE * max(nominal, abs(value))), name


def test_undisturbed_plant_under_holding_voltage_stays_where_it_starts(plant: Fmu) -> None:
    with Instance(plant) as instance:
        instance.initialize(tolerance=TOLERANCE)
        start = instance.get(plant.names("output"))
        resistance = instance["motor_ra"]
        motors = [f"{kind}{limb}" for kind in ("leg", "rev") for limb in (1, 2, 3)]
        instance.set({f"v_{motor}": resistance * start[f"i_{motor}"] for motor in motors})
        for k in range(100):
            instance.step(k * 1e-3, 1e-3)
        assert instance["heave"] == pytest.approx(start["heave"], abs=1e-6)
        assert instance["tilt_x"] == pytest.approx(start["tilt_x"], abs=1e-6)
        assert instance["tilt_y"] == pytest.approx(start["tilt_y"], abs=1e-6)


def test_voltage_beyond_the_limit_acts_like_the_limit(plant: Fmu) -> None:
    def current(voltage: float) -> float:
        with Instance(plant) as instance:
            instance.initialize(tolerance=TOLERANCE)
            instance.set({"v_leg1": voltage})
            instance.step(0.0, 1e-3)
            return float(instance["i_leg1"])

    limit = float(plant.variables["v_max"].start)
    assert current(2 * limit) == current(limit)
    assert current(0.5 * limit) < current(limit)


def test_velocities_are_the_slopes_of_positions(plant: Fmu) -> None:
    step, names = (
        1e-4,
        ("p_x", "p_y", "p_z", "d1", "d2", "d3", "theta1", "theta2", "theta3", "heave", "tilt_x", "tilt_y"),
    )
    with Instance(plant) as instance:
        instance.initialize(tolerance=1e-10)
        instance.set(VOLTAGES)
        rows = []
        for k in range(60):
            instance.step(k * step, step)
            rows.append(instance.get(plant.names("output")))
    for name in names:
        rate = f"v_{name[2]}" if name.startswith("p_") else f"{name}_dot"
        # central differences: error step^2/6 times the third derivative, some 1e4 m/s3 at most here
        slope = (rows[-1][name] - rows[-3][name]) / (2 * step)
        assert rows[-2][rate] == pytest.approx(slope, abs=3e-5), name


def test_controller_samples_on_its_own_clock_whatever_the_communication_step(controller: Fmu) -> None:
    def reference_at(step: float, stop: float) -> float:
        with Instance(controller) as instance:
            instance.initialize({"control_mode": 2, "sample_time": 1e-3})
            for k in range(round(stop / step)):
                instance.step(k * step, step)
            return float(instance["heave_ref"])

    # The last tick before 0.3 s is the one at 0.299 s in each case.
    assert reference_at(1e-4, 0.3) == reference_at(1e-3, 0.3) == reference_at(1e-1, 0.3)
    assert reference_at(1e-4, 0.2995) == reference_at(1e-3, 0.3)


def test_controller_holds_its_voltages_between_samples(controller: Fmu) -> None:
    with Instance(controller) as instance:
        instance.initialize({"control_mode": 2, "sample_time": 1e-3})
        instance.step(0.0, 1e-3)
        instance.step(1e-3, 2.5e-4)
        held = instance.get(controller.names("output"))
        instance.set({"d1": 0.3})
        instance.step(1.25e-3, 2.5e-4)
        assert instance.get(controller.names("output")) == held


def test_controller_reads_an_input_at_its_sample_within_the_step(controller: Fmu) -> None:
    """Input derivatives hold for one step (section 4.2.1): those of a step without a sample are gone after it."""
    length, rate, step = controller.variables["d1"], 0.5, 4e-4

    def voltages(derivative_in: int | None = None, offset: float = 0.0) -> dict[str, Value]:
        """After the sample at 1 ms, which is half way through step 2; `offset` (m) is what d1 then has more."""
        with Instance(controller) as instance:
            instance.initialize({"control_mode": 2, "sample_time": 1e-3})
            start = float(instance["d1"])
            for k in range(3):
                if k == derivative_in:
                    instance.slave.setRealInputDerivatives([length.valueReference], [1], [rate])
                if k == 2:
                    instance.set({"d1": start + offset})
                instance.step(k * step, step)
            return instance.get([f"v_{motor}{limb}" for motor in ("leg", "rev") for limb in (1, 2, 3)])

    constant = voltages()
    assert voltages(derivative_in=1) == constant
    ramped, reached = voltages(derivative_in=2), voltages(offset=rate * step / 2)
    assert ramped == pytest.approx(reached, rel=1e-12)
    assert abs(ramped["v_leg1"] - constant["v_leg1"]) > 1e-3
