"""What the search of a swarm costs: ours, argmin's and pyswarms'."""

from __future__ import annotations

import contextlib
import logging
import tempfile
import time

import numpy as np

from suite.peers import Native, fastest
from suite.table import Listing, Row, duration, factor

SIZE, ITERATIONS = 20, 30
MEMBERS = (2, 3)
MPSO, PYSWARMS = "MPSO", "pyswarms 1.3 `GlobalBestPSO`"
NATIVE = {
    "mpso": MPSO,
    "plain": "plain, same code",
    "argmin_arrays": "argmin 0.11 `ParticleSwarm`, arrays",
    "argmin_vectors": "argmin 0.11 `ParticleSwarm`, vectors",
}


def measure(native: Native, rounds: int) -> tuple[list[Row], Listing]:
    """Searches of 20 individuals and 30 iterations on a sum of squares, none ended early."""
    rows, cells = [], []
    evaluations = SIZE * (ITERATIONS + 1)
    for members in MEMBERS:

        def ours(optimizer: str, members: int = members) -> float:
            budget = {"swarm_size": SIZE, "iterations": ITERATIONS}
            return native.measure("search", optimizer=optimizer, members=members, budget=budget, rounds=100)

        candidates = {name: lambda optimizer=optimizer: ours(optimizer) for optimizer, name in NATIVE.items()}
        with pyswarms(members) as search:
            times = fastest(rounds, {**candidates, PYSWARMS: search})
        for name, seconds in times.items():
            cells.append(
                [
                    f"{members}",
                    name,
                    duration(seconds),
                    duration(seconds / evaluations),
                    factor(seconds / times[MPSO]),
                ]
            )
            if name != MPSO:
                rows.append(Row(f"swarm, {members} members", MPSO, times[MPSO], name, seconds))
    return rows, Listing("searches", ["members", "swarm", "a search", "an evaluation", "to MPSO"], cells)


@contextlib.contextmanager
def pyswarms(members: int):
    """A search by pyswarms, which gets all particles of an iteration in one call; seconds, the least of ten."""
    # it leaves a report.log in the working directory when it is imported
    with tempfile.TemporaryDirectory() as directory, contextlib.chdir(directory):
        from pyswarms.single import GlobalBestPSO

        logging.getLogger("pyswarms").setLevel(logging.CRITICAL)
        bounds = (np.full(members, -1.0), np.full(members, 1.5))
        options = {"c1": 2.0, "c2": 2.0, "w": 0.65}

        def once() -> float:
            begin = time.perf_counter()
            swarm = GlobalBestPSO(SIZE, members, options, bounds=bounds, velocity_clamp=(-0.5, 0.5))
            # the iterations that it counts include the evaluation of the initial swarm
            swarm.optimize(lambda x: (x * x).sum(axis=1), ITERATIONS + 1, verbose=False)
            return time.perf_counter() - begin

        yield lambda: min(once() for _ in range(10))
