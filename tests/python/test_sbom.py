"""The software bill of materials that lies in each FMU and beside it."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator
from rps3_study.fmu import Fmu


@pytest.fixture
def text(fmu: Fmu) -> str:
    """The bill of the FMU at hand."""
    return (fmu.directory / "extra/org.cyclonedx/bom.json").read_text(encoding="utf-8")


@pytest.fixture
def bill(text: str) -> dict[str, Any]:
    """The bill, parsed."""
    return json.loads(text)


def test_bill_is_valid_against_cyclonedx_schema(text: str) -> None:
    assert JsonStrictValidator(SchemaVersion.V1_5).validate_str(text) is None


def test_bill_beside_the_fmu_is_the_one_inside(fmu: Fmu, text: str, dist: Path) -> None:
    identifier = fmu.description.coSimulation.modelIdentifier
    assert (dist / f"{identifier}.cdx.json").read_text(encoding="utf-8") == text


def test_bill_describes_the_fmu(fmu: Fmu, bill: dict[str, Any]) -> None:
    component = bill["metadata"]["component"]
    assert component["name"] == fmu.description.modelName
    assert component["version"] == fmu.description.version
    assert component["licenses"] == [{"expression": fmu.description.license}]


def test_bill_lists_the_crates_whose_licenses_are_in_the_fmu_and_the_standard_library(
    fmu: Fmu, bill: dict[str, Any]
) -> None:
    third_party = fmu.directory / "documentation/licenses/third-party"
    crates = {f"{c['name']}-{c['version']}" for c in bill["components"] if "purl" in c}
    assert crates == {directory.name for directory in third_party.iterdir()}
    assert [c["name"] for c in bill["components"] if "purl" not in c] == ["std"]


def test_every_component_is_needed_by_the_fmu_or_by_another(bill: dict[str, Any]) -> None:
    known = {component["bom-ref"] for component in bill["components"]}
    needed = {reference for node in bill["dependencies"] for reference in node.get("dependsOn", [])}
    assert needed == known
    assert bill["dependencies"][0]["ref"] == bill["metadata"]["component"]["bom-ref"]


def test_bill_has_no_number_or_time_of_its_own(bill: dict[str, Any], text: str) -> None:
    assert "serialNumber" not in bill and "timestamp" not in bill["metadata"]
    assert re.search(r"/home/|/root/|file:", text) is None
