"""The directory of a study: what it is, and one record for each run that is over."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path
from typing import Any, Self

import pandas as pd

from rps3_study.study import CRASHED, Record, Study


class OtherStudyError(Exception):
    """The directory holds runs of another study or of other FMUs."""


class RunDirectory:
    """Records in SQLite, a transaction each: whatever stops the study leaves all finished runs behind."""

    def __init__(self, directory: Path, study: Study, fmus: str) -> None:
        """Opens an existing directory.

        Args:
            directory: an existing directory.
            study: the study it belongs to.
            fmus: identifies the FMUs.
        """
        self.directory, self.study, self.fmus = directory, study, fmus
        self._connection = sqlite3.connect(directory / "runs.sqlite", isolation_level=None)
        self._connection.execute("CREATE TABLE IF NOT EXISTS runs (run INTEGER PRIMARY KEY, record TEXT NOT NULL)")

    @classmethod
    def create(cls, directory: Path, study: Study, fmus: str) -> Self:
        """Starts a directory, or continues one of the same study; the number of robots may have grown.

        Raises:
            OtherStudyError: when the directory's runs would not fit to those to come.
        """
        directory.mkdir(parents=True, exist_ok=True)
        manifest = directory / "study.json"
        wanted = {"study": study.as_json(), "fmus": fmus}
        if manifest.exists():
            present = json.loads(manifest.read_text(encoding="utf-8"))
            differing = _differences(present, json.loads(json.dumps(wanted)))
            if differing:
                raise OtherStudyError(f"{directory} holds another study: {', '.join(differing)} differ")
        manifest.write_text(json.dumps(wanted, indent=2) + "\n", encoding="utf-8")
        return cls(directory, study, fmus)

    @classmethod
    def open(cls, directory: Path) -> Self:
        """Opens a directory as it is.

        Raises:
            FileNotFoundError: when it holds no study.
        """
        present = json.loads((directory / "study.json").read_text(encoding="utf-8"))
        return cls(directory, Study.from_json(present["study"]), present["fmus"])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._connection.close()

    def add(self, record: Record) -> None:
        """Records a run; it is on the disk when this returns."""
        row = (record["run"], json.dumps(record))
        self._connection.execute("INSERT OR REPLACE INTO runs VALUES (?, ?)", row)

    def finished(self) -> set[int]:
        """Indices of the runs that are over, well or badly."""
        return {run for (run,) in self._connection.execute("SELECT run FROM runs")}

    def forget_crashes(self) -> int:
        """Deletes the records of crashed runs, so that they are made again; returns how many."""
        crashed = [r["run"] for r in self.records() if r["status"] == CRASHED]
        self._connection.executemany("DELETE FROM runs WHERE run = ?", [(run,) for run in crashed])
        return len(crashed)

    def table(self) -> pd.DataFrame:
        """All records by run."""
        columns = [*self.study.labels(0), "status", "reason", "end_stop", "peak_error"]
        records = self.records()
        return pd.DataFrame(records, columns=None if records else columns).reindex(
            columns=list(dict.fromkeys([*columns, *(key for record in records for key in record)]))
        )

    def export(self) -> Path:
        """Writes all records to `runs.parquet`."""
        path = self.directory / "runs.parquet"
        self.table().to_parquet(path, engine="pyarrow", index=False)
        return path

    def records(self) -> list[Record]:
        """All records, by run."""
        rows = self._connection.execute("SELECT record FROM runs ORDER BY run")
        return [json.loads(text) for (text,) in rows]


def _differences(present: dict[str, Any], wanted: dict[str, Any]) -> list[str]:
    names = [
        name
        for name in sorted(present["study"].keys() | wanted["study"].keys())
        if name != "samples" and present["study"].get(name) != wanted["study"].get(name)
    ]
    return names if present["fmus"] == wanted["fmus"] else [*names, "the FMUs"]
