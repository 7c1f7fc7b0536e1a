"""The FAQ quotes every message that the FMUs can log, as the sources have it."""

import re

from conftest import ROOT

SOURCES = ["src/fmi2", "src/models", "src/dynamics", "src/control"]
MESSAGE = re.compile(
    r"""(?: \#\[error\( | refused?\(\s*(?:format!\()? | let\ message\ =\ format!\(
        | event\( | warning\(\s*(?:&format!\()?
        | =>\ *\{?\s*format!\(
        | (?:Refused|Warned|Failed|Discard|NoSuchStatus|ModelError::Error)\(\s*(?:format!\()? )
        \s*"((?:[^"\\]|\\.|\\\n)*)" """,
    re.DOTALL | re.VERBOSE,
)


def quoted(text: str) -> str:
    """A format string as the FAQ shows it."""
    return re.sub(r"\{[^}]*\}", "…", re.sub(r"\\\n\s*", "", text))


def messages() -> set[str]:
    found = set()
    for directory in SOURCES:
        for path in (ROOT / directory).rglob("*.rs"):
            code = path.read_text(encoding="utf-8").split("#[cfg(test)]")[0]
            found |= {quoted(text) for text in MESSAGE.findall(code)}
    # an error that only wraps another has no words of its own
    return found - {"…"}


def faq() -> str:
    return (ROOT / "docs/faq.md").read_text(encoding="utf-8")


def test_every_message_is_in_the_faq() -> None:
    assert len(messages()) > 60
    assert sorted(message for message in messages() if f"`{message}`" not in faq()) == []


def test_every_quoted_message_is_in_the_sources() -> None:
    rows = re.findall(r"^\| `([^`]*)` \|", faq(), re.MULTILINE)
    assert len(rows) > 60
    assert sorted(row for row in rows if row not in messages()) == []
