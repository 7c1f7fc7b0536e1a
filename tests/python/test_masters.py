"""Masters run the default crossing, and get what the core coupled without FMI gets.

Where the controller goes first at each step that is every bit. Masters that read the SSP package `Rps3.ssp` exchange
values Jacobi-wise, each in its own way at the start, so voltages come one or two samples late and the first sample may
see inputs that are not set yet. Heave moves at 10 cm/s at most: two samples of 1 ms are 0.2 mm.
"""

import ctypes.util
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from fmpy.ssp.simulation import simulate_ssp
from rps3_study.couple import run_crossing
from rps3_study.fmu import Fmu

STEP, POINTS = 1e-3, 14
BOUND = 2e-4
# one sample late; and with a controller that predicts over that sample to 1e-7
LATE, PREDICTED = 1e-4, 1e-6
INTERVAL = 0.1
SSP, PAIR = "SSP package, Jacobi", "CS pair, controller first"
DELAYED, PLANNED = "CS pair, Jacobi", "CS pair, Jacobi, computation_delay = 1"


Check = Callable[[float, float], None]


def coarse(heave: np.ndarray) -> np.ndarray:
    """Heave each 0.1 s, but for the start, m."""
    return heave[:: round(INTERVAL / STEP)][1:]


class Variant(NamedTuple):
    """A system structure of the package, its parameter set and what that says."""

    structure: str
    parameter_set: str
    revolute_motors: bool


SIX = Variant("SystemStructure.ssd", "six_motors", True)
THREE = Variant("ThreeMotors.ssd", "three_motors", False)


def with_structure(package: Path, variant: Variant, target: Path) -> Path:
    """A copy of the package whose system structure is the variant's."""
    with zipfile.ZipFile(package) as source, zipfile.ZipFile(target, "w") as copy:
        for name in source.namelist():
            if not name.endswith(".ssd"):
                copy.writestr(name, source.read(name))
        copy.writestr("SystemStructure.ssd", source.read(variant.structure))
    return target


class Libcosim:
    """OSP's libcosim."""

    def __init__(self, package: Path, variant: Variant, directory: Path) -> None:
        from libcosimpy.CosimExecution import CosimExecution
        from libcosimpy.CosimObserver import CosimObserver

        package = with_structure(package, variant, directory / "variant.ssp")
        with zipfile.ZipFile(package) as archive:
            archive.extractall(directory)
        self.execution = CosimExecution.from_ssp_file(str(directory), round(STEP * 1e9))
        self.observer = CosimObserver.create_last_value()
        self.execution.add_observer(self.observer)
        self.plant = self.execution.slave_index_from_instance_name("plant")

    def run_until(self, time: float) -> None:
        assert self.execution.simulate_until(round(time * 1e9))

    def heave(self, plant: Fmu) -> float:
        return self.observer.last_real_values(self.plant, [plant.variables["heave"].valueReference])[0]

    def revolute_motors(self, plant: Fmu) -> bool:
        return self.observer.last_boolean_values(self.plant, [plant.variables["revolute_motors"].valueReference])[0]


class Ecos:
    """ECOS; it applies a parameter set when it is told its name."""

    def __init__(self, package: Path, variant: Variant, directory: Path) -> None:
        from ecospy import EcosSimulation

        package = with_structure(package, variant, directory / "variant.ssp")
        self.simulation = EcosSimulation(STEP, ssp_path=str(package))
        assert self.simulation.init(parameter_set=variant.parameter_set)

    def run_until(self, time: float) -> None:
        self.simulation.step_until(time)

    def heave(self, _: Fmu) -> float:
        return self.simulation.get_real("plant::heave")

    def revolute_motors(self, _: Fmu) -> bool:
        return self.simulation.get_bool("plant::revolute_motors")


MASTERS = pytest.mark.parametrize(
    "master",
    [
        pytest.param(Libcosim, id="libcosim", marks=pytest.mark.master("libcosim", SSP)),
        pytest.param(
            Ecos,
            id="ECOS",
            marks=[
                pytest.mark.master("ECOS", SSP),
                pytest.mark.skipif(ctypes.util.find_library("tbb") is None, reason="ECOS needs libtbb12"),
            ],
        ),
    ],
)


@MASTERS
def test_ssp_package_crosses_the_singularity(
    master: Callable[[Path, Variant, Path], Libcosim | Ecos],
    dist: Path,
    tmp_path: Path,
    plant: Fmu,
    native: dict[str, np.ndarray],
    keeps_within: Check,
) -> None:
    system = master(dist / "Rps3.ssp", SIX, tmp_path)
    heave = []
    for k in range(POINTS):
        system.run_until((k + 1) * INTERVAL)
        heave.append(system.heave(plant))
    keeps_within(np.abs(heave - coarse(native["heave"])).max(), BOUND)


@MASTERS
@pytest.mark.parametrize("variant", [SIX, THREE], ids=["six motors", "three motors"])
def test_parameter_set_of_the_variant_reaches_the_plant(
    master: Callable[[Path, Variant, Path], Libcosim | Ecos], variant: Variant, dist: Path, tmp_path: Path, plant: Fmu
) -> None:
    system = master(dist / "Rps3.ssp", variant, tmp_path)
    system.run_until(0.01)
    assert system.revolute_motors(plant) == variant.revolute_motors


@pytest.mark.master("FMPy", SSP)
def test_fmpy_runs_the_ssp_package(dist: Path, native: dict[str, np.ndarray], keeps_within: Check) -> None:
    result = simulate_ssp(str(dist / "Rps3.ssp"), stop_time=POINTS * INTERVAL, step_size=STEP)
    # FMPy files the values after a step under the time before it
    heave = result["plant.heave"][round(INTERVAL / STEP) - 1 :: round(INTERVAL / STEP)][:POINTS]
    # At its first step it feeds zeros as measurements: a kick of some mm that is gone after 0.2 s
    keeps_within(np.abs(heave - coarse(native["heave"]))[2:].max(), BOUND)


@pytest.mark.master("FMPy", PAIR)
def test_fmpy_with_the_controller_first_is_the_native_coupling_to_the_last_bit(
    plant: Fmu, controller: Fmu, native: dict[str, np.ndarray], keeps_within: Check
) -> None:
    run = run_crossing(plant, controller)
    for name, values in native.items():
        if name in plant.names("output"):
            np.testing.assert_array_equal(run[f"plant.{name}"], values, err_msg=name)
        else:
            # the tick at the end is one that the run does not make
            np.testing.assert_array_equal(run[f"controller.{name}"][:-1], values[:-1], err_msg=name)
    keeps_within(np.abs(run["plant.heave"] - native["heave"]).max(), 0.0)


@pytest.mark.parametrize(
    ("delay", "bound"),
    [
        pytest.param(0, LATE, id="ignored", marks=pytest.mark.master("FMPy", DELAYED)),
        pytest.param(1, PREDICTED, id="planned for", marks=pytest.mark.master("FMPy", PLANNED)),
    ],
)
def test_fmpy_with_values_exchanged_at_once_stays_near_the_native_coupling(
    delay: int, bound: float, plant: Fmu, controller: Fmu, native: dict[str, np.ndarray], keeps_within: Check
) -> None:
    run = run_crossing(plant, controller, {}, {"computation_delay": delay}, exchange="jacobi")
    keeps_within(np.abs(run["plant.heave"] - native["heave"]).max(), bound)
