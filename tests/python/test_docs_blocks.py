"""The code in the documents works: Python runs, commands exist, links lead somewhere."""

import contextlib
import importlib.util
import re
import shlex
from pathlib import Path
from typing import NamedTuple

import pytest
from conftest import ROOT
from rps3_study.__main__ import parser, study_of

DOCUMENTS = [*sorted((ROOT / "docs").glob("*.md")), ROOT / "README.md", ROOT / "CONTRIBUTING.md"]
# formulas and output are not code
LANGUAGES = {"python", "sh", "math", "text"}


class Block(NamedTuple):
    language: str
    text: str


def blocks(document: Path) -> list[Block]:
    fenced = re.findall(r"^```([^\n]*)\n(.*?)^```$", document.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    return [Block(*block) for block in fenced]


def with_blocks(language: str) -> list[Path]:
    return [document for document in DOCUMENTS if any(block.language == language for block in blocks(document))]


def commands(document: Path) -> list[list[str]]:
    lines = "".join(block.text for block in blocks(document) if block.language == "sh").replace("\\\n", " ")
    return [shlex.split(line, comments=True) for line in lines.splitlines() if shlex.split(line, comments=True)]


def name(document: Path) -> str:
    return document.relative_to(ROOT).as_posix()


@pytest.mark.parametrize("document", DOCUMENTS, ids=name)
def test_every_block_says_what_it_is(document: Path) -> None:
    assert {block.language for block in blocks(document)} <= LANGUAGES


@pytest.mark.parametrize("document", with_blocks("python"), ids=name)
def test_python_blocks_run_in_order(
    document: Path, dist: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "dist").symlink_to(dist.resolve(), target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    namespace: dict[str, object] = {"__name__": "__main__"}
    for block in blocks(document):
        if block.language == "python":
            exec(compile(block.text, name(document), "exec"), namespace)


def check_cargo(words: list[str]) -> None:
    if words[0] == "xtask":
        tasks = re.search(r"enum Task \{(.*?)\n\}", (ROOT / "xtask/src/main.rs").read_text(encoding="utf-8"), re.DOTALL)
        variants = re.findall(r"^    ([A-Z]\w*)", tasks[1], re.MULTILINE)
        assert words[1] in {re.sub(r"(?<!^)(?=[A-Z])", "-", variant).lower() for variant in variants}
    else:
        assert words[0] in {"add", "bench", "build", "doc", "run", "test"}


def check_python(words: list[str]) -> None:
    assert words[0] == "-m", words
    if words[1] == "rps3_study":
        # help ends the parser with success
        with contextlib.suppress(SystemExit) if "--help" in words else contextlib.nullcontext():
            study_of(parser().parse_args(words[2:]))
    else:
        assert importlib.util.find_spec(words[1])


CHECKS = {
    "cargo": check_cargo,
    "python": check_python,
    ".venv/bin/python": check_python,
    ".": lambda words: None if words == [".venv/bin/activate"] else pytest.fail(str(words)),
    "dask": lambda words: (
        None if importlib.util.find_spec(f"distributed.cli.dask_{words[0]}") else pytest.fail(words[0])
    ),
    "pip": lambda words: None if (ROOT / words[-1] / "pyproject.toml").exists() else pytest.fail(words[-1]),
}


@pytest.mark.parametrize("document", with_blocks("sh"), ids=name)
def test_commands_exist(document: Path) -> None:
    for program, *words in commands(document):
        assert program in CHECKS, f"{program} in {name(document)} is a program that this test does not know"
        CHECKS[program](words)


@pytest.mark.parametrize("document", DOCUMENTS, ids=name)
def test_links_between_documents_lead_somewhere(document: Path) -> None:
    targets = re.findall(r"\]\(([^)#\s]+)[^)]*\)", document.read_text(encoding="utf-8"))
    local = [target for target in targets if "://" not in target]
    assert [target for target in local if not (document.parent / target).exists()] == []
