"""The study with the packaged FMUs: `python -m rps3_study.demo`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from tqdm import tqdm

from rps3_study import baselines, comparison, report
from rps3_study.couple import Run
from rps3_study.fmu import Fmu, extracted
from rps3_study.geometry import Geometry
from rps3_study.limits import Limits
from rps3_study.metrics import figures
from rps3_study.results import Results
from rps3_study.singularity import passage
from rps3_study.tasks import MODES, VARIANTS, Task, run_task, supported_modes, tasks


def measure(
    plant: Fmu, controller: Fmu, chosen: Sequence[Task], modes: Sequence[int], compared: bool = True
) -> tuple[list[report.Case], Results]:
    """Runs tasks with both variants and takes all figures but the baselines'.

    Args:
        plant: the Rps3Plant FMU.
        controller: the Rps3Controller FMU.
        chosen: tasks.
        modes: control modes.
        compared: the tuned mode is compared with its luck and with hindsight as well.
    """
    geometry, limits = Geometry.of(plant), Limits.default(plant)
    radius = geometry.joint_radius
    also = [task for task in chosen if compared and task.key in comparison.COMPARED]
    total = len(chosen) * len(VARIANTS) * len(modes) + len(also) * sum(map(comparison.runs, VARIANTS))
    cases, results = [], Results()

    def peak_error(run: Run) -> float:
        return np.inf if run.failure else figures(run, radius).peak_error

    with tqdm(total=total, unit="run") as bar:
        for task in chosen:
            for variant in VARIANTS:

                def run(parameters: dict, task: Task = task, variant: str = variant) -> Run:
                    bar.set_description(f"{task.key}, {variant}")
                    bar.update()
                    return run_task(plant, controller, task, variant, parameters)

                key = task.key, variant
                runs = {MODES[mode]: run({"control_mode": mode}) for mode in modes}
                cases.append(report.Case(task, variant, runs))
                results.figures[key] = {mode: figures(one, radius, limits) for mode, one in runs.items()}
                results.passages[key] = {mode: passage(one, geometry) for mode, one in runs.items()}
                if task in also:
                    results.comparisons[key] = comparison.compare(variant, run, peak_error)
    return cases, results


def main(arguments: list[str] | None = None) -> None:
    """Runs all modes, variants and tasks and writes the report."""
    parser = argparse.ArgumentParser(prog="rps3_study.demo", description=__doc__)
    parser.add_argument("--dist", type=Path, default=Path("dist"), help="directory that holds the FMUs")
    parser.add_argument("--out", type=Path, help="directory of the report; default: DIST/report")
    parser.add_argument("--tasks", nargs="+", metavar="TASK", help="keys of the tasks to run; default: all")
    parser.add_argument("--modes", nargs="+", type=int, choices=list(MODES), help="control modes; default: all")
    parser.add_argument("--baselines", type=Path, help="figures that examples/baselines.rs printed")
    parser.add_argument("--convergence", type=Path, help="table that examples/convergence.rs printed")
    options = parser.parse_args(arguments)
    with extracted(options.dist / "Rps3Plant.fmu", options.dist / "Rps3Controller.fmu") as (plant, controller):
        chosen = [task for task in tasks(controller) if options.tasks is None or task.key in options.tasks]
        if not chosen:
            parser.error(f"no such task; there are {', '.join(task.key for task in tasks(controller))}")
        modes = [mode for mode in supported_modes(controller) if mode in (options.modes or MODES)]
        geometry = Geometry.of(plant)
        cases, results = measure(plant, controller, chosen, modes, compared=options.modes is None)
    if options.baselines is not None:
        keys = {task.key for task in chosen}
        found = baselines.only(baselines.read(options.baselines))
        results.baselines = {case: schemes for case, schemes in found.items() if case[0] in keys}
    out = options.out or options.dist / "report"
    index = report.write(out, cases, geometry, results, options.convergence)
    for case in cases:
        print(f"\n{case.title}\n{report.markdown_table(*report.table(case, results))}")
    print(f"\n{index}")


if __name__ == "__main__":
    main()
