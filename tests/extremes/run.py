#!/usr/bin/env python3
"""floe at its numerical limits: every extreme gives an answer with its verified accuracy, or a refusal that says why.

run.py FLOE [--quick] [--write FILE] [NAME...]: the studies whose name contains NAME (all), --quick: a few points of
each; --write: the table as a document.
"""
import argparse
import concurrent.futures
import sys
import time

import amplitudes
import bad_numbers
import contrasts
import degenerate
import horizons
import slenderness
import spin
import table
import unit_systems
from floe import Floe
from study import judge

STUDIES = [study for room in (slenderness, unit_systems, contrasts, amplitudes, horizons, spin, degenerate, bad_numbers)
           for study in room.STUDIES]


def line(found):
    what = f"FAIL {found.fault}" if found.fault else f"missed, as known: {found.miss}" if found.miss else (
        f"refused ({found.refusal.code}): {found.refusal.text}" if found.refusal else
        f"error {found.error:.2g} (limit {found.point.limit:.2g})" + (f"; {found.note}" if found.note else ""))
    return f"{found.study.name} | {found.point.label} | {found.seconds:.1f} s | {what}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("floe")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--write")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    floe = Floe(arguments.floe)
    chosen = [(s, p) for s in STUDIES for p in s.points if (p.quick or not arguments.quick)
              and (not arguments.names or any(n in s.name for n in arguments.names))]
    assert chosen, "no study has such a name"
    begin, results = time.monotonic(), []
    with concurrent.futures.ThreadPoolExecutor(arguments.workers) as pool:
        for found in pool.map(lambda pair: judge(*pair, floe, time.monotonic), chosen):
            results.append(found)
            if found.fault or not arguments.quick:
                print(line(found), flush=True)
    failed = sum(bool(f.fault) for f in results)
    seconds = time.monotonic() - begin
    missed = sum(bool(f.miss) for f in results)
    print(f"{len(results)} points of {len({f.study.name for f in results})} extremes, {missed} missed as known, "
          f"{failed} failed, {seconds:.0f} s")
    if arguments.write:
        table.write(arguments.write, results, arguments.floe, seconds)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
