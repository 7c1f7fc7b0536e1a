"""What instances share never changes once it is made, so that they cannot see each other (section 2.1.1).

The linker's own list is read, so no static of the sources or of a dependency is missed: every place in the libraries
that can be written after loading.
"""

import re
from collections.abc import Iterator

import lief
import pytest
from rps3_study.fmu import Fmu

# parts of mangled names, and why no result depends on what they name
KNOWN = {
    r"fmi27lasting(5STAYS|6OWNERS)": "how many instances there are, and what to free when the library is unloaded",
    r"15fmi2Instantiate6LAYOUT": "what the FMI layer knows of the variables, made once from constants",
    r"6models\d+(plant|controller)5table5TABLE": "the model's variables, made once from constants",
    r"(_ZN|_)(3std|10std_detect)\d": "the standard library's: panics and their reports, processor features",
    r"(_ZN|_)6memchr\d": "which instructions the processor has to search bytes with",
    r"^completed\.0$|^DW\.ref\.rust_eh_personality$": "the C runtime's, for unloading and unwinding",
}
# the largest alignment among them: more between two of them would be something without a name
PADDING = 16


def writable(binary: lief.ELF.Binary) -> Iterator[lief.ELF.Section]:
    """Sections that stay writable: the loader protects others (GNU_RELRO), though not the copies that threads have."""
    flags, protected = lief.ELF.Section.FLAGS, lief.ELF.Segment.TYPE.GNU_RELRO
    for section in binary.sections:
        lasting = protected not in [segment.type for segment in section.segments]
        if flags.WRITE in section and (lasting or flags.TLS in section):
            yield section


def test_nothing_that_instances_share_changes(fmu: Fmu) -> None:
    libraries = list((fmu.directory / "binaries").rglob("*.so"))
    if not libraries:
        pytest.skip("no library in ELF format")
    for library in libraries:
        binary = lief.parse(library)
        sections = {section.name: section for section in writable(binary)}
        assert {".data", ".bss"} <= set(sections)
        named = [s for s in binary.symtab_symbols if s.size > 0 and s.section and s.section.name in sections]
        unknown = [str(s.name) for s in named if not any(re.search(pattern, str(s.name)) for pattern in KNOWN)]
        assert unknown == []
        # thread-local variables are counted from the first of their sections on
        flag = lief.ELF.Section.FLAGS.TLS
        first = min((section.virtual_address for section in sections.values() if flag in section), default=0)
        for name, section in sections.items():
            base, end = first if flag in section else 0, section.virtual_address
            for symbol in sorted((s for s in named if s.section.name == name), key=lambda symbol: symbol.value):
                assert base + symbol.value - end < PADDING, f"{name}: nameless before {symbol.name}"
                end = max(end, base + symbol.value + symbol.size)
            assert section.virtual_address + section.size - end < PADDING, f"{name}: nameless at its end"
