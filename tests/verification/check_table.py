#!/usr/bin/env python3
"""What table.py takes for the tolerance of a comparison: the column "tolerance used" is at most 100 % where all pass."""
import math

import table


def used(words, values):
    """Share of its tolerance that a comparison uses, as Catch2 reports it; None: it has none that is written."""
    one = table.comparison_of(words, values, True)
    return table.distance(one) if one.tolerance else None


CASES = [
    ("x == Approx(2).epsilon(0.01)", "2.01 == Approx( 2.0 )", 0.5),
    ("x == Approx(2).margin(0.02)", "2.01 == Approx( 2.0 )", 0.5),
    ("x == Approx(0).margin(0.02)", "0.01 == Approx( 0.0 )", 0.5),
    ("x == Approx(2).epsilon(0.01).margin(1e-6)", "2.01 == Approx( 2.0 )", 0.5),  # the larger one
    ("x == Approx(2).epsilon(1e-6).margin(0.02)", "2.01 == Approx( 2.0 )", 0.5),
    ("x == Approx(1e6).margin(1)", "1000002.0 == Approx( 1000000.0 )", 2 / (1e6 * 100 * 2**-23)),  # Catch2's own 1.2e-5
    ("x == Approx(2).epsilon(small)", "2.01 == Approx( 2.0 )", None),
    ("x == Approx(2)", "2.00001 == Approx( 2.0 )", None),
    # 1.3004e-9 for 1.25e-9 to 5 %, in ten decimals
    ("x == Approx(1e-8 / 8).epsilon(0.05)", "0.0000000013 == Approx( 0.0000000012 )", None),
]

for words, values, expected in CASES:
    found = used(words, values)
    agrees = found is None if expected is None else found is not None and math.isclose(found, expected, rel_tol=1e-6)
    assert agrees, f"{words}, {values}: {found}, not {expected}"
assert table.comparison_of("x < 3", "2.5 < 3", True).relation == "<"
assert table.comparison_of("x <= 3", "2.5 <= 3", True).relation == "<"
assert table.comparison_of("ok", "true", True) is None
print(f"{len(CASES)} comparisons of the verification table")
