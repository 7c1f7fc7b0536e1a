"""The archives' form."""

import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from fmpy.ssp.ssd import get_connections, read_ssd, validate_tree
from lxml import etree
from rps3_study.fmu import Fmu
from rps3_study.fmu_documentation import reference_results

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
    # the compiler's page of crates within the standard library, whose code is in the binaries too
    page = licenses / "rust-standard-library.html"
    assert not page.exists() or "gimli" in page.read_text()


def test_binary_holds_no_path_of_the_machine_that_built_it(fmu: Fmu) -> None:
    here = Path(__file__).resolve().parents[2]
    for binary in (fmu.directory / "binaries").rglob("*.*"):
        for path in (Path.home(), here):
            assert str(path).encode() not in binary.read_bytes()


@pytest.mark.master("fmutool", "validation")
def test_fmutool_finds_no_error(fmu: Fmu) -> None:
    fmutool = Path(sysconfig.get_path("scripts")) / ("fmutool.exe" if sys.platform == "win32" else "fmutool")
    done = subprocess.run([fmutool, "-input", fmu.archive, "-check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_reference_results_in_the_archive_are_those_of_the_fmu(fmu: Fmu) -> None:
    directory = fmu.directory / reference_results.DIRECTORY
    model = fmu.archive.stem
    written = np.genfromtxt(directory / f"{model}_ref.csv", delimiter=",", names=True)
    assert len(written) == 29
    results = reference_results.simulated(fmu, directory / f"{model}_in.csv")
    assert list(results) == list(written.dtype.names)
    for name, values in results.items():
        # nine digits are written
        np.testing.assert_allclose(written[name], values, rtol=1e-8, err_msg=name)


def test_reference_results_are_small_and_say_how_they_were_made(fmu: Fmu) -> None:
    directory = fmu.directory / reference_results.DIRECTORY
    assert sum(path.stat().st_size for path in directory.iterdir()) < 100_000
    manifest = etree.parse(directory / "fmi-ls-manifest.xml").getroot()
    listed = {related.get("source") for related in manifest}
    assert listed | {"fmi-ls-manifest.xml"} == {path.name for path in directory.iterdir()}
    text = (directory / f"{fmu.archive.stem}_ref.opt").read_text(encoding="utf-8")
    settings = {name: float(value) for name, value in (line.split(", ") for line in text.splitlines())}
    assert settings == {"StartTime": 0.0, "StopTime": 1.4, "StepSize": 1e-3, "RelTol": 1e-6}


def test_what_runs_write_into_the_archives_is_the_same_bytes_each_time(dist: Path, tmp_path: Path) -> None:
    given = ROOT / "target/documentation"
    if not given.exists():
        pytest.skip("packaged elsewhere: `cargo xtask package` leaves what the documentation is made from")
    command = [sys.executable, "-m", "rps3_study.fmu_documentation", "--fmus", given / "bare", "--out", tmp_path]
    command += ["--crates", given / "crates.json", "--frames", ROOT / "docs/figures/frames.svg"]
    subprocess.run(command, env={**os.environ, "PYTHONHASHSEED": "7"}, check=True, stdout=subprocess.DEVNULL)
    for model in ("Rps3Plant", "Rps3Controller"):
        written = [path for path in (tmp_path / model).rglob("*") if path.is_file()]
        assert len(written) > 4
        with zipfile.ZipFile(dist / f"{model}.fmu") as archive:
            for path in written:
                name = path.relative_to(tmp_path / model).as_posix()
                assert archive.read(name) == path.read_bytes(), name


@pytest.mark.skipif("RPS3_REPRODUCE" not in os.environ, reason="builds all anew, for minutes: set RPS3_REPRODUCE")
def test_a_build_of_a_copy_elsewhere_gives_equal_archives(dist: Path, tmp_path: Path) -> None:
    copy = tmp_path / "a place with a longer name"
    tracked = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in filter(None, tracked.split("\0")):
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, copy / name)
    (copy / ".venv").symlink_to(ROOT / ".venv", target_is_directory=True)
    subprocess.run(["cargo", "xtask", "package"], cwd=copy, check=True, stdout=subprocess.DEVNULL)
    for name in ARCHIVES:
        assert (copy / "dist" / name).read_bytes() == (dist / name).read_bytes(), name


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
