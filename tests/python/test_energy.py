"""Energy is conserved, and what comes in is what is stored, burnt or done as work."""

import numpy as np
from rps3_study.fmu import Fmu, Instance

LOADS = {"f_ext_x": 3.0, "f_ext_y": -2.0, "f_ext_z": 8.0, "m_ext_x": 0.4, "m_ext_y": -0.3, "m_ext_z": 0.2}
VOLTAGES = {"v_leg1": 6.0, "v_leg2": -4.0, "v_leg3": 3.0, "v_rev1": 5.0, "v_rev2": -6.0, "v_rev3": 4.0}


def test_plant_without_motors_and_friction_conserves_energy_over_one_second(plant: Fmu) -> None:
    free = {"motor_kt": 1e-9, "motor_bm": 0.0, "stop_damping": 0.0, "settled_start": False}
    with Instance(plant) as instance:
        instance.initialize(free, tolerance=1e-9)
        start, lowest, drift = instance.get(["energy", "heave"]), np.inf, 0.0
        for k in range(100):
            instance.step(k * 0.01, 0.01)
            now = instance.get(["energy", "heave"])
            lowest = min(lowest, now["heave"])
            drift = max(drift, abs(now["energy"] - start["energy"]))
        exchanged = instance["plate_mass"] * instance["gravity"] * (start["heave"] - lowest)
    assert exchanged > 1.0, "the platform must have fallen for this to say anything"
    assert drift < 1e-6 * exchanged


def test_power_at_terminals_and_loads_goes_into_energy_heat_and_friction(plant: Fmu) -> None:
    step, count = 5e-5, 1000
    with Instance(plant) as instance:
        instance.initialize(tolerance=1e-9)
        parameters = instance.get(["motor_ra", "motor_bm", "screw_lead", "gear_ratio"])
        instance.set({**VOLTAGES, **LOADS})
        rows = [instance.get(plant.names("output"))]
        for k in range(count):
            instance.step(k * step, step)
            rows.append(instance.get(plant.names("output")))
    outputs = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    speeds = {
        "leg": (2 * np.pi / parameters["screw_lead"], "d{}_dot"),
        "rev": (parameters["gear_ratio"], "theta{}_dot"),
    }
    heat, friction, electric = 0.0, 0.0, 0.0
    for kind, (ratio, rate) in speeds.items():
        for limb in (1, 2, 3):
            current = outputs[f"i_{kind}{limb}"]
            heat = heat + parameters["motor_ra"] * current**2
            friction = friction + parameters["motor_bm"] * (ratio * outputs[rate.format(limb)]) ** 2
            electric = electric + VOLTAGES[f"v_{kind}{limb}"] * current
    work = sum(
        LOADS[f"f_ext_{axis}"] * outputs[f"v_{axis}"] + LOADS[f"m_ext_{axis}"] * outputs[f"w_{axis}"] for axis in "xyz"
    )
    np.testing.assert_allclose(outputs["power_electric"], electric, rtol=1e-12, atol=1e-9)
    net = simpson(electric + work - heat - friction, step)
    gained = outputs["energy"][-1] - outputs["energy"][0]
    # Simpson's rule on the currents' time constant of 0.5 ms is good to about (step/0.5 ms)^4/180
    assert abs(net - gained) < 1e-6 * simpson(np.abs(electric) + np.abs(work), step)
    assert abs(gained) > 1e-3


def simpson(values: np.ndarray, step: float) -> float:
    """Integral over an even number of intervals."""
    return float(step / 3 * (values[0] + 4 * values[1:-1:2].sum() + 2 * values[2:-1:2].sum() + values[-1]))
