"""The model descriptions keep the rules of FMI 2.0, those included that validators do not check."""

from collections import Counter

import pytest
from fmpy.validation import validate_fmu
from rps3_study.fmu import Fmu

SETTABLE = ("input", "parameter")


@pytest.mark.master("FMPy", "validation")
def test_fmpy_finds_no_problem(fmu: Fmu) -> None:
    assert validate_fmu(str(fmu.archive)) == []


def test_settable_variables_share_no_value_reference(fmu: Fmu) -> None:
    used = Counter((v.type, v.valueReference) for v in fmu.variables.values() if v.causality in SETTABLE)
    assert [key for key, count in used.items() if count > 1] == []


def test_there_is_one_independent_variable_and_it_is_time(fmu: Fmu) -> None:
    assert fmu.names("independent") == ["time"]


def test_start_values_lie_within_their_limits(fmu: Fmu) -> None:
    for variable in fmu.variables.values():
        if variable.start is None or variable.type == "Boolean":
            continue
        start = float(variable.start)
        assert variable.min is None or start >= float(variable.min), variable.name
        assert variable.max is None or start <= float(variable.max), variable.name


def test_every_settable_variable_has_description_and_start(fmu: Fmu) -> None:
    for name in fmu.names("input") + fmu.names("parameter"):
        variable = fmu.variables[name]
        assert variable.description and variable.start is not None, name


def test_no_input_or_output_is_a_string_or_enumeration(fmu: Fmu) -> None:
    for name in fmu.names("input") + fmu.names("output"):
        assert fmu.variables[name].type in ("Real", "Integer", "Boolean"), name


def test_both_interface_types_are_offered_under_the_archive_name(fmu: Fmu) -> None:
    for interface in (fmu.description.coSimulation, fmu.description.modelExchange):
        assert interface.modelIdentifier == fmu.archive.stem


def test_controller_inputs_bear_the_names_of_plant_outputs_and_the_other_way_round(plant: Fmu, controller: Fmu) -> None:
    measured = {n for n in controller.names("input") if not n.startswith("ref_")}
    assert measured <= set(plant.names("output"))
    loads = {n for n in plant.names("input") if n.startswith(("f_ext", "m_ext"))}
    assert set(plant.names("input")) - loads <= set(controller.names("output"))


def test_connected_variables_agree_in_unit(plant: Fmu, controller: Fmu) -> None:
    for source, target in ((plant, controller), (controller, plant)):
        for name in set(source.names("output")) & set(target.names("input")):
            assert source.variables[name].unit == target.variables[name].unit, name


def test_common_parameters_have_equal_starts(plant: Fmu, controller: Fmu) -> None:
    common = set(plant.names("parameter")) & set(controller.names("parameter"))
    assert "plate_mass" in common and "revolute_motors" in common
    for name in common:
        assert plant.variables[name].start == controller.variables[name].start, name


@pytest.mark.parametrize("stop", ["d", "theta"])
def test_default_start_pose_lies_between_the_end_stops(plant: Fmu, controller: Fmu, stop: str) -> None:
    lowest, highest = (float(plant.variables[f"{stop}_{limit}"].start) for limit in ("min", "max"))
    for limb in (1, 2, 3):
        assert lowest < float(controller.variables[f"{stop}{limb}"].start) < highest
