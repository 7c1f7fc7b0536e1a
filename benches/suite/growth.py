"""Many instances, large swarms, long runs."""

from __future__ import annotations

from rps3_study.fmu import Fmu

from suite import peers
from suite.peers import Native, fastest
from suite.table import Listing, Row, duration

COUNTS = (1, 10, 100, 1000, 10_000)
SWARMS = ((5, 10), (10, 20), (20, 30), (40, 60), (100, 100))
GOAL = 64 * 1024


def instances(plant: Fmu, controller: Fmu, rounds: int) -> tuple[list[Row], Listing]:
    """Memory and time of pairs in one process.

    Each measurement has a process of its own, so that none finds the memory of the one before.
    """
    libraries = {"plant": peers.library(plant), "controller": peers.library(controller)}
    cells, times = [], {}
    for count in COUNTS:
        best: dict[int, dict[str, float]] = {}
        for _ in range(rounds):
            for threads in (1, 2):
                with Native() as native:
                    found = native.measure("instances", **libraries, count=count, threads=threads)
                best[threads] = min(best.get(threads, found), found, key=lambda found: found["seconds"])
        times[count] = best
        cells.append(
            [
                f"{count}",
                f"{best[1]['bytes'] / 1024:.1f} KiB" if count >= 100 else "below a page's accuracy",
                duration(best[1]["seconds"]),
                duration(best[2]["seconds"]),
            ]
        )
    first, last = COUNTS[0], COUNTS[-1]
    ours, many = times[first][1]["seconds"], times[last][1]["seconds"]
    rows = [
        Row("growth", f"{first} pair, a tick", ours, f"{last} pairs, a tick of each", many),
        Row("growth", f"{last} pairs, 2 threads", times[last][2]["seconds"], "1 thread", many),
    ]
    head = ["pairs", "memory a pair", "a tick of each, 1 thread", "2 threads"]
    return rows, Listing("instances", head, cells)


def swarms(native: Native, rounds: int) -> Listing:
    """A controller tick over swarm size and iterations, none ended early."""
    cells = []
    for size, iterations in SWARMS:

        def tick(size: int = size, iterations: int = iterations) -> list[float]:
            return native.measure("tick", swarm_size=size, iterations=iterations)

        seconds = fastest(rounds, {"tick": tick})["tick"]
        evaluations = size * (iterations + 1)
        cells.append([f"{size}", f"{iterations}", f"{evaluations}", duration(seconds), duration(seconds / evaluations)])
    return Listing("swarm", ["individuals", "iterations", "evaluations", "a tick", "an evaluation"], cells)


def long_run(native: Native, minutes: int) -> tuple[list[Row], Listing]:
    """Simulated minutes of the pair in one run: time a tick and memory, at its begin, middle and end."""
    found = native.measure("hours", minutes=minutes)
    rows = found["minutes"]
    # the fastest minute of each quarter: other work on the machine slows single minutes
    quarter = max(1, len(rows) // 4)
    quarters = [rows[k : k + quarter] for k in range(0, quarter * 4, quarter)]
    fastest = [min(row["seconds"] for row in part) for part in quarters if part]
    cells = [
        [f"{k + 1}", duration(seconds), f"{part[-1]['bytes'] / 1024:.0f} KiB"]
        for k, (seconds, part) in enumerate(zip(fastest, quarters, strict=False))
    ]
    row = Row(
        "growth", f"first quarter of {minutes} simulated minutes, a tick", fastest[0], "last quarter", fastest[-1],
        f"memory {(rows[-1]['bytes'] - rows[0]['bytes']) / 1024:+.0f} KiB",
    )  # fmt: skip
    return [row], Listing("long-run", ["quarter", "a tick", "memory at its end"], cells)
