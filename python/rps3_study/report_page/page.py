"""Puts the page together."""

from __future__ import annotations

import html
import json
from collections.abc import Sequence
from importlib import resources
from string import Template
from typing import TYPE_CHECKING

from rps3_study.data_url import data_url
from rps3_study.geometry import Geometry
from rps3_study.report_page import libraries
from rps3_study.report_page.data import payload

if TYPE_CHECKING:
    from rps3_study.report import Case

_MODULES = ("data", "limbs", "mechanism", "animation", "plots", "clock", "main")


def render(cases: Sequence[Case], geometry: Geometry, introduction: str, tables: Sequence[str]) -> str:
    """The page with all its libraries and data.

    Args:
        cases: runs to show.
        geometry: of the plant in all of them.
        introduction: a paragraph, plain text.
        tables: HTML, one for each case.
    """
    three, plotly = libraries.three(), libraries.plotly()
    modules = {"three": three.code} | {f"rps3/{name}": _asset(f"{name}.js") for name in _MODULES}
    imports = {name: data_url("text/javascript", code) for name, code in modules.items()}
    notices = [f"{lib.name} {lib.version}: {lib.license} (From the package {lib.source}.)" for lib in (three, plotly)]
    return Template(_asset("page.html")).substitute(
        style=_asset("page.css"),
        introduction=html.escape(introduction),
        tables="\n".join(tables),
        notices="\n".join(f"<li>{html.escape(notice)}</li>" for notice in notices),
        license=html.escape(libraries.MIT_LICENSE),
        plotly=_script(plotly.code),
        imports=_script(json.dumps({"imports": imports})),
        data=_script(json.dumps(payload(cases, geometry), allow_nan=False, separators=(",", ":"))),
    )


def _asset(name: str) -> str:
    return resources.files(__package__).joinpath("assets", name).read_text(encoding="utf-8")


def _script(text: str) -> str:
    """Text that may stand in a script element."""
    if "</script" in text.lower():
        raise ValueError("a script would end before its end")
    return text
