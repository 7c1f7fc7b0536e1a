"""Rps3Plant under a controller of your own: PD control of each joint with gravity compensation.

Run it after `cargo xtask package`, where `dist/` lies: `.venv/bin/python examples/python/own_controller.py`. It needs
FMPy and NumPy alone.
"""

import shutil

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave

STEP, DURATION = 1e-3, 1.2
MOTORS = [f"{kind}{limb}" for limb in (1, 2, 3) for kind in ("leg", "rev")]
JOINTS = [f"{kind}{limb}" for limb in (1, 2, 3) for kind in ("d", "theta")]
# V per m and rad, and per m/s and rad/s; alternately a leg and a revolute motor, as in MOTORS
STIFFNESS, DAMPING = np.tile([8e3, 8e2], 3), np.tile([1e2, 1e1], 3)


class Controller:
    """Takes each joint from where it is to its target within 1 s, smoothly."""

    def __init__(self, joints: np.ndarray, holding: np.ndarray, target: np.ndarray) -> None:
        self.start, self.holding, self.target = joints, holding, target

    def reference(self, time: float) -> np.ndarray:
        """Limb lengths (m) and angles (rad) wanted at a time in s."""
        s = min(time / 1.0, 1.0)
        return self.start + (10 * s**3 - 15 * s**4 + 6 * s**5) * (self.target - self.start)

    def voltages(self, time: float, joints: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Voltages from what the sensors tell: what holds the start, what cancels the back-emf, and the gains."""
        wanted, before = self.reference(time), self.reference(max(time - STEP, 0.0))
        error, error_rate = wanted - joints, (wanted - before) / STEP - rates
        back_emf = 0.21 * np.tile([2 * np.pi / 0.010, 50.0], 3) * (wanted - before) / STEP
        return self.holding + back_emf + STIFFNESS * error + DAMPING * error_rate


def main() -> None:
    """Lowers the platform by 2 cm and levels it."""
    archive = "dist/Rps3Plant.fmu"
    description = fmpy.read_model_description(archive)
    references = {variable.name: variable.valueReference for variable in description.modelVariables}
    directory = fmpy.extract(archive)
    plant = FMU2Slave(
        guid=description.guid,
        unzipDirectory=directory,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="plant",
    )

    def get(names: list[str]) -> np.ndarray:
        return np.array(plant.getReal([references[name] for name in names]))

    plant.instantiate()
    plant.setupExperiment(startTime=0.0, stopTime=DURATION)
    plant.enterInitializationMode()
    plant.exitInitializationMode()
    start = get(JOINTS)
    # where the level platform, 2 cm lower, has its joints
    radial, heave = 0.4172 - 0.3616 / np.sqrt(3), get(["heave"])[0] - 0.02
    target = np.tile([np.hypot(radial, heave), np.arctan2(heave, radial)], 3)
    controller = Controller(start, 4.8 * get([f"i_{motor}" for motor in MOTORS]), target)
    for k in range(round(DURATION / STEP)):
        time = k * STEP
        voltages = controller.voltages(time, get(JOINTS), get([f"{joint}_dot" for joint in JOINTS]))
        plant.setReal([references[f"v_{motor}"] for motor in MOTORS], list(voltages))
        plant.doStep(currentCommunicationPoint=time, communicationStepSize=STEP)
    error = get(["heave", "tilt_x", "tilt_y"]) - [heave, 0.0, 0.0]
    print(f"at the end {1e3 * error[0]:.3f} mm too high and tilted by {1e3 * np.hypot(*error[1:]):.3f} mrad")
    plant.terminate()
    plant.freeInstance()
    shutil.rmtree(directory, ignore_errors=True)
    if np.abs(error).max() > 2e-3:
        raise SystemExit("the controller does not get there")


if __name__ == "__main__":
    main()
