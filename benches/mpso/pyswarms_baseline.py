"""The counterpart of main.rs beside this file for pyswarms' GlobalBestPSO.

20 particles, 30 iterations, a sum of squares in 2 and 3 members. Its objective sees all particles in one call.

    pip install pyswarms && python benches/mpso/pyswarms_baseline.py
"""

import contextlib
import logging
import tempfile
import time

import numpy as np

SIZE, ITERATIONS, RUNS = 20, 30, 200


def search(optimizer, members):
    bounds = (np.full(members, -1.0), np.full(members, 1.5))
    options = {"c1": 2.0, "c2": 2.0, "w": 0.65}
    swarm = optimizer(SIZE, members, options, bounds=bounds, velocity_clamp=(-0.5, 0.5))
    # The iterations count includes the evaluation of the initial swarm.
    swarm.optimize(lambda x: (x * x).sum(axis=1), ITERATIONS + 1, verbose=False)


def main():
    from pyswarms.single import GlobalBestPSO  # writes its log when imported, see below

    logging.disable(logging.CRITICAL)
    for members in (2, 3):
        seconds = []
        for _ in range(RUNS):
            begin = time.perf_counter()
            search(GlobalBestPSO, members)
            seconds.append(time.perf_counter() - begin)
        fastest = min(seconds)  # the one least disturbed by other work on the machine
        evaluations = SIZE * (ITERATIONS + 1)
        print(f"{members} members: {fastest * 1e6:.0f} us a search, {fastest / evaluations * 1e9:.0f} ns an evaluation")


if __name__ == "__main__":
    # pyswarms leaves a report.log in the working directory.
    with tempfile.TemporaryDirectory() as directory, contextlib.chdir(directory):
        main()
