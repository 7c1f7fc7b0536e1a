"""What the tuned mode is compared with beside the other modes: its luck, and the best fixed factors in hindsight."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

from rps3_study.couple import Run
from rps3_study.fmu import Value

SEEDS = range(1, 9)
"""Seeds of the swarm."""
COMPARED = ("smooth", "constant_speed", "stop_push")
"""Keys of the tasks that are compared."""
RHO = (0.005, 0.01, 0.02, 0.05, 0.1)
DELTA_HD = (0.0, 0.02, 0.1)
LAMBDA_F = (0.0, 5e-3)
"""Fixed factors tried; six motors have no use for the last."""
K_P = (900.0, 3600.0, 10_000.0)
"""Gains tried with each of them, 1/s2, critically damped; the first is the start value."""

HDRAC, MPSO = 3, 4


@dataclass(frozen=True)
class Fixed:
    """Fixed factors and gains, and the peak error that they give, mm."""

    peak_error: float
    rho: float
    delta_hd: float
    lambda_f: float
    k_p: float


@dataclass(frozen=True)
class Comparison:
    """One task with one actuation variant; errors in mm."""

    over_seeds: tuple[float, ...]
    """Peak errors of the tuned mode by seed."""
    best_fixed: Fixed
    """The best of the fixed factors tried at the tuned mode's gains."""
    best_gains: Fixed
    """The best at any of the gains tried."""


def fixed_factors(variant: str) -> list[tuple[float, float, float, float]]:
    """All combinations of rho, delta_hd, lambda_f and k_p that are tried."""
    return list(itertools.product(RHO, DELTA_HD, LAMBDA_F if variant == "three motors" else LAMBDA_F[:1], K_P))


def runs(variant: str) -> int:
    """Number of runs that `compare` makes."""
    return len(SEEDS) + len(fixed_factors(variant))


def compare(variant: str, run: Callable[[dict[str, Value]], Run], peak_error: Callable[[Run], float]) -> Comparison:
    """Compares.

    Args:
        variant: a key of `tasks.VARIANTS`.
        run: runs the task with parameters of the controller.
        peak_error: of a run, infinite for one that ended early.
    """
    seeds = tuple(peak_error(run({"control_mode": MPSO, "seed": seed})) for seed in SEEDS)
    tried = []
    for rho, delta_hd, lambda_f, k_p in fixed_factors(variant):
        factors = {"rho_fixed": rho, "delta_hd_fixed": delta_hd, "lambda_f_fixed": lambda_f}
        gains = {"k_p": k_p, "k_d": 2.0 * math.sqrt(k_p)}
        error = peak_error(run({"control_mode": HDRAC, **factors, **gains}))
        tried.append(Fixed(error, rho, delta_hd, lambda_f, k_p))

    tried.sort(key=lambda fixed: fixed.peak_error)
    return Comparison(seeds, next(fixed for fixed in tried if fixed.k_p == K_P[0]), tried[0])
