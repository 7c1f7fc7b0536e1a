"""Puts `documentation/index.html` together."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from importlib import resources
from string import Template

from lxml import etree

from rps3_study.data_url import data_url
from rps3_study.fmu import Fmu
from rps3_study.fmu_documentation import equations, licenses, variables
from rps3_study.fmu_documentation.licenses import Crate


def render(fmu: Fmu, frames: str, plots: Mapping[str, str], crates: Sequence[Crate]) -> str:
    """The page.

    Args:
        fmu: what is documented.
        frames: SVG of frames and signs.
        plots: SVG by caption.
        crates: what is linked into the binaries.
    """
    description = fmu.description
    experiment = description.defaultExperiment
    figures = "\n".join(f"<figure>{_image(svg, caption)}</figure>" for caption, svg in plots.items())
    return Template(_asset("page.html")).substitute(
        name=description.modelName,
        style=_asset("page.css"),
        summary=html.escape(description.description),
        version=html.escape(description.version),
        guid=html.escape(description.guid),
        text=equations.rendered(_asset(f"{description.modelName}.html")),
        frames=_image(frames, "Frames and signs of the mechanism"),
        variables=variables.tables(description.modelName, description.modelVariables),
        capabilities=_capabilities(fmu),
        experiment=f"0 to {experiment.stopTime} s, step {experiment.stepSize} s, tolerance {experiment.tolerance}",
        plots=figures,
        licenses=licenses.table(crates),
    )


def _asset(name: str) -> str:
    return resources.files(__package__).joinpath("assets", name).read_text(encoding="utf-8")


def _image(svg: str, caption: str) -> str:
    """An image of its own, so that the identifiers in several SVGs cannot meet."""
    return f'<img src="{data_url("image/svg+xml", svg)}" alt="{html.escape(caption)}">'


def _capabilities(fmu: Fmu) -> str:
    """Attributes of both interfaces side by side, as the model description has them."""
    root = etree.parse(fmu.directory / "modelDescription.xml").getroot()
    both = [dict(root.find(interface).attrib) for interface in ("CoSimulation", "ModelExchange")]
    names = sorted(set().union(*both) - {"modelIdentifier"})
    rows = "\n".join(
        f"<tr><td><code>{name}</code></td>" + "".join(f"<td>{side.get(name, '')}</td>" for side in both) + "</tr>"
        for name in names
    )
    head = "<tr><th>capability</th><th>Co-Simulation</th><th>Model Exchange</th></tr>"
    return f"<table><thead>{head}</thead><tbody>\n{rows}\n</tbody></table>"
