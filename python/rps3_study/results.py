"""All figures of the demo as plain numbers: `results.json`, from which the tables of the documents are made."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

from rps3_study.comparison import Comparison, Fixed
from rps3_study.metrics import Figures
from rps3_study.singularity import Passage

Case = tuple[str, str]
"""Key of a task, and variant."""


@dataclass
class Results:
    """Figures by case, those of single schemes by their names as well."""

    figures: dict[Case, dict[str, Figures]] = field(default_factory=dict)
    """Of the control modes."""
    passages: dict[Case, dict[str, Passage]] = field(default_factory=dict)
    """Of the control modes."""
    baselines: dict[Case, dict[str, Figures]] = field(default_factory=dict)
    comparisons: dict[Case, Comparison] = field(default_factory=dict)

    def write(self, path: Path) -> None:
        """Writes everything as JSON."""
        sections = {
            name: [
                {"task": task, "variant": variant, **_plain(value)}
                for (task, variant), value in getattr(self, name).items()
            ]
            for name in ("figures", "passages", "baselines", "comparisons")
        }
        path.write_text(json.dumps(sections, indent=1) + "\n", encoding="utf-8")

    @classmethod
    def read(cls, path: Path) -> Self:
        """What `write` wrote."""
        sections = json.loads(path.read_text(encoding="utf-8"))
        return cls(
            figures=_by_scheme(sections["figures"], Figures),
            passages=_by_scheme(sections["passages"], Passage),
            baselines=_by_scheme(sections["baselines"], Figures),
            comparisons={_case(row): _record(row, Comparison) for row in sections["comparisons"]},
        )


def _plain(value: Any) -> dict[str, Any]:
    if dataclasses.is_dataclass(value):
        return {name: _number(number) for name, number in dataclasses.asdict(value).items()}
    return {"schemes": {name: _plain(record) for name, record in value.items()}}


def _number(value: Any) -> Any:
    """JSON has no NaN."""
    return None if isinstance(value, float) and math.isnan(value) else value


def _by_scheme(rows: Iterable[dict[str, Any]], kind: type) -> dict[Case, dict[str, Any]]:
    return {_case(row): {name: _record(record, kind) for name, record in row["schemes"].items()} for row in rows}


def _case(row: dict[str, Any]) -> Case:
    return row.pop("task"), row.pop("variant")


def _record(values: dict[str, Any], kind: type) -> Any:
    number = {f.name for f in dataclasses.fields(kind) if f.type == "float"}
    return kind(**{name: _value(value, name in number) for name, value in values.items()})


def _value(value: Any, number: bool) -> Any:
    if value is None and number:
        return math.nan
    if isinstance(value, list):
        return tuple(value)
    return _record(value, Fixed) if isinstance(value, dict) else value
