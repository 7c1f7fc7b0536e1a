"""Writes documentation and reference results of both FMUs: `python -m rps3_study.fmu_documentation`."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from rps3_study.couple import run_crossing
from rps3_study.fmu import extracted
from rps3_study.fmu_documentation import icon, page, reference_results, reference_run
from rps3_study.fmu_documentation.licenses import Crate
from rps3_study.geometry import Geometry


def main() -> None:
    """Runs the default experiment with both FMUs and writes what is to be added to their archives."""
    parser = argparse.ArgumentParser(prog="rps3_study.fmu_documentation", description=__doc__)
    parser.add_argument("--fmus", type=Path, required=True, help="directory of both FMUs, still without documentation")
    parser.add_argument("--crates", type=Path, required=True, help="JSON: the linked crates with their license files")
    parser.add_argument("--frames", type=Path, required=True, help="SVG of the mechanism's frames and signs")
    parser.add_argument("--out", type=Path, required=True, help="directory to write OUT/<model identifier>/ into")
    options = parser.parse_args()
    crates = [Crate(**entry) for entry in json.loads(options.crates.read_text(encoding="utf-8"))]
    frames = options.frames.read_text(encoding="utf-8")
    with extracted(*(options.fmus / f"{name}.fmu" for name in ("Rps3Plant", "Rps3Controller"))) as (plant, controller):
        run = run_crossing(plant, controller)
        if run.failure is not None:
            raise SystemExit(f"the reference run ended early: {run.failure}")
        geometry = Geometry.of(plant)
        for fmu in (plant, controller):
            directory = options.out / fmu.description.modelName
            (directory / "documentation").mkdir(parents=True, exist_ok=True)
            index = page.render(fmu, frames, reference_run.drawn(fmu, run, geometry), crates)
            (directory / "documentation" / "index.html").write_text(index, encoding="utf-8", newline="\n")
            reference_results.write(fmu, run, directory)
            icon.draw(directory / "model.png", run, geometry, closed_loop=fmu is controller)


if __name__ == "__main__":
    main()
