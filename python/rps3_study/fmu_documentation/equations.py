"""Equations in MathML, which browsers draw without any library."""

from __future__ import annotations

import re

from latex2mathml.converter import convert


def rendered(text: str) -> str:
    r"""HTML with the LaTeX between \( and \) and between \[ and \] replaced by MathML."""
    text = re.sub(r"\\\[(.*?)\\\]", lambda match: convert(_line(match[1]), display="block"), text, flags=re.DOTALL)
    return re.sub(r"\\\((.*?)\\\)", lambda match: convert(_line(match[1])), text, flags=re.DOTALL)


def _line(latex: str) -> str:
    return " ".join(latex.split())
