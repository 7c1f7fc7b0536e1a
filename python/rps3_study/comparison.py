"""What the tuned mode is compared with beside the other modes: its luck, and the best fixed damping in hindsight."""

from __future__ import annotations

import itertools
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

HDRAC, MPSO = 3, 4


@dataclass(frozen=True)
class Comparison:
    """One task with one actuation variant; errors in mm."""

    over_seeds: tuple[float, ...]
    """Peak errors of the tuned mode by seed."""
    best_fixed: float
    """Least peak error that any of the fixed factors tried gives."""
    rho: float
    delta_hd: float
    lambda_f: float
    """These factors."""


def fixed_factors(variant: str) -> list[tuple[float, float, float]]:
    """All combinations of rho, delta_hd and lambda_f that are tried."""
    return list(itertools.product(RHO, DELTA_HD, LAMBDA_F if variant == "three motors" else LAMBDA_F[:1]))


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
    names = ("rho_fixed", "delta_hd_fixed", "lambda_f_fixed")
    tried = {
        factors: peak_error(run({"control_mode": HDRAC, **dict(zip(names, factors, strict=True))}))
        for factors in fixed_factors(variant)
    }
    best = min(tried, key=tried.__getitem__)
    return Comparison(seeds, tried[best], *best)
