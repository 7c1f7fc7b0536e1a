"""JavaScript libraries of the page, out of the Python packages that ship them.

The packages are installed for these files alone, without their dependencies (`vendored.txt`), and never imported.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from importlib import metadata


@dataclass(frozen=True)
class Library:
    """A library as it goes into the page."""

    name: str
    version: str
    license: str
    """What its authors ask to be kept."""
    source: str
    """The Python package that ships it, with its version."""
    code: str


def plotly() -> Library:
    """Plotly, a classic script that defines `Plotly`."""
    code, source = _read("plotly", "plotly/package_data/plotly.min.js")
    notice = re.search(r"plotly\.js v([\d.]+)\n\* (Copyright[^\n]*)", code)
    if notice is None:
        raise LookupError("plotly.min.js does not begin with its version and copyright")
    return Library("Plotly.js", notice[1], f"{notice[2]} MIT license.", source, code)


def three() -> Library:
    """three.js with its controls, an ES module that exports `THREE` and `OrbitControls`."""
    code, source = _read("nicegui", "nicegui/elements/scene/dist/index.js")
    notice = re.search(r"(Copyright [^\n]*Three\.js Authors)", code)
    revision = re.search(r'^ \*/\s*const \w+="(\d+)"', code, re.MULTILINE)
    if notice is None or revision is None:
        raise LookupError("NiceGUI's 3D scene does not begin with three.js's copyright and revision")
    tween = "tween.js (Copyright 2010-2012 Tween.js authors, MIT license)"
    bundle = f"Bundled with {tween} by NiceGUI (Copyright 2021 Zauberzeug GmbH, MIT license)"
    license = f"{notice[1]}. MIT license. {bundle}."
    return Library("three.js", f"r{revision[1]}", license, source, code)


def _read(package: str, path: str) -> tuple[str, str]:
    distribution = metadata.distribution(package)
    file = distribution.locate_file(path)
    return file.read_text(encoding="utf-8"), f"{package} {distribution.version}"


MIT_LICENSE = """\
Permission is hereby granted, free of charge, to any person obtaining a copy of this software and associated
documentation files (the "Software"), to deal in the Software without restriction, including without limitation the
rights to use, copy, modify, merge, publish, distribute, sublicense, and/or sell copies of the Software, and to
permit persons to whom the Software is furnished to do so, subject to the following conditions: The above copyright
notice and this permission notice shall be included in all copies or substantial portions of the Software. THE
SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT LIMITED TO THE
WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS
OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR
OTHERWISE, ARISING FROM, OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE.
"""
