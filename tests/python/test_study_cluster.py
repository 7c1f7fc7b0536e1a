"""Studies on a cluster: nothing is lost, nothing is made twice, nothing is told to the network."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pandas as pd
import psutil
import pytest
from dask.distributed import Client
from rps3_study import cluster
from rps3_study.__main__ import main
from rps3_study.fmu import Fmu
from rps3_study.records import RunDirectory
from rps3_study.study import CRASHED, FINISHED, Record, Study, execute

STUDY = Study(samples=3, modes=(2, 4))


@pytest.fixture(scope="module")
def started() -> Iterator[Client]:
    with cluster.local(workers=2) as client:
        yield client


@pytest.fixture
def client(started: Client) -> Client:
    """A cluster of two workers, even if the last test killed them."""
    started.wait_for_workers(2, timeout=120)
    return started


@pytest.fixture
def archives(dist: Path) -> cluster.Archives:
    return cluster.Archives.of(dist / "Rps3Plant.fmu", dist / "Rps3Controller.fmu")


def timeless(record: Record) -> Record:
    return {name: value for name, value in record.items() if name != "seconds"}


def records(directory: RunDirectory) -> list[Record]:
    return [timeless(record) for record in directory.records()]


def test_killed_worker_loses_no_run(
    client: Client, archives: cluster.Archives, plant: Fmu, controller: Fmu, tmp_path: Path
) -> None:
    victims = [next(iter(client.run(os.getpid).values()))]

    def kill_one(_: Record) -> None:
        if victims:
            os.kill(victims.pop(), signal.SIGKILL)

    with RunDirectory.create(tmp_path, STUDY, archives.digest) as directory:
        cluster.run(client, archives, directory, kill_one)
        assert not victims
        # a run is a function of the study and its index: those made again, on another worker, are no different
        expected = [timeless(execute(plant, controller, STUDY, index)) for index in range(STUDY.size)]
        assert records(directory) == expected


def test_stopped_study_goes_on_where_it_was(client: Client, archives: cluster.Archives, tmp_path: Path) -> None:
    class StoppedError(Exception):
        pass

    def stop(_: Record) -> None:
        raise StoppedError

    with RunDirectory.create(tmp_path, STUDY, archives.digest) as directory:
        with pytest.raises(StoppedError):
            cluster.run(client, archives, directory, stop)
        (first,) = directory.records()
    made: list[Record] = []
    with RunDirectory.create(tmp_path, STUDY, archives.digest) as directory:
        cluster.run(client, archives, directory, made.append)
        assert directory.finished() == set(range(STUDY.size))
        assert {record["run"] for record in made} == directory.finished() - {first["run"]}
        cluster.run(client, archives, directory, lambda record: pytest.fail(f"made {record} again"))


def test_run_whose_process_dies_each_time_is_recorded_with_its_seed_and_reason(
    client: Client, archives: cluster.Archives, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = Study(samples=2, modes=(2,))
    finished = {"run": 0, "status": FINISHED}
    # the last of the runs takes its process down
    monkeypatch.setattr(cluster, "_run", lambda _, __, index: os.abort() if index == 1 else finished)
    with RunDirectory.create(tmp_path, study, archives.digest) as directory:
        cluster.run(client, archives, directory, lambda _: None)
        crashed = directory.records()[1]
        assert crashed["status"] == CRASHED
        assert "KilledWorker" in crashed["reason"]
        assert crashed["seed"] == study.robot(1).seed
        assert directory.forget_crashes() == 1
        assert directory.finished() == {0}


def test_worker_that_is_gone_for_good_is_replaced(client: Client) -> None:
    before = set(client.nthreads())
    client.retire_workers([min(before)])
    client.wait_for_workers(2, timeout=120)
    assert len(set(client.nthreads()) - before) == 1


def test_fmus_are_extracted_once_a_worker(client: Client, archives: cluster.Archives, tmp_path: Path) -> None:
    def directories(dask_worker: object) -> list[str]:
        return sorted(str(fmu.directory) for fmu in dask_worker.plugins[archives.name].fmus)

    client.register_plugin(archives)
    by_worker = client.run(directories)
    client.unregister_worker_plugin(archives.name)
    everywhere = [path for paths in by_worker.values() for path in paths]
    assert len(set(everywhere)) == 2 * len(by_worker) == 4
    assert not any(Path(path).exists() for path in everywhere)


def test_local_cluster_listens_on_this_machine_alone(client: Client) -> None:
    processes = [psutil.Process(), *psutil.Process().children(recursive=True)]
    listening = [
        connection.laddr.ip
        for process in processes
        for connection in process.net_connections(kind="inet")
        if connection.status == psutil.CONN_LISTEN
    ]
    assert listening and set(listening) == {"127.0.0.1"}


def test_command_line_uses_an_existing_cluster_and_refuses_another_study(
    client: Client, dist: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["--out", str(tmp_path), "--dist", str(dist), "--cluster", client.scheduler.address]
    main([*command, "--nominal", "--modes", "2", "--vary", "controller.k_p=400,900"])
    assert "2 of 2 runs" in capsys.readouterr().out
    assert {path.name for path in tmp_path.iterdir()} >= {"runs.parquet", "summary.md", "sweep.svg"}
    with pytest.raises(SystemExit):
        main([*command, "--nominal", "--modes", "2", "--vary", "controller.k_p=400,800"])
    assert "axes differ" in capsys.readouterr().err


def test_records_survive_the_parquet_file(client: Client, archives: cluster.Archives, tmp_path: Path) -> None:
    with RunDirectory.create(tmp_path, Study(samples=1, modes=(2,)), archives.digest) as directory:
        cluster.run(client, archives, directory, lambda _: None)
        (written,) = pd.read_parquet(directory.export()).to_dict("records")
        (kept,) = directory.records()
        assert written["status"] == FINISHED
        assert all(written[name] == value for name, value in kept.items() if value is not None)
