"""Licenses of what is linked into the FMUs."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Crate:
    """A crate that is linked."""

    name: str
    version: str
    license: str
    """SPDX expression."""
    files: Sequence[str]
    """Its license files, relative to `documentation/`."""


def table(crates: Sequence[Crate]) -> str:
    """All crates with links to their license texts, in HTML."""
    rows = "\n".join(
        f"<tr><td>{html.escape(crate.name)}</td><td>{html.escape(crate.version)}</td><td>{html.escape(crate.license)}</td>"
        f"<td>{', '.join(_link(file) for file in crate.files)}</td></tr>"
        for crate in crates
    )
    head = "<tr><th>crate</th><th>version</th><th>license</th><th>texts</th></tr>"
    return f"<table><thead>{head}</thead><tbody>\n{rows}\n</tbody></table>"


def _link(file: str) -> str:
    return f'<a href="{html.escape(file)}">{html.escape(file.rsplit("/", 1)[-1])}</a>'
