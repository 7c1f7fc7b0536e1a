"""Studies of many runs: `python -m rps3_study`.

Without options this is the robustness study: random robots whose masses, friction and geometry are up to 20 % off what
the controller believes, with imperfect sensors, through the singularity in every control mode. `--vary` adds a grid of
parameters, `--nominal` leaves the grid alone. A study that was stopped goes on where it was.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from dask.distributed import Client
from tqdm import tqdm

from rps3_study import cluster, summary
from rps3_study.fmu import extracted
from rps3_study.records import OtherStudyError, RunDirectory
from rps3_study.study import Study
from rps3_study.sweep import Axis
from rps3_study.tasks import MODES, VARIANTS, tasks

DEFAULT = Study()


def parser() -> argparse.ArgumentParser:
    """The command line."""
    result = argparse.ArgumentParser(
        prog="python -m rps3_study", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = result.add_argument
    add("--out", type=Path, default=Path("studies/robustness"), help="directory of the study; default: %(default)s")
    add("--summary", action="store_true", help="make no runs; summarize those that are there")
    add("--bound", type=float, default=summary.BOUND, help="largest error of a success, mm; default: %(default)s")
    study = result.add_argument_group("the study")
    add = study.add_argument
    add("--samples", type=int, default=DEFAULT.samples, help="random robots; default: %(default)s")
    add("--spread", type=float, default=DEFAULT.spread, help="largest relative deviation; default: %(default)s")
    add("--sensors", type=float, default=DEFAULT.sensors, help="largest sensor_scale; default: %(default)s")
    add("--nominal", action="store_true", help="one robot as the controller believes it, with ideal sensors")
    add("--seed", type=int, default=DEFAULT.seed, help="seed of all random figures; default: %(default)s")
    add("--modes", type=int, nargs="+", choices=list(MODES), default=list(DEFAULT.modes), help="default: all")
    add("--motors", choices=[name.split()[0] for name in VARIANTS], default="six", help="default: %(default)s")
    add("--task", default=DEFAULT.task, help="key of a task; default: %(default)s")
    vary = (
        "values of a parameter, as name=v,v,... or name=first:last:count; name is plant.X, controller.X or X for both"
    )
    add("--vary", action="append", default=[], metavar="NAME=VALUES", help=vary)
    place = result.add_argument_group("where it runs")
    add = place.add_argument
    add("--dist", type=Path, default=Path("dist"), help="directory that holds the FMUs; default: %(default)s")
    add("--workers", type=int, help="processes on this machine; default: one a core")
    add("--cluster", metavar="ADDRESS", help="scheduler of an existing Dask cluster, e.g. tcp://127.0.0.1:8786")
    add("--retry", action="store_true", help="make crashed runs again")
    return result


def study_of(options: argparse.Namespace) -> Study:
    """The study that the options describe."""
    nominal = {"samples": 1, "spread": 0.0, "sensors": 0.0} if options.nominal else {}
    return Study(
        **{"samples": options.samples, "spread": options.spread, "sensors": options.sensors, **nominal},
        seed=options.seed,
        modes=tuple(options.modes),
        revolute_motors=VARIANTS[f"{options.motors} motors"],
        task=options.task,
        axes=tuple(Axis.parse(text) for text in options.vary),
    )


@contextmanager
def connected(options: argparse.Namespace) -> Iterator[Client]:
    """A client of the cluster that the options ask for."""
    with Client(options.cluster) if options.cluster else cluster.local(options.workers) as client:
        yield client


def make_runs(options: argparse.Namespace, study: Study) -> None:
    """Makes all runs of the study that are not yet recorded."""
    paths = [options.dist / f"{name}.fmu" for name in ("Rps3Plant", "Rps3Controller")]
    with extracted(*paths) as (plant, controller):
        for axis in study.axes:
            axis.check(plant, controller)
        keys = [task.key for task in tasks(controller)]
        if study.task not in keys:
            raise ValueError(f"there is no task {study.task}, only {', '.join(keys)}")
    archives = cluster.Archives.of(*paths)
    with RunDirectory.create(options.out, study, archives.digest) as directory:
        if options.retry:
            directory.forget_crashes()
        done = len(directory.finished())
        with connected(options) as client, tqdm(total=study.size, initial=done, unit="run") as bar:
            cluster.run(client, archives, directory, lambda _: bar.update())


def main(arguments: list[str] | None = None) -> None:
    """Makes the runs and summarizes all there are."""
    commands = parser()
    options = commands.parse_args(arguments)
    try:
        if not options.summary:
            make_runs(options, study_of(options))
        with RunDirectory.open(options.out) as directory:
            directory.export()
            text = summary.write(directory, options.bound)
    except (ValueError, FileNotFoundError, OtherStudyError) as error:
        commands.error(str(error))
    except KeyboardInterrupt:
        raise SystemExit(f"\nstopped; the same command goes on with {options.out}") from None
    print(f"\n{text}\n{options.out / 'summary.md'}")


if __name__ == "__main__":
    main()
