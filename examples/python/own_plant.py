"""Rps3Controller on a plant of your own.

The plant is a level platform on massless limbs that can only go up and down; the controller's parameters, its model of
the plant, say so. Run it after `cargo xtask package`, where `dist/` lies:
`.venv/bin/python examples/python/own_plant.py`. It needs FMPy and NumPy alone.
"""

import shutil

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave

STEP, DURATION = 1e-3, 1.2
RADIAL = 0.4172 - 0.3616 / np.sqrt(3)  # horizontal distance between the joints of a limb, m
SCREW, GEAR = 2 * np.pi / 0.010, 50.0  # rotor angle per limb length and per limb angle
MASS, KT, JM, BM, LA, RA = 4.0, 0.21, 3.7e-5, 1.3e-5, 2.4e-3, 4.8


class Lift:
    """Heave z, its rate v, and the currents of one leg and one revolute motor: all three limbs are alike."""

    def __init__(self, z: float) -> None:
        self.state = np.array([z, 0.0, 0.0, 0.0])

    @staticmethod
    def ratios(z: float) -> tuple[float, float]:
        """Rotor angles per heave."""
        d = np.hypot(RADIAL, z)
        return SCREW * z / d, GEAR * RADIAL / d**2

    def measured(self) -> dict[str, float]:
        """What the controller measures, by the names of its inputs."""
        z, v, i_leg, i_rev = self.state
        d = np.hypot(RADIAL, z)
        limb = {"d{}": d, "d{}_dot": z / d * v, "theta{}": np.arctan2(z, RADIAL), "theta{}_dot": RADIAL / d**2 * v}
        limb |= {"i_leg{}": i_leg, "i_rev{}": i_rev}
        return {name.format(i): value for name, value in limb.items() for i in (1, 2, 3)}

    def rates(self, state: np.ndarray, v_leg: float, v_rev: float) -> np.ndarray:
        """Rates of the state."""
        z, v, i_leg, i_rev = state
        leg, rev = self.ratios(z)
        force = 3 * (leg * (KT * i_leg - BM * leg * v) + rev * (KT * i_rev - BM * rev * v)) - MASS * 9.81
        inertia = MASS + 3 * JM * (leg**2 + rev**2)
        return np.array(
            [v, force / inertia, (v_leg - RA * i_leg - KT * leg * v) / LA, (v_rev - RA * i_rev - KT * rev * v) / LA]
        )

    def step(self, v_leg: float, v_rev: float, size: float, count: int = 20) -> None:
        """Heun's method."""
        h = size / count
        for _ in range(count):
            first = self.rates(self.state, v_leg, v_rev)
            second = self.rates(self.state + h * first, v_leg, v_rev)
            self.state = self.state + h / 2 * (first + second)


def main() -> None:
    """Lifts the platform from 4 to 6 cm."""
    archive = "dist/Rps3Controller.fmu"
    description = fmpy.read_model_description(archive)
    references = {variable.name: variable.valueReference for variable in description.modelVariables}
    directory = fmpy.extract(archive)
    controller = FMU2Slave(
        guid=description.guid,
        unzipDirectory=directory,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="controller",
    )

    def put(values: dict[str, float]) -> None:
        controller.setReal([references[name] for name in values], list(values.values()))

    def get(*names: str) -> list[float]:
        return controller.getReal([references[name] for name in names])

    lift = Lift(0.04)
    model = {"lower_mass": 0.0, "lower_inertia": 0.0, "upper_mass": 0.0, "upper_inertia": 0.0}
    level = {f"{point}_{tilt}": 0.0 for point in ("start", "via", "end") for tilt in ("tilt_x", "tilt_y")}
    controller.instantiate()
    put({**model, **level, "start_heave": 0.04, "via_heave": 0.05, "end_heave": 0.06, **lift.measured()})
    controller.setupExperiment(startTime=0.0, stopTime=DURATION)
    controller.enterInitializationMode()
    controller.exitInitializationMode()
    largest = 0.0
    for k in range(round(DURATION / STEP)):
        put(lift.measured())
        controller.doStep(currentCommunicationPoint=k * STEP, communicationStepSize=STEP)
        largest = max(largest, abs(lift.state[0] - get("heave_ref")[0]))
        lift.step(*get("v_leg1", "v_rev1"), STEP)
    end = abs(lift.state[0] - 0.06)
    print(f"off its reference by {1e3 * largest:.3f} mm at most, by {1e6 * end:.1f} um at the end")
    controller.terminate()
    controller.freeInstance()
    shutil.rmtree(directory, ignore_errors=True)
    if end > 1e-4:
        raise SystemExit("the controller does not get there")


if __name__ == "__main__":
    main()
