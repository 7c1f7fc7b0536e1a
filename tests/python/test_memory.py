"""The shared libraries driven from C: no leak, no growth, no race, on threads the bits of serial runs.

`cargo xtask memory` runs it with --long and with the libraries that a sanitizer watches.
"""

import ctypes
import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import fmpy
import pytest
from conftest import ROOT
from rps3_study.fmu import Fmu

# without the allocator's caches of freed blocks: what stays in use was lost
EXACT_HEAP = {"GLIBC_TUNABLES": "glibc.malloc.tcache_count=0"}
MEMCHECK = ["--tool=memcheck", "--leak-check=full", "--errors-for-leak-kinds=definite,indirect,possible"]

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the C host reads /proc")


@pytest.fixture(scope="session")
def compiler() -> str:
    """A C compiler."""
    found = next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)
    if found is None:
        pytest.skip("no C compiler on this machine")
    return found


@pytest.fixture(scope="session")
def valgrind() -> str:
    """The program."""
    found = shutil.which("valgrind")
    if found is None:
        pytest.skip("no valgrind on this machine (Debian: apt install valgrind)")
    return found


def compiled(compiler: str, directory: Path, *flags: str) -> Path:
    """The C host, compiled against the standard's headers, which FMPy brings."""
    program = directory / "client"
    headers = Path(fmpy.__file__).parent / "c-code"
    warnings = ["-std=c11", "-Wall", "-Wextra", "-Werror"]
    source = ROOT / "tests/c/client.c"
    libraries = ["-ldl", "-lm", "-pthread"]
    command = [compiler, *warnings, "-g", "-O1", f"-I{headers}", source, "-o", program, *flags, *libraries]
    subprocess.run(list(map(str, command)), check=True)
    return program


@pytest.fixture(scope="session")
def client(compiler: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The C host."""
    return compiled(compiler, tmp_path_factory.mktemp("client"))


def library(fmu: Fmu) -> Path:
    """The shared library in the archive."""
    (found,) = (fmu.directory / "binaries").glob("*/*.so")
    return found


def arguments(fmu: Fmu, library: Path, what: str, count: int) -> list[str]:
    """Of the C host."""
    references = [fmu.variables[name].valueReference for name in fmu.names("output", "Real")]
    assert references == list(range(references[0], references[-1] + 1))
    return [str(library), fmu.description.guid, str(references[0]), str(references[-1]), what, str(count)]


def run(command: list[str | Path], **environment: str) -> str:
    """Standard output; the test fails with everything that was written if the command does."""
    completed = subprocess.run(
        list(map(str, command)), env=os.environ | environment, capture_output=True, text=True, check=False
    )
    assert completed.returncode == 0, completed.stdout + completed.stderr[-20_000:]
    print(completed.stdout, end="")
    return completed.stdout


@pytest.mark.parametrize(
    ("what", "short", "long"),
    [("run", 50, 1000), ("cycles", 300, 10_000), ("loads", 300, 10_000), ("threads", 64, 256)],
)
def test_a_c_host_sees_no_growth_and_the_same_bits_on_threads(
    fmu: Fmu, client: Path, what: str, short: int, long: int, is_long: bool
) -> None:
    run([client, *arguments(fmu, library(fmu), what, long if is_long else short)], **EXACT_HEAP)


@pytest.mark.parametrize(("what", "short", "long"), [("run", 3, 100), ("reload", 2, 20), ("threads", 2, 16)])
def test_memcheck_finds_neither_leak_nor_error(
    fmu: Fmu, client: Path, valgrind: str, what: str, short: int, long: int, is_long: bool
) -> None:
    command = [valgrind, "--error-exitcode=9", "--quiet", *MEMCHECK, client]
    run([*command, *arguments(fmu, library(fmu), what, long if is_long else short)])


@pytest.mark.parametrize("tool", ["helgrind", "drd"])
def test_instances_on_threads_share_nothing_that_changes(
    fmu: Fmu, client: Path, valgrind: str, tool: str, is_long: bool
) -> None:
    # the first instance is made before: the standard library's OnceLock, which makes the tables,
    # synchronizes through the kernel's futex, which neither tool sees
    command = [valgrind, "--error-exitcode=9", "--quiet", f"--tool={tool}", client]
    run([*command, *arguments(fmu, library(fmu), "later", 16 if is_long else 2)])


def test_the_default_run_divides_by_no_zero_and_makes_no_nan(fmu: Fmu, client: Path) -> None:
    # some hosts have the processor trap on invalid operation, division by zero and overflow
    run([client, *arguments(fmu, library(fmu), "traps", 1400)])


CYCLES_IN_FMPY = """
import ctypes, gc, sys
import psutil
from rps3_study.fmu import Instance, ModelInstance, extracted

class Mallinfo2(ctypes.Structure):
    names = "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost"
    _fields_ = [(name, ctypes.c_size_t) for name in names.split()]

libc = ctypes.CDLL(None)
libc.mallinfo2.restype = Mallinfo2

def cycle(fmu):
    for kind in (Instance, ModelInstance):
        with kind(fmu) as instance:
            instance.initialize({})
            instance.get(fmu.variables)

def memory():
    gc.collect()
    heap = libc.mallinfo2()
    return heap.uordblks + heap.hblkhd, psutil.Process().memory_info().rss

with extracted(sys.argv[1]) as (fmu,):
    for _ in range(50):
        cycle(fmu)
    before = memory()
    for _ in range(int(sys.argv[2])):
        cycle(fmu)
    print(*(after - before for before, after in zip(before, memory())))
"""


def test_fmpy_sees_no_growth(fmu: Fmu, is_long: bool) -> None:
    if not hasattr(ctypes.CDLL(None), "mallinfo2"):
        pytest.skip("how much of the heap is in use is glibc's to tell, from 2.33 on")
    count = 2000 if is_long else 100
    output = run([sys.executable, "-c", CYCLES_IN_FMPY, fmu.archive, str(count)], **EXACT_HEAP)
    heap, resident = map(int, output.split())
    print(f"{count} cycles in FMPy: heap {heap:+} bytes, resident {resident:+} bytes")
    # the libraries take all their memory from this heap, Python only what is larger than its own heap's blocks; an
    # instance that stays takes more than 10 kB, and a chance object of Python's no more than that in all
    assert heap < 8 * 1024 + count


def test_memcheck_finds_no_error_of_the_library_in_fmpy(fmu: Fmu, valgrind: str, tmp_path: Path, is_long: bool) -> None:
    if not is_long:
        pytest.skip("only with --long: an interpreter in an interpreter")
    report = tmp_path / "report.xml"
    script = f"""
from rps3_study.fmu import Instance, extracted
with extracted({str(fmu.archive)!r}) as (fmu,), Instance(fmu) as instance:
    instance.initialize({{}})
    for k in range(20):
        instance.step(k * 1e-3, 1e-3)
        instance.get(fmu.variables)
"""
    options = [*MEMCHECK, "--xml=yes", f"--xml-file={report}"]
    run([valgrind, *options, sys.executable, "-c", script], PYTHONMALLOC="malloc")
    errors = ElementTree.parse(report).getroot().findall("error")
    objects = [[frame.findtext("obj") or "" for frame in error.iter("frame")] for error in errors]
    ours = [error for error, names in zip(errors, objects, strict=True) if any("Rps3" in name for name in names)]
    assert not ours, ElementTree.tostring(ours[0], encoding="unicode")


@pytest.mark.parametrize(("what", "count"), [("run", 100), ("reload", 20), ("threads", 64)])
def test_address_sanitizer_finds_nothing(fmu: Fmu, compiler: str, tmp_path: Path, what: str, count: int) -> None:
    directory = os.environ.get("RPS3_ADDRESS_SANITIZED")
    if directory is None:
        pytest.skip("no libraries for AddressSanitizer: `cargo xtask memory` builds them")
    watched = Path(directory) / f"lib{fmu.description.coSimulation.modelIdentifier}.so"
    client = compiled(compiler, tmp_path, "-fsanitize=address")
    run([client, *arguments(fmu, watched, what, count)])


def test_thread_sanitizer_finds_no_race(fmu: Fmu, compiler: str, tmp_path: Path) -> None:
    directory, sanitizer = (os.environ.get(f"RPS3_THREAD_{what}") for what in ("SANITIZED", "SANITIZER"))
    if directory is None or sanitizer is None:
        pytest.skip("no libraries for ThreadSanitizer: `cargo xtask memory` builds them")
    watched = Path(directory) / f"lib{fmu.description.coSimulation.modelIdentifier}.so"
    # the whole of it, and in sight of the libraries
    client = compiled(compiler, tmp_path, "-rdynamic", "-Wl,--whole-archive", sanitizer, "-Wl,--no-whole-archive")
    # the first instance is made before, as for helgrind: it sees the standard library's OnceLock as little
    run([client, *arguments(fmu, watched, "later", 16)])
