"""Model Exchange agrees with Co-Simulation."""

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.fmi1 import FMICallException
from rps3_study.fmu import Fmu, Instance, ModelInstance

STARTS = {"v_leg1": 3.0, "v_leg2": -2.0, "v_rev1": 4.0, "f_ext_z": -5.0}
STATES = ["heave", "tilt_x", "tilt_y", "heave_dot", "tilt_x_dot", "tilt_y_dot", "i_leg1", "i_rev3"]


def run(plant: Fmu, stop: float, **options: object) -> np.ndarray:
    """FMPy's result with constant inputs; FMPy steps its Euler solver from output to output."""
    return simulate_fmu(
        str(plant.archive),
        stop_time=stop,
        start_values=STARTS,
        output=STATES,
        set_stop_time=False,
        **options,
    )


@pytest.mark.master("FMPy", "ME, variable step")
def test_cvode_and_the_built_in_solver_agree(plant: Fmu) -> None:
    own = run(plant, 0.1, fmi_type="CoSimulation", relative_tolerance=1e-8, output_interval=1e-3)
    cvode = run(plant, 0.1, fmi_type="ModelExchange", solver="CVode", relative_tolerance=1e-8, output_interval=1e-3)
    for name in STATES:
        scale = np.abs(own[name]).max()
        # CVode bounds the local error; some ten steps a time constant add up to a hundred times that
        np.testing.assert_allclose(cvode[name][-1], own[name][-1], atol=1e-6 * scale, rtol=0, err_msg=name)


@pytest.mark.master("FMPy", "ME, Euler")
def test_euler_converges_to_the_built_in_solver_with_order_one(plant: Fmu) -> None:
    own = run(plant, 0.01, fmi_type="CoSimulation", relative_tolerance=1e-10, output_interval=1e-3)
    coarse, fine = (
        run(plant, 0.01, fmi_type="ModelExchange", solver="Euler", step_size=step, output_interval=step)
        for step in (1e-5, 5e-6)
    )
    for name in STATES:
        ratio = abs(coarse[name][-1] - own[name][-1]) / abs(fine[name][-1] - own[name][-1])
        assert ratio == pytest.approx(2.0, abs=0.1), name


@pytest.mark.master("FMPy", "ME, time events")
@pytest.mark.parametrize("early", [0.0, 1e-10])  # a host's clock may have added up its steps
def test_controller_has_equal_outputs_at_its_time_events_and_its_co_simulation_ticks(
    controller: Fmu, early: float
) -> None:
    outputs, ticks = controller.names("output"), 50
    with Instance(controller) as cs, ModelInstance(controller) as me:
        cs.initialize({"control_mode": 2})
        me.initialize({"control_mode": 2})
        info = update(me)
        for k in range(ticks):
            cs.step(k * 1e-3, 1e-3)
            assert me.get(outputs) == cs.get(outputs), k
            *_, defined, event_time = info
            assert defined and event_time == pytest.approx((k + 1) * 1e-3, abs=1e-15)
            me.slave.enterContinuousTimeMode()
            me.slave.setTime(event_time - early)
            me.slave.enterEventMode()
            info = update(me)


def test_time_of_a_discrete_time_model_goes_on_in_event_mode_once_the_event_is_over(controller: Fmu) -> None:
    # footnote 8 of section 3.2.3
    with ModelInstance(controller) as me:
        me.initialize({"control_mode": 2})

        def stands_still(time: float) -> None:
            with pytest.raises(FMICallException):
                me.slave.setTime(time)

        stands_still(1e-3)
        update(me)
        over = me.slave.getFMUState()
        me.slave.setTime(1e-3)
        stands_still(2e-3)
        me.slave.setFMUState(over)
        me.slave.setTime(1e-3)
        update(me)
        me.slave.enterContinuousTimeMode()
        me.slave.enterEventMode()
        stands_still(2e-3)
        update(me)
        me.slave.setTime(2e-3)
        me.slave.freeFMUState(over)


def update(instance: ModelInstance) -> tuple:
    """Result of fmi2NewDiscreteStates, repeated until no further update is needed."""
    while True:
        info = instance.slave.newDiscreteStates()
        if not info[0]:
            return info
