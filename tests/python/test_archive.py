"""The archives' form."""

import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import pytest
from fmpy.ssp.ssd import get_connections, read_ssd, validate_tree
from lxml import etree
from rps3_study.fmu import Fmu

ARCHIVES = ("Rps3Plant.fmu", "Rps3Controller.fmu", "Rps3.ssp")


@pytest.mark.parametrize("name", ARCHIVES)
def test_entries_are_sorted_plain_files_without_a_time_of_their_own(dist: Path, name: str) -> None:
    with zipfile.ZipFile(dist / name) as archive:
        entries = archive.infolist()
    assert [entry.filename for entry in entries] == sorted(entry.filename for entry in entries)
    for entry in entries:
        assert entry.date_time == (1980, 1, 1, 0, 0, 0)
        assert entry.compress_type in (zipfile.ZIP_DEFLATED, zipfile.ZIP_STORED)
        assert "\\" not in entry.orig_filename and not entry.is_dir()
        assert entry.external_attr >> 28 in (0, 0o10), f"{entry.filename} is no plain file"


def test_licenses_go_with_the_fmu(fmu: Fmu) -> None:
    licenses = fmu.directory / "documentation" / "licenses"
    assert "Apache License" in (licenses / "LICENSE-APACHE.txt").read_text()
    assert "MIT License" in (licenses / "LICENSE-MIT.txt").read_text()
    assert (licenses / "license.txt").exists()


def test_binary_holds_no_path_of_the_machine_that_built_it(fmu: Fmu) -> None:
    home = str(Path.home()).encode()
    for binary in (fmu.directory / "binaries").rglob("*.*"):
        assert home not in binary.read_bytes()


def test_fmutool_finds_no_error(fmu: Fmu) -> None:
    fmutool = Path(sysconfig.get_path("scripts")) / ("fmutool.exe" if sys.platform == "win32" else "fmutool")
    done = subprocess.run([fmutool, "-input", fmu.archive, "-check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_system_structures_are_valid_against_the_ssp_schemas(dist: Path) -> None:
    with zipfile.ZipFile(dist / "Rps3.ssp") as archive:
        for name in archive.namelist():
            kind = {".ssd": "Description", ".ssv": "ParameterValues"}.get(Path(name).suffix)
            if kind is not None:
                validate_tree(etree.fromstring(archive.read(name)), f"SystemStructure{kind}.xsd")


def test_ssp_connects_every_equal_name(dist: Path, plant: Fmu, controller: Fmu) -> None:
    connections = {
        (source.parent.name, source.name, target.parent.name, target.name)
        for source, target in get_connections(read_ssd(str(dist / "Rps3.ssp")).system)
    }
    sides = {"plant": plant, "controller": controller}
    expected = {
        (a, name, b, name)
        for a, b in (("plant", "controller"), ("controller", "plant"))
        for name in set(sides[a].names("output")) & set(sides[b].names("input"))
    }
    assert connections == expected
    assert len(expected) == 27
