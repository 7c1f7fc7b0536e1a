"""The paper's claims, judged by the demo's figures.

A claim is a list of conditions on figures. It holds if all are met, holds in part if some are, and does not hold if
none is. A few claims need no run: they are refuted or left open by what a test or the paper itself shows.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rps3_study.results import Case, Results
from rps3_study.tasks import MODES, VARIANTS

HOLDS, IN_PART, FAILS, OPEN = "holds", "holds in part", "does not hold", "not tested"

RAC, DRAC, HDRAC, MPSO = MODES.values()
SIX, THREE = VARIANTS
SHORT = {SIX: "six", THREE: "three"}
TASKS = {
    "smooth": "smooth",
    "constant_speed": "constant speed",
    "sensors": "sensors",
    "push": "push",
    "stop": "stop",
    "stop_push": "stop and push",
}
"""Short names of the tasks."""
PLATFORM = "platform coordinates"
SEARCHED, STIFF = f"{PLATFORM}, lambda_f searched", f"{PLATFORM}, K_P 3600"


class Check(NamedTuple):
    """A condition with the figures that it is about."""

    figures: str
    met: bool


class Judgement(NamedTuple):
    """What a claim's row in the table says."""

    figures: str
    verdict: str


@dataclass(frozen=True)
class Claim:
    """A claim in our words, where it stands, and what decides it."""

    place: str
    statement: str
    test: str
    """When it counts as met, as the table says it."""
    judge: Callable[[Results], Judgement]


def verdict(checks: Sequence[Check]) -> str:
    """All, some or none of the conditions are met."""
    met = [check.met for check in checks]
    return HOLDS if all(met) else IN_PART if any(met) else FAILS


def _judged(checks: Callable[[Results], list[Check]]) -> Callable[[Results], Judgement]:
    def judge(results: Results) -> Judgement:
        found = checks(results)
        return Judgement("; ".join(check.figures for check in found), verdict(found))

    return judge


def _settled(figures: str, outcome: str) -> Callable[[Results], Judgement]:
    return lambda _: Judgement(figures, outcome)


def number(value: float) -> str:
    """Two significant digits, without exponent."""
    if not np.isfinite(value):
        return "-"
    return "below 0.0001" if 0.0 < abs(value) < 1e-4 else f"{float(f'{value:.2g}'):.10g}"


def peaks(results: Results, case: Case) -> dict[str, float]:
    """Peak errors of the modes, mm."""
    return {mode: figures.peak_error for mode, figures in results.figures[case].items()}


def _peak_against(results: Results, tasks: Sequence[str], rivals: Sequence[str], factor: float) -> list[Check]:
    """The tuned mode's peak error is below `factor` times the least of the rivals', for each task and variant."""
    checks = []
    for task in tasks:
        for variant in VARIANTS:
            all_peaks = peaks(results, (task, variant))
            own, other = all_peaks[MPSO], min(all_peaks[rival] for rival in rivals)
            checks.append(
                Check(f"{TASKS[task]}, {SHORT[variant]}: {number(own)} against {number(other)}", own < factor * other)
            )
    return checks


def _accuracy(results: Results) -> Judgement:
    """A summary instead of twelve pairs."""
    checks = _peak_against(results, list(TASKS), (RAC, DRAC, HDRAC), 0.5)
    ratios = [
        peaks(results, case)[MPSO] / min(peaks(results, case)[mode] for mode in (RAC, DRAC, HDRAC))
        for case in results.figures
    ]
    met = sum(check.met for check in checks)
    text = f"{met} of {len(checks)} cases; ratios {number(min(ratios))} to {number(max(ratios))}"
    return Judgement(text, verdict(checks))


def _least_error(results: Results) -> Judgement:
    checks = _peak_against(results, list(TASKS), (RAC, DRAC, HDRAC), 1.0)
    lost = [check.figures for check in checks if not check.met]
    text = f"{len(checks) - len(lost)} of {len(checks)} cases" + (f"; not {'; not '.join(lost)} mm" if lost else "")
    return Judgement(text, verdict(checks))


def _each_variant(check: Callable[[Results, str], Check]) -> Callable[[Results], Judgement]:
    return _judged(lambda results: [check(results, variant) for variant in VARIANTS])


def _zero_acceleration(results: Results, variant: str) -> Check:
    value = results.passages["smooth", variant][DRAC].acceleration
    return Check(f"{SHORT[variant]}: {number(value)} m/s2", value < 0.1)


def _leftover_of_drac(results: Results, variant: str) -> Check:
    value = results.passages["stop", variant][DRAC].leftover
    return Check(f"{SHORT[variant]}: {number(value)} mm/s", value > 1.0)


def _leftover_removed(results: Results, variant: str) -> Check:
    passages = results.passages["stop", variant]
    own, other = passages[HDRAC].leftover, passages[DRAC].leftover
    return Check(f"{SHORT[variant]}: {number(own)} against {number(other)} mm/s", own < 0.1 * other)


def _removed_on_the_way(results: Results, variant: str) -> Check:
    passages = results.passages["smooth", variant]
    own, other = passages[HDRAC].speed, passages[DRAC].speed
    return Check(f"{SHORT[variant]}: {number(own)} against {number(other)} mm/s", own < 0.1 * other)


def _better_scheme(results: Results) -> list[Check]:
    checks = []
    for task in ("smooth", "constant_speed", "push", "stop", "stop_push"):
        for variant in VARIANTS:
            both = peaks(results, (task, variant))
            pair = f"{number(both[HDRAC])} against {number(both[DRAC])}"
            checks.append(Check(f"{TASKS[task]}, {SHORT[variant]}: {pair}", both[HDRAC] < both[DRAC]))
    return checks


def _hindsight(results: Results) -> list[Check]:
    checks = []
    for (task, variant), compared in results.comparisons.items():
        own = peaks(results, (task, variant))[MPSO]
        pair = f"{number(own)} against {number(compared.best_fixed.peak_error)}"
        checks.append(Check(f"{TASKS[task]}, {SHORT[variant]}: {pair}", own < 1.05 * compared.best_fixed.peak_error))
    return checks


def _same_by_any_seed(results: Results) -> list[Check]:
    checks = []
    for (task, variant), compared in results.comparisons.items():
        low, high = min(compared.over_seeds), max(compared.over_seeds)
        checks.append(Check(f"{TASKS[task]}, {SHORT[variant]}: {number(low)} to {number(high)}", high < 2.0 * low))
    return checks


def _crosses(results: Results) -> list[Check]:
    checks = []
    for variant in VARIANTS:
        figures = [results.figures[task, variant][MPSO] for task in TASKS]
        worst = max(one.peak_error for one in figures)
        clean = not any(one.end_stop or one.failure for one in figures)
        stops = "no end stop" if clean else "an end stop reached"
        checks.append(Check(f"{SHORT[variant]}: at most {number(worst)} mm, {stops}", clean and worst < 10.0))
    return checks


def _varies(results: Results, variant: str) -> Check:
    low, high = results.passages["constant_speed", variant][MPSO].rho
    # decades: the percentiles themselves hang on the swarm's luck
    below, above = (10.0 ** f(np.log10(max(rho, 1e-3))) for f, rho in ((np.ceil, low), (np.floor, high)))
    text = f"{SHORT[variant]}: below {number(below)} in a tenth of the samples, at least {number(above)} in another"
    return Check(text, high > 2.0 * low)


def _smoother(task: str) -> Callable[[Results, str], Check]:
    def check(results: Results, variant: str) -> Check:
        passages = results.passages[task, variant]
        own, other = passages[MPSO].velocity_error, passages[HDRAC].velocity_error
        return Check(f"{SHORT[variant]}: {number(own)} against {number(other)} mm/s", own < 0.5 * other)

    return check


def _unstable(results: Results, variant: str) -> Check:
    figures, passage = results.figures["sensors", variant][DRAC], results.passages["sensors", variant][DRAC]
    stop = ", an end stop reached" if figures.end_stop else ", no end stop"
    text = f"{SHORT[variant]}: {number(figures.peak_error)} mm, {number(passage.velocity_error)} mm/s off{stop}"
    return Check(text, figures.end_stop)


def _comes_to_rest(results: Results) -> list[Check]:
    checks = []
    for mode in (HDRAC, MPSO):
        for variant in VARIANTS:
            passage = results.passages["stop", variant][mode]
            speed, error = passage.leftover, passage.final_error
            text = f"{mode}, {SHORT[variant]}: {number(speed)} mm/s, {number(error)} mm left"
            checks.append(Check(text, speed < 1.0 and error < 0.1))
    return checks


CLAIMS = (
    Claim(
        "abstract; 7",
        "Damping tuned online makes the responses around a singular point much more accurate.",
        "peak error below half the best fixed mode's",
        _accuracy,
    ),
    Claim(
        "abstract; 4.2",
        "Damped acceleration (DRAC) makes the acceleration along the degenerate direction zero at the singular point.",
        "below 0.1 m/s2 in the smooth crossing",
        _each_variant(_zero_acceleration),
    ),
    Claim(
        "abstract; 4.3",
        "DRAC leaves a velocity along the degenerate direction.",
        "more than 1 mm/s (rms) after a stop at the singular pose",
        _each_variant(_leftover_of_drac),
    ),
    Claim(
        "abstract; 6.3; 7",
        "HDRAC removes that leftover velocity; so nothing fluctuates when the platform arrives at a singular point.",
        "less than a tenth of DRAC's after a stop there",
        _each_variant(_leftover_removed),
    ),
    Claim(
        "7",
        "HDRAC damps velocities directly, so that they are removed at a singular point.",
        "speed along the degenerate direction at the singular pose of the smooth crossing, a tenth of DRAC's",
        _each_variant(_removed_on_the_way),
    ),
    Claim(
        "abstract; 4.3",
        "HDRAC with fixed damping is better than DRAC.",
        "smaller peak error, mm",
        _judged(_better_scheme),
    ),
    Claim(
        "abstract; 6.1; 7",
        "The swarm finds optimal damping factors at once, online.",
        "peak error, mm, at most 5 % above the best fixed damping in hindsight at the same gains",
        _judged(_hindsight),
    ),
    Claim(
        "abstract",
        "The swarm converges stably.",
        "peak errors, mm, over the swarm's seeds within a factor of 2",
        _judged(_same_by_any_seed),
    ),
    Claim(
        "abstract; 3.2; 7",
        "The modified swarm is computationally efficient and searches better than the plain one.",
        "success rates and times in [the swarm's tables](mpso.md)",
        _settled(
            "ahead on some functions with 30 iterations, behind nearly everywhere with 200; a search costs more than "
            "twice a plain swarm's and fits into a sample",
            IN_PART,
        ),
    ),
    Claim(
        "abstract; 7",
        "No path has to avoid the singular point.",
        "HDRAC+MPSO finishes every task off the end stops within 10 mm",
        _judged(_crosses),
    ),
    Claim(
        "7",
        "The controller passes the singular point with the least trajectory error.",
        "smallest peak error of the four modes",
        _least_error,
    ),
    Claim(
        "abstract; 6.2; 6.3; 7",
        "Experiments confirm all this.",
        "",
        _settled("no hardware here; runs with the sensors' errors of Table 1 stand in", OPEN),
    ),
    Claim(
        "6",
        "Inverse dynamics gives the torques that a trajectory takes.",
        "`cargo xtask torque`; `tests/newton_euler.rs`",
        _settled("six motors: yes; three: the currents grow beyond bounds at a direct singularity", IN_PART),
    ),
    Claim(
        "6.1",
        "One singular point lies in the workspace, at the printed pose.",
        "[errata](errata.md), `cargo xtask atlas`",
        _settled("a whole surface does, and the printed pose is none of a rigid platform", FAILS),
    ),
    Claim(
        "6.1",
        "P runs at constant speed on a straight line from (0, 0, 0) through it to (5, -5, 5) cm.",
        "[errata](errata.md)",
        _settled("it would take a tilt of 71 deg; the tasks here cross at reachable poses instead", FAILS),
    ),
    Claim(
        "6.1",
        "The damping factor is not fixed but follows the neighbourhood of the singularity.",
        "rho of HDRAC+MPSO near the singular pose varies by more than a factor of 2",
        _each_variant(_varies),
    ),
    Claim(
        "6.1, Figure 7",
        "With MPSO the motion near the singular point is smoother than with fixed damping, without fluctuation.",
        "largest velocity error there below half of HDRAC's, constant speed",
        _each_variant(_smoother("constant_speed")),
    ),
    Claim(
        "6.3, Figure 9",
        "DRAC is unstable near the singular point, with great fluctuations.",
        "constant speed, sensors of Table 1: an end stop is reached",
        _each_variant(_unstable),
    ),
    Claim(
        "6.3, Figure 10",
        "HDRAC with MPSO has only slight fluctuations there.",
        "constant speed, sensors of Table 1: largest velocity error below half of HDRAC's",
        _each_variant(_smoother("sensors")),
    ),
    Claim(
        "5; 7",
        "The scheme is asymptotically stable.",
        "after a stop at the singular pose: below 1 mm/s, and less than 0.1 mm left; on the proof: [errata](errata.md)",
        _judged(_comes_to_rest),
    ),
)


def judge_all(results: Results) -> list[tuple[Claim, Judgement]]:
    """Every claim with its judgement."""
    return [(claim, claim.judge(results)) for claim in CLAIMS]
