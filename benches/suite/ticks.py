"""A controller tick in mode 4, and where its time goes."""

from __future__ import annotations

from rps3_study.tasks import VARIANTS

from suite.peers import Native
from suite.table import Listing, Row, duration

GOAL = 60e-6
PARTS = {
    "estimate": "estimate of the pose",
    "situation": "kinematics and dynamics there",
    "bases": "singular values of J, force distribution",
    "once": "fitness, what all dampings share",
    "evaluations": "fitness of each damping",
    "moves": "swarm: moves and ranks",
}


def measure(native: Native, rounds: int) -> tuple[list[Row], Listing]:
    """The tick against its goal, and its parts."""
    rows, columns = [], {}
    for variant, revolute_motors in VARIANTS.items():
        best: dict[str, float] = {}
        for _ in range(rounds):
            for name, seconds in native.measure("tick_parts", revolute_motors=revolute_motors).items():
                best[name] = min(best.get(name, seconds), seconds)
        whole = best.pop("whole")
        rest = whole - sum(best.values())
        rows.append(Row(f"controller tick, {variant}", "mean near the singularity", whole, "goal", GOAL))
        columns[variant] = {text: best[part] for part, text in PARTS.items()} | {"the rest": rest, "whole": whole}
    cells = [
        [name, *(f"{duration(column[name])}, {column[name] / column['whole']:.0%}" for column in columns.values())]
        for name in (*PARTS.values(), "the rest", "whole")
    ]
    return rows, Listing("tick", ["part of a tick", *columns], cells)
