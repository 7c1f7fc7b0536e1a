"""Directional and output derivatives against finite differences."""

from ctypes import POINTER, c_double, cast

import numpy as np
import pytest
from rps3_study.fmu import Fmu, Instance, ModelInstance

VOLTAGES = {"v_leg1": 3.0, "v_leg2": -2.0, "v_rev1": 4.0}


def states_of(plant: Fmu) -> list[str]:
    """Names of the continuous states in order."""
    return [entry.variable.derivative.name for entry in plant.description.derivatives]


def moving(plant: Fmu) -> tuple[ModelInstance, np.ndarray]:
    """A Model Exchange instance in Continuous-Time Mode at a state in motion."""
    instance = ModelInstance(plant)
    instance.initialize()
    instance.slave.newDiscreteStates()
    instance.slave.enterContinuousTimeMode()
    instance.set(VOLTAGES)
    count = len(states_of(plant))
    x = np.zeros(count)
    instance.slave.getContinuousStates(cast(x.ctypes.data, POINTER(c_double)), count)
    x[3:6] = (0.1, -0.3, 0.2)
    x[6:] += np.linspace(-0.5, 0.5, 6)
    put(instance, x)
    return instance, x


def put(instance: ModelInstance, x: np.ndarray) -> None:
    """Sets the continuous states."""
    instance.slave.setContinuousStates(cast(x.ctypes.data, POINTER(c_double)), x.size)


def unknowns_of(plant: Fmu) -> list[str]:
    """All outputs and state derivatives of type Real."""
    derivatives = [entry.variable.name for entry in plant.description.derivatives]
    return list(dict.fromkeys(plant.names("output", "Real") + derivatives))


def directional(instance: ModelInstance, unknowns: list[str], known: str) -> np.ndarray:
    """Partial derivatives of the unknowns by `known` as the FMU gives them."""
    references = [instance.fmu.variables[name].valueReference for name in unknowns]
    return np.array(
        instance.slave.getDirectionalDerivative(references, [instance.fmu.variables[known].valueReference], [1.0])
    )


def assert_close(analytic: np.ndarray, numeric: np.ndarray, unknowns: list[str]) -> None:
    """Central differences with a step of 1e-6 of a quantity's size are good to some 1e-7 of the largest entry."""
    scale = np.maximum(np.abs(numeric), 1e-3 * np.abs(numeric).max() + 1e-9)
    worst = int(np.argmax(np.abs(analytic - numeric) / scale))
    assert abs(analytic[worst] - numeric[worst]) < 1e-4 * scale[worst], (
        f"{unknowns[worst]}: {analytic[worst]} by the FMU, {numeric[worst]} by differences"
    )


@pytest.mark.master("FMPy", "directional derivatives")
@pytest.mark.parametrize("index", range(12))
def test_derivatives_by_states_equal_central_differences(plant: Fmu, index: int) -> None:
    instance, x = moving(plant)
    with instance:
        unknowns, known = unknowns_of(plant), states_of(plant)[index]
        analytic = directional(instance, unknowns, known)
        step = 1e-6
        values = []
        for sign in (1, -1):
            shifted = x.copy()
            shifted[index] += sign * step
            put(instance, shifted)
            values.append(np.array(list(instance.get(unknowns).values())))
        assert_close(analytic, (values[0] - values[1]) / (2 * step), unknowns)


def test_derivatives_by_inputs_equal_central_differences(plant: Fmu) -> None:
    instance, _ = moving(plant)
    with instance:
        unknowns = unknowns_of(plant)
        for known in plant.names("input"):
            analytic = directional(instance, unknowns, known)
            at, step = float(instance[known]), 1e-3
            values = []
            for sign in (1, -1):
                instance.set({known: at + sign * step})
                values.append(np.array(list(instance.get(unknowns).values())))
            instance.set({known: at})
            assert_close(analytic, (values[0] - values[1]) / (2 * step), unknowns)


@pytest.mark.master("FMPy", "output derivatives")
def test_output_derivatives_are_the_slopes_of_outputs(plant: Fmu) -> None:
    step, names = 1e-5, ["heave", "p_x", "d1", "theta2", "i_leg1", "w_x", "energy"]
    with Instance(plant) as instance:
        instance.initialize(tolerance=1e-10)
        instance.set(VOLTAGES)
        rows, slopes = [], []
        for k in range(300):
            instance.step(k * step, step)
            rows.append(np.array(list(instance.get(names).values())))
            references = [plant.variables[name].valueReference for name in names]
            slopes.append(np.array(instance.slave.getRealOutputDerivatives(references, [1] * len(names))))
        numeric = (rows[-1] - rows[-3]) / (2 * step)
        np.testing.assert_allclose(slopes[-2], numeric, rtol=1e-3, atol=1e-4)
