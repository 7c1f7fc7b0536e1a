"""Reference results inside the FMUs: `extra/org.fmi-standard.fmi-ls-ref/`, where FMI-LS-REF wants them.

`<model>_in.csv` holds inputs, `<model>_ref.csv` what the FMU makes of them in Co-Simulation, `<model>_ref.opt` the
settings, as in the FMI cross-check. The inputs are what the other FMU said in the default crossing, thinned out: so
each FMU can be checked alone.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from fmpy import simulate_fmu
from lxml import etree

from rps3_study.couple import Run
from rps3_study.fmu import Fmu

DIRECTORY = "extra/org.fmi-standard.fmi-ls-ref"
# Communication steps from one row to the next, of inputs and of results.
INPUT_ROWS, RESULT_ROWS = 10, 50
NAMESPACE = "http://fmi-standard.org/fmi-ls-manifest"
# Files by suffix, with type, role, and what they are.
RELATED = {
    "in.csv": ("text/csv", "testcase", "Inputs over time, linear in between, set at the beginning of each step"),
    "ref.csv": ("text/csv", "result", "Outputs in Co-Simulation with these inputs and default parameters; nine digits"),
    "ref.opt": ("text/csv", "configuration", "Start, stop and step in s, relative tolerance"),
}


def write(fmu: Fmu, run: Run, directory: Path) -> None:
    """Writes the files of one FMU.

    Args:
        fmu: whose results are wanted.
        run: both FMUs coupled; what fed the FMU comes from here.
        directory: of the files that are to be added to the archive.
    """
    model, target = fmu.description.modelName, directory / DIRECTORY
    target.mkdir(parents=True, exist_ok=True)
    other = "controller" if model == "Rps3Plant" else "plant"
    inputs = {"time": run.time}
    for name in fmu.names("input"):
        start = np.full(len(run.time), float(fmu.variables[name].start))
        inputs[name] = run.values.get(f"{other}.{name}", start)
    _write_csv(target / f"{model}_in.csv", {name: values[::INPUT_ROWS] for name, values in inputs.items()})
    results = simulated(fmu, target / f"{model}_in.csv")
    _write_csv(target / f"{model}_ref.csv", results)
    experiment = fmu.description.defaultExperiment
    settings = {
        "StartTime": experiment.startTime,
        "StopTime": experiment.stopTime,
        "StepSize": experiment.stepSize,
        "RelTol": experiment.tolerance,
    }
    options = "".join(f"{name}, {value}\n" for name, value in settings.items())
    (target / f"{model}_ref.opt").write_text(options, encoding="utf-8", newline="\n")
    (target / "fmi-ls-manifest.xml").write_bytes(_manifest(model))


def _manifest(model: str) -> bytes:
    root = etree.Element("fmiReferences", nsmap={"fmi-ls": NAMESPACE})
    root.set(f"{{{NAMESPACE}}}fmi-ls-name", "org.fmi-standard.fmi-ls-ref")
    root.set(f"{{{NAMESPACE}}}fmi-ls-version", "1.0.0-alpha.1")
    description = "Layered Standard providing information on related files included in an FMU."
    root.set(f"{{{NAMESPACE}}}fmi-ls-description", description)
    for suffix, (type_, role, text) in RELATED.items():
        etree.SubElement(root, "Related", type=type_, source=f"{model}_{suffix}", role=role, description=text)
    return etree.tostring(root, xml_declaration=True, encoding="UTF-8", pretty_print=True)


def simulated(fmu: Fmu, inputs: Path) -> dict[str, np.ndarray]:
    """Outputs by name at the times of the results, with inputs from a file."""
    experiment = fmu.description.defaultExperiment
    result = simulate_fmu(
        str(fmu.directory),
        fmi_type="CoSimulation",
        input=np.genfromtxt(inputs, delimiter=",", names=True),
        output=fmu.names("output"),
        stop_time=float(experiment.stopTime),
        output_interval=float(experiment.stepSize),
        relative_tolerance=float(experiment.tolerance),
    )
    return {name: np.asarray(result[name][::RESULT_ROWS], dtype=float) for name in result.dtype.names}


def _write_csv(path: Path, columns: dict[str, np.ndarray]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([[f"{value:.9g}" for value in row] for row in zip(*columns.values(), strict=True)])
