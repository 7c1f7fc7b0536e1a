"""Measures, prints the table of ratios, writes dist/bench/ and, when asked, the blocks of the documents.

Started by `cargo xtask bench`, which builds what is measured.
"""

from __future__ import annotations

import argparse
import sys

from rps3_study.fmu import Fmu, extracted

from suite import dynamics, growth, model_exchange, pairs, searches, steps, table, ticks, work_precision
from suite.peers import ROOT, Native
from suite.table import Listing, Row

DIST = ROOT / "dist"
OUT = DIST / "bench"
PAGES = [ROOT / "docs/performance.md", ROOT / "docs/mpso.md"]
PICTURE = ROOT / "docs/images/work-precision.png"


class Suite:
    """What has been measured so far."""

    def __init__(self, native: Native, plant: Fmu, controller: Fmu, rounds: int, minutes: int) -> None:
        self.native, self.plant, self.controller = native, plant, controller
        self.rounds, self.minutes = rounds, minutes
        self.rows: list[Row] = []
        self.listings: list[Listing] = []
        self.data: dict[str, object] = {}

    def add(self, measured: tuple[list[Row], Listing] | list[Row] | Listing) -> None:
        rows, listing = (
            measured
            if isinstance(measured, tuple)
            else (measured, None)
            if isinstance(measured, list)
            else ([], measured)
        )
        self.rows += rows
        if listing is not None:
            self.listings.append(listing)
            self.data[listing.name] = [dict(zip(listing.head, cells, strict=True)) for cells in listing.rows]

    def right_hand_side(self) -> None:
        self.add(dynamics.measure(self.native, self.rounds))

    def step(self) -> None:
        self.add(steps.step(self.native, self.plant, self.rounds))

    def calls(self) -> None:
        self.add(steps.calls(self.native, self.plant, self.controller, self.rounds))

    def model_exchange(self) -> None:
        self.add(model_exchange.measure(self.plant, self.rounds))

    def pair(self) -> None:
        self.add(pairs.measure(self.native, self.plant, self.controller, self.rounds))

    def instances(self) -> None:
        self.add(growth.instances(self.plant, self.controller, max(1, self.rounds // 5)))

    def tick(self) -> None:
        self.add(ticks.measure(self.native, self.rounds))

    def swarm(self) -> None:
        self.add(growth.swarms(self.native, self.rounds))

    def searches(self) -> None:
        self.add(searches.measure(self.native, self.rounds))

    def long_run(self) -> None:
        self.add(growth.long_run(self.native, self.minutes))

    def work_precision(self) -> None:
        points, listing = work_precision.measure(self.native, max(1, self.rounds // 3))
        self.add(listing)
        self.data["work-precision points"] = points
        work_precision.draw(points, OUT / "work-precision.png")


PARTS = [
    "right_hand_side",
    "step",
    "calls",
    "model_exchange",
    "pair",
    "instances",
    "tick",
    "swarm",
    "searches",
    "long_run",
    "work_precision",
]


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="cargo xtask bench --", description=__doc__)
    parser.add_argument("parts", nargs="*", choices=[*PARTS, []], help="what to measure, by default everything")
    parser.add_argument("--rounds", type=int, default=15, help="how often each pair is measured in turn")
    parser.add_argument("--minutes", type=int, default=60, help="simulated minutes of the long run")
    parser.add_argument("--docs", action="store_true", help="fill the tables of docs/, of ratios only with all parts")
    return parser.parse_args()


def main() -> None:
    options = arguments()
    with extracted(DIST / "Rps3Plant.fmu", DIST / "Rps3Controller.fmu") as (plant, controller), Native() as native:
        suite = Suite(native, plant, controller, options.rounds, options.minutes)
        for part in options.parts or PARTS:
            print(f"measuring: {part}", file=sys.stderr, flush=True)
            getattr(suite, part)()
    print(table.ratios(suite.rows))
    for listing in suite.listings:
        print(f"{listing.name}:\n\n{listing.markdown()}")
    table.write(OUT, suite.rows, suite.listings, suite.data)
    print(f"{OUT.relative_to(ROOT)}: ratios.md, bench.json", file=sys.stderr)
    if options.docs:
        blocks = {listing.name: listing.markdown() for listing in suite.listings}
        if not options.parts:  # the one table has the rows of all parts
            blocks["ratios"] = table.ratios(suite.rows)
        table.fill(PAGES, blocks)
        if "work-precision points" in suite.data:
            work_precision.draw(suite.data["work-precision points"], PICTURE)


if __name__ == "__main__":
    main()
