"""The examples run; of those for programs that are not here, what can be checked without them holds."""

import re
import runpy
import subprocess
import sys
from pathlib import Path
from zipfile import ZipFile

import pytest
from conftest import ROOT
from fmpy import simulate_fmu
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import validate_tree
from lxml import etree
from rps3_study.fmu import Fmu

PYTHON = ROOT / "examples/python"
OPEN_MODELICA = ROOT / "examples/openmodelica"


@pytest.mark.parametrize("example", sorted(PYTHON.glob("*.py")), ids=lambda path: path.name)
def test_python_example_runs_as_it_stands(example: Path, dist: Path, tmp_path: Path) -> None:
    (tmp_path / "dist").symlink_to(dist.resolve(), target_is_directory=True)
    done = subprocess.run([sys.executable, example], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout


def test_modelica_script_names_variables_of_the_plant_and_every_input(plant: Fmu) -> None:
    script = (OPEN_MODELICA / "plant.mos").read_text(encoding="utf-8")
    named = set(re.findall(r"\bplant\.(?!heave)(\w+)", script)) | set(re.findall(r"plant\((\w+)", script))
    assert named == {*plant.names("input"), "settled_start"}


def test_heave_that_the_modelica_script_should_find_is_that_of_fmpy(plant: Fmu) -> None:
    text = (OPEN_MODELICA / "README.md").read_text(encoding="utf-8")
    stated = re.search(r"heave of (\S+) m", text)
    assert stated is not None
    result = simulate_fmu(
        str(plant.archive),
        fmi_type="ModelExchange",
        solver="CVode",
        stop_time=0.1,
        relative_tolerance=1e-6,
        start_values={"settled_start": False},
        output=["heave"],
    )
    assert f"{result['heave'][-1]:.5f}" == stated[1]


def test_package_prepared_for_omsimulator_is_valid_and_still_runs(dist: Path, tmp_path: Path) -> None:
    annotate = runpy.run_path(str(OPEN_MODELICA / "annotate.py"))["annotate"]
    annotate(dist / "Rps3.ssp", tmp_path / "Rps3.ssp")
    with ZipFile(tmp_path / "Rps3.ssp") as archive:
        structures = [name for name in archive.namelist() if name.endswith(".ssd")]
        for name in structures:
            tree = etree.fromstring(archive.read(name))
            validate_tree(tree, "SystemStructureDescription.xsd")
            assert len(tree.findall(".//{*}FixedStepMaster")) == 1
    assert len(structures) == 2
    result = simulate_ssp(str(tmp_path / "Rps3.ssp"), stop_time=0.01, step_size=1e-3)
    assert len(result) > 5


def test_omsimulator_script_names_what_the_package_holds(dist: Path, plant: Fmu, controller: Fmu) -> None:
    script = (OPEN_MODELICA / "crossing.lua").read_text(encoding="utf-8")
    sides = {"plant": plant, "controller": controller}
    named = re.findall(r"Rps3\.Rps3\.(\w+)\.(\w+)", script)
    assert len(named) == 2
    assert [name for side, name in named if name not in sides[side].variables] == []
    with ZipFile(dist / "Rps3.ssp") as archive:
        tree = etree.fromstring(archive.read("SystemStructure.ssd"))
    assert tree.get("name") == tree.find("{*}System").get("name") == "Rps3"
