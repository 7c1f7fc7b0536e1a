"""The study with the packaged FMUs: `python -m rps3_study.demo`."""

from __future__ import annotations

import argparse
from pathlib import Path

from tqdm import tqdm

from rps3_study import report
from rps3_study.couple import run_crossing
from rps3_study.fmu import extracted
from rps3_study.geometry import Geometry
from rps3_study.tasks import MODES, VARIANTS, supported_modes, tasks


def main(arguments: list[str] | None = None) -> None:
    """Runs all modes, variants and tasks and writes the report."""
    parser = argparse.ArgumentParser(prog="rps3_study.demo", description=__doc__)
    parser.add_argument("--dist", type=Path, default=Path("dist"), help="directory that holds the FMUs")
    parser.add_argument("--out", type=Path, help="directory of the report; default: DIST/report")
    parser.add_argument("--tasks", nargs="+", metavar="TASK", help="keys of the tasks to run; default: all")
    parser.add_argument("--modes", nargs="+", type=int, choices=list(MODES), help="control modes; default: all")
    options = parser.parse_args(arguments)
    archives = [options.dist / "Rps3Plant.fmu", options.dist / "Rps3Controller.fmu"]
    with extracted(*archives) as (plant, controller):
        modes = {mode: name for mode, name in supported_modes(controller).items() if mode in (options.modes or MODES)}
        chosen = [task for task in tasks(controller) if options.tasks is None or task.key in options.tasks]
        if not chosen:
            parser.error(f"no such task; there are {', '.join(task.key for task in tasks(controller))}")
        duration = float(plant.description.defaultExperiment.stopTime)
        cases = []
        with tqdm(total=round(duration * len(chosen) * len(VARIANTS) * len(modes), 6), unit="s simulated") as bar:
            for task in chosen:
                for variant, revolute_motors in VARIANTS.items():
                    runs = {}
                    for mode, name in modes.items():
                        bar.set_description(f"{task.key}, {variant}, {name}")
                        done = bar.n
                        runs[name] = run_crossing(
                            plant,
                            controller,
                            {"revolute_motors": revolute_motors},
                            {"revolute_motors": revolute_motors, "control_mode": mode, **task.parameters},
                            stop_time=duration,
                            disturbance=task.disturbance,
                            progress=lambda t, done=done: bar.update(done + t - bar.n),
                        )
                        bar.update(done + duration - bar.n)
                    cases.append(report.Case(task, variant, runs))
        geometry = Geometry.of(plant)
    out = options.out or options.dist / "report"
    index = report.write(out, cases, geometry)
    for case in cases:
        print(
            f"\n{case.task.title}, {case.variant}\n{report.markdown_table(*report.table(case, geometry.joint_radius))}"
        )
    print(f"\n{index}")


if __name__ == "__main__":
    main()
