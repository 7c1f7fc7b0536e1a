"""The table of ratios, and the blocks of the documents that it fills."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path


@dataclass(frozen=True)
class Row:
    """Two durations that were measured in one run."""

    section: str
    what: str
    """What took `seconds`."""
    seconds: float
    against: str
    """What took `other` seconds."""
    other: float
    note: str = ""

    @property
    def ratio(self) -> float:
        """How many times as long the other takes."""
        return self.other / self.seconds


@dataclass(frozen=True)
class Listing:
    """A table of its own, for what is no ratio."""

    name: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]

    def markdown(self) -> str:
        return markdown(self.head, self.rows)


def duration(seconds: float) -> str:
    """A duration with three digits and a unit."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)):
        if seconds >= size or unit == "ns":
            return f"{seconds / size:.3g} {unit}"
    raise AssertionError


def factor(ratio: float) -> str:
    return f"{ratio:.0f}" if ratio >= 100 else f"{ratio:.2g}"


def markdown(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table, the first column to the left, numbers to the right."""
    rule = ["---"] * len(head)
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, rule, *rows]) + "\n"


def ratios(rows: Sequence[Row]) -> str:
    """The one table of ratios."""
    head = ["", "a", "b", "a takes", "b takes", "b / a", ""]
    cells = [
        [r.section, r.what, r.against, duration(r.seconds), duration(r.other), factor(r.ratio), r.note] for r in rows
    ]
    return markdown(head, cells)


def write(directory: Path, rows: Sequence[Row], listings: Sequence[Listing], data: dict[str, object]) -> None:
    """Writes ratios.md, a Markdown file a listing, and all as JSON."""
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "ratios.md").write_text(ratios(rows), encoding="utf-8")
    for listing in listings:
        (directory / f"{listing.name}.md").write_text(listing.markdown(), encoding="utf-8")
    everything = {"ratios": [{**asdict(row), "ratio": row.ratio} for row in rows], **data}
    (directory / "bench.json").write_text(json.dumps(everything, indent=1) + "\n", encoding="utf-8")


def fill(pages: Sequence[Path], blocks: dict[str, str]) -> None:
    """Replaces what stands between `<!-- bench:NAME -->` and `<!-- bench -->`, in one of the documents each."""
    texts = {page: page.read_text(encoding="utf-8") for page in pages}
    for name, block in blocks.items():
        pattern = rf"(<!-- bench:{re.escape(name)} -->\n).*?(<!-- bench -->)"
        found = 0
        for page, text in texts.items():
            texts[page], count = re.subn(pattern, lambda m, b=block: f"{m[1]}\n{b}\n{m[2]}", text, flags=re.DOTALL)
            found += count
        if found != 1:
            raise ValueError(f"{found} blocks bench:{name} in {', '.join(page.name for page in pages)}")
    for page, text in texts.items():
        page.write_text(text, encoding="utf-8")
