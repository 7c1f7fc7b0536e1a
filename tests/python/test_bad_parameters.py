"""Parameters that make no sense end initialization with a logged error, and nothing else."""

import math

import pytest
from fmpy.fmi1 import FMICallException
from rps3_study.fmu import Fmu, Instance, Value

R_B = 0.3616 / math.sqrt(3)
WIDE = {"d_min": -1.0, "d_max": 1.0, "theta_min": -3.0, "theta_max": 3.0}

PLANT: dict[str, dict[str, Value]] = {
    "zero plate mass": {"plate_mass": 0.0},
    "NaN mass": {"plate_mass": math.nan},
    "infinite radius": {"base_radius": math.inf},
    "negative inductance": {"motor_la": -1e-3},
    "zero resistance": {"motor_ra": 0.0},
    "zero screw lead": {"screw_lead": 0.0},
    "limits the wrong way round": {"d_min": 0.3, "d_max": 0.1},
    "start pose beyond the limits": {"heave_start": 0.5},
    "start pose tilted beyond the limits": {"tilt_x_start": 1.2},
    "limb of zero length": {"base_radius": R_B, "heave_start": 0.0, "tilt_x_start": 0.0, "tilt_y_start": 0.0, **WIDE},
}
CONTROLLER: dict[str, dict[str, Value]] = {
    "zero plate mass": {"plate_mass": 0.0},
    "NaN gain": {"k_p": math.nan},
    "negative gain": {"k_d": -1.0},
    "zero sample time": {"sample_time": 0.0},
    "unknown control mode": {"control_mode": 9},
    "unknown profile": {"profile": 0},
    "negative search range": {"rho_max": -0.1},
    "negative inductance": {"motor_la": -1e-3},
}


def refused(fmu: Fmu, parameters: dict[str, Value]) -> None:
    """Asserts that an instance refuses the parameters, says why, and is usable after a reset."""
    with Instance(fmu) as instance:
        with pytest.raises(FMICallException) as caught:
            instance.initialize(parameters)
        assert caught.value.status == 3
        errors = [message.text for message in instance.messages if message.status == 3]
        assert errors
        named = [name for name in parameters if any(name in text for text in errors)]
        assert named or "pose" in errors[0] or "limb" in errors[0], f"no parameter is named in {errors}"
        instance.slave.reset()
        instance.initialize({"control_mode": 2} if "control_mode" in fmu.variables else {})
        instance.step(0.0, 1e-3)


@pytest.mark.parametrize("case", PLANT)
def test_plant_refuses(plant: Fmu, case: str) -> None:
    refused(plant, PLANT[case])


@pytest.mark.parametrize("case", CONTROLLER)
def test_controller_refuses(controller: Fmu, case: str) -> None:
    parameters = {"control_mode": 2, **CONTROLLER[case]}
    refused(controller, parameters)


def test_pose_that_the_motors_cannot_hold_starts_without_current_and_warns(plant: Fmu) -> None:
    # Without revolute motors the legs alone carry the platform, which they cannot at a direct singularity.
    singular = {"heave_start": 0.0452873763, "tilt_x_start": math.radians(8) * math.cos(math.radians(40))}
    singular["tilt_y_start"] = math.radians(8) * math.sin(math.radians(40))
    with Instance(plant) as instance:
        instance.initialize({**singular, "revolute_motors": False})
        assert any(message.status == 1 for message in instance.messages)
        assert instance["i_leg1"] == instance["i_leg2"] == instance["i_leg3"] == 0.0
