"""The README's Python example runs as it stands."""

import re
from pathlib import Path

import pytest
from conftest import ROOT


def test_python_example_steps_both_fmus(dist: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    assert blocks
    monkeypatch.chdir(dist.parent)
    for block in blocks:
        exec(compile(block, "README.md", "exec"), {})
