"""The shared library and its model description tell the same."""

import ctypes
import shutil
from pathlib import Path

import lief
import pytest
from conftest import ROOT
from fmpy import fmi2, platform, sharedLibraryExtension
from fmpy.fmi1 import FMICallException
from rps3_study.fmu import Fmu, Instance, ModelInstance, Value

KINDS = [Instance, ModelInstance]

# Sections 2.1, 3.2 and 4.2 of the standard.
COMMON = """
    GetTypesPlatform GetVersion SetDebugLogging Instantiate FreeInstance SetupExperiment EnterInitializationMode
    ExitInitializationMode Terminate Reset GetReal GetInteger GetBoolean GetString SetReal SetInteger SetBoolean
    SetString GetFMUstate SetFMUstate FreeFMUstate SerializedFMUstateSize SerializeFMUstate DeSerializeFMUstate
    GetDirectionalDerivative
"""
MODEL_EXCHANGE = """
    EnterEventMode NewDiscreteStates EnterContinuousTimeMode CompletedIntegratorStep SetTime SetContinuousStates
    GetDerivatives GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates
"""
CO_SIMULATION = """
    SetRealInputDerivatives GetRealOutputDerivatives DoStep CancelStep GetStatus GetRealStatus GetIntegerStatus
    GetBooleanStatus GetStringStatus
"""
FUNCTIONS = [f"fmi2{name}" for name in (COMMON + MODEL_EXCHANGE + CO_SIMULATION).split()]


def starts(fmu: Fmu) -> dict[str, Value]:
    """Start values of all variables that are set from outside."""
    convert = {"Real": float, "Integer": int, "Boolean": lambda text: text in ("true", True)}
    names = fmu.names("input") + fmu.names("parameter")
    return {name: convert[fmu.variables[name].type](fmu.variables[name].start) for name in names}


def library(fmu: Fmu) -> Path:
    """The shared library for this platform."""
    name = f"{fmu.description.coSimulation.modelIdentifier}{sharedLibraryExtension}"
    return fmu.directory / "binaries" / platform / name


def test_library_is_named_after_the_model_identifier(fmu: Fmu) -> None:
    assert fmu.description.coSimulation.modelIdentifier == fmu.description.modelExchange.modelIdentifier
    assert library(fmu).is_file()


def test_all_44_functions_are_exported_even_those_that_do_nothing(fmu: Fmu) -> None:
    assert len(FUNCTIONS) == 44
    loaded = ctypes.CDLL(str(library(fmu)))
    assert [name for name in FUNCTIONS if not hasattr(loaded, name)] == []


@pytest.mark.parametrize("kind", KINDS)
def test_start_values_read_from_the_binary_equal_those_of_the_xml(fmu: Fmu, kind: type[Instance]) -> None:
    with kind(fmu) as instance:
        instance.setup()
        assert instance.get(starts(fmu)) == starts(fmu)


def test_reset_restores_all_start_values(fmu: Fmu) -> None:
    with Instance(fmu) as instance:
        instance.set({name: 0.99 * value for name, value in starts(fmu).items() if fmu.variables[name].type == "Real"})
        instance.slave.reset()
        instance.setup()
        assert instance.get(starts(fmu)) == starts(fmu)


def test_every_variable_can_be_read_after_initialization(fmu: Fmu, settings: dict[str, Value]) -> None:
    with Instance(fmu) as instance:
        instance.initialize(settings)
        values = instance.get(fmu.variables)
    assert all(value == value for value in values.values())  # none is NaN


def test_calculated_outputs_lie_within_their_limits(fmu: Fmu, settings: dict[str, Value]) -> None:
    with Instance(fmu) as instance:
        instance.initialize(settings)
        for name, value in instance.get(fmu.names("output")).items():
            variable = fmu.variables[name]
            assert variable.min is None or value >= float(variable.min), name
            assert variable.max is None or value <= float(variable.max), name


@pytest.mark.parametrize("guid", ["", "{00000000-0000-0000-0000-000000000000}"])
def test_foreign_guid_is_refused(fmu: Fmu, guid: str) -> None:
    slave = fmi2.FMU2Slave(
        guid=guid,
        unzipDirectory=str(fmu.directory),
        modelIdentifier=fmu.description.coSimulation.modelIdentifier,
    )
    with pytest.raises(Exception, match="instantiate"):
        slave.instantiate()


def test_versions_are_those_of_fmi_2(fmu: Fmu) -> None:
    with Instance(fmu) as instance:
        assert instance.slave.getVersion() == "2.0"
        assert instance.slave.getTypesPlatform() == "default"


def test_unknown_value_reference_is_an_error_that_is_logged(fmu: Fmu) -> None:
    with Instance(fmu) as instance:
        with pytest.raises(FMICallException) as caught:
            instance.slave.getReal([4_000_000_000])
        assert caught.value.status == fmi2.fmi2Error
        assert any(message.status == fmi2.fmi2Error for message in instance.messages)


def test_log_names_the_instance_that_spoke(fmu: Fmu) -> None:
    with Instance(fmu, "one") as one, Instance(fmu, "two") as two:
        with pytest.raises(FMICallException):
            one.slave.getReal([4_000_000_000])
        assert {message.instance for message in one.messages} == {"one"}
        assert two.messages == []


def test_committed_description_is_the_packaged_one(fmu: Fmu) -> None:
    committed = ROOT / "modelDescription" / f"{fmu.archive.stem}.xml"
    assert committed.read_bytes() == (fmu.directory / "modelDescription.xml").read_bytes()


def test_no_mathematical_function_comes_from_the_platform(fmu: Fmu) -> None:
    # they differ in their last bits from system to system; ours are linked in, from the libm crate
    roots = "sin cos sincos tan asin acos atan atan2 sinh cosh tanh exp exp2 expm1 log log2 log10 log1p pow hypot cbrt"
    names = {root + suffix for root in [*roots.split(), "fma", "fmod", "round", "floor"] for suffix in ("", "f", "l")}
    for library in (fmu.directory / "binaries").rglob("*.*"):
        binary = lief.parse(library)
        imported = {str(function.name).lstrip("_") for function in binary.imported_functions}
        assert imported, "every library imports something"
        assert not names & imported


def test_a_component_of_another_copy_of_the_library_is_refused(fmu: Fmu, tmp_path: Path) -> None:
    # code and tables of both copies are the same, but the component's go when its own library is unloaded
    other = ctypes.CDLL(str(shutil.copy(library(fmu), tmp_path)))
    other.fmi2FreeInstance.restype = None
    with Instance(fmu) as instance:
        instance.initialize({})
        component = ctypes.c_void_p(instance.slave.component)
        assert other.fmi2Reset(component) == fmi2.fmi2Error
        other.fmi2FreeInstance(component)
        instance.step(0.0, 1e-3)
