"""Runs a study on Dask: on this machine's cores, or on a cluster that is there already."""

from __future__ import annotations

import hashlib
import itertools
import logging
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from dask.distributed import Client, LocalCluster, Worker, WorkerPlugin, as_completed, get_worker

from rps3_study.fmu import Fmu
from rps3_study.records import RunDirectory
from rps3_study.study import Record, Study, execute, record_of_crash

RUNS_AHEAD = 4
"""Runs handed out per thread: enough that no worker waits, few enough that little is made twice."""


class Archives(WorkerPlugin):
    """Brings both FMUs to each worker and extracts them there once.

    The archives travel as bytes, so workers need not see the client's files.
    """

    def __init__(self, archives: dict[str, bytes]) -> None:
        """Takes plant and controller, in this order, by file name."""
        self._archives = archives
        self.digest = hashlib.sha256(b"".join(archives.values())).hexdigest()
        self.name = f"rps3-{self.digest[:16]}"

    @classmethod
    def of(cls, *paths: Path) -> Archives:
        """From the archives' files."""
        return cls({path.name: path.read_bytes() for path in paths})

    def setup(self, worker: Worker) -> None:
        """Extracts the FMUs into the worker's directory, which goes with the worker."""
        self._directory = Path(worker.local_directory) / self.name
        self.fmus = []
        for name, contents in self._archives.items():
            self._directory.mkdir(parents=True, exist_ok=True)
            archive = self._directory / name
            archive.write_bytes(contents)
            self.fmus.append(Fmu.extract(archive, archive.with_suffix("")))

    def teardown(self, worker: Worker) -> None:
        """Deletes what `setup` wrote."""
        shutil.rmtree(self._directory, ignore_errors=True)


@contextmanager
def local(workers: int | None = None) -> Iterator[Client]:
    """Worker processes on this machine, one thread each, in reach of this machine alone."""
    with (
        LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
            # a worker that dies is replaced and its runs are made again: nothing to alarm anyone
            silence_logs=logging.CRITICAL,
        ) as cluster,
        Client(cluster) as client,
    ):
        # a worker that dies while it starts takes its nanny along; this replaces both
        count = len(cluster.workers)
        cluster.adapt(minimum=count, maximum=count)
        yield client


def _run(plugin: str, study: Study, index: int) -> Record:
    plant, controller = get_worker().plugins[plugin].fmus
    return execute(plant, controller, study, index)


def run(client: Client, archives: Archives, directory: RunDirectory, progress: Callable[[Record], object]) -> None:
    """Makes all runs that the directory has no record of.

    A run whose worker dies is made again elsewhere; one that keeps killing workers is recorded as crashed.

    Args:
        client: of the cluster.
        archives: both FMUs.
        directory: takes the records, in the order in which runs end.
        progress: called with each record once it is kept.
    """
    study = directory.study
    finished = directory.finished()
    pending = (index for index in range(study.size) if index not in finished)
    client.wait_for_workers(1)
    client.register_plugin(archives)
    try:
        indices: dict[str, int] = {}

        def submit(index: int) -> object:
            future = client.submit(_run, archives.name, study, index, pure=False)
            indices[future.key] = index
            return future

        threads = sum(client.nthreads().values())
        running = as_completed([submit(index) for index in itertools.islice(pending, RUNS_AHEAD * threads)])
        for future in running:
            index = indices.pop(future.key)
            error = future.exception()
            record = future.result() if error is None else record_of_crash(study, index, error)
            directory.add(record)
            progress(record)
            for following in itertools.islice(pending, 1):
                running.add(submit(following))
    finally:
        client.unregister_worker_plugin(archives.name)
