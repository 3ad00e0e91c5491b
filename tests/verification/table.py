#!/usr/bin/env python3
"""Writes docs/verification.md from what the verification and convergence tests compare: Catch2's own report of every
comparison, expected and computed. table.toml has the rows of the table and their descriptions, without numbers."""
import argparse
import collections
import datetime
import os
import re
import subprocess
import sys
import tomllib
import xml.etree.ElementTree as ElementTree

HERE = os.path.dirname(os.path.abspath(__file__))
NUMBER = r"([-+0-9.eE]+|nan|inf|-inf)"

Comparison = collections.namedtuple("Comparison", "words relation computed expected tolerance passed")


RELATIVE = 100 * 2.0**-23  # of Catch2's Approx where a test writes no .epsilon
PRINTED = 1e-10  # the last decimal of Catch2's numbers


def tolerance_of(words, expected):
    """What Approx allows, the larger of .epsilon times the expected number and .margin, where these are written as
    numbers and are not lost in the rounding of the report; else None."""
    allowed = {"epsilon": RELATIVE, "margin": 0.0}
    if not any(f".{name}(" in words for name in allowed):
        return None
    for name in allowed:
        if f".{name}(" in words:
            written = re.search(rf"\.{name}\({NUMBER}\)", words)
            if not written:
                return None
            allowed[name] = float(written.group(1))
    tolerance = max(allowed["epsilon"] * abs(expected), allowed["margin"])
    return tolerance if tolerance > 200 * PRINTED else None  # both numbers rounded: a difference to 0.5 % of it


def comparison_of(words, values, passed):
    """Of two numbers, or None: `1.0272 == Approx( 1.0273 )`, `0.104 < 0.15`, `7 == 7`."""
    found = re.fullmatch(rf"{NUMBER}\s*(==|<=?|>=?)\s*(?:Approx\(\s*)?{NUMBER}(?:\s*\))?", " ".join(values.split()))
    if not found:
        return None
    computed, expected = float(found.group(1)), float(found.group(3))
    relation = found.group(2) if found.group(2) == "==" else found.group(2)[0]
    return Comparison(words, relation, computed, expected, tolerance_of(words, expected), passed)


def run(program, folder):
    """All cases of a test program: name -> (file, seconds, number of checks, failures, comparisons)."""
    report = os.path.join(folder, os.path.basename(program) + ".xml")
    subprocess.run([program, "--success", "--durations", "yes", "--reporter", "xml", "--out", report], check=False)
    cases = {}
    case = None
    for event, node in ElementTree.iterparse(report, events=("start", "end")):
        if event == "start" and node.tag == "TestCase":
            case = {"file": re.search(r"tests/\w+/\w+\.cpp$", node.get("filename")).group(), "checks": 0, "failed": 0,
                    "comparisons": [], "seconds": 0.0}
            cases[node.get("name")] = case
        elif event == "end" and node.tag == "Expression":
            words = " ".join(node.findtext("Original").split())
            passed = node.get("success") == "true"
            case["checks"] += 1
            case["failed"] += not passed
            compared = comparison_of(words, node.findtext("Expanded"), passed)
            if compared:
                case["comparisons"].append(compared)
            node.clear()
        elif event == "end" and node.tag == "TestCase":
            case["seconds"] = float(node.find("OverallResult").get("durationInSeconds"))
            node.clear()
    if not cases:
        raise SystemExit(f"{program} reports no test")
    return cases


def distance(one):
    """Difference of a comparison over its tolerance; to find the worst."""
    if one.relation == "==":
        return abs(one.computed - one.expected) / (one.tolerance or abs(one.expected) or 1)
    share = one.computed / one.expected if one.expected else one.computed
    return share if one.relation == "<" else 1 / share if share else float("inf")


def digits(x):
    """Catch2 prints ten decimals."""
    return f"{x:.6g}" if x else "0 (below 1e-10)"


def expected_words(one):
    return ("" if one.relation == "==" else one.relation + " ") + f"{one.expected:.6g}"


def off_words(one):
    if one.relation != "==" or one.computed == one.expected:
        return ""
    if one.expected == 0:
        return f"{one.computed - one.expected:.1e}"
    return f"{abs(one.computed / one.expected - 1):.1e}"


def rows_of(wanted, cases):
    """The lines of the table. @raise SystemExit  a row whose test or comparison does not exist"""
    lines = []
    for row in wanted:
        case = cases.get(row["test"])
        found = [one for one in (case or {"comparisons": []})["comparisons"] if one.words.startswith(row["check"])]
        if not found:
            raise SystemExit(f"table.toml: no comparison `{row['check']}` of two numbers in the test \"{row['test']}\"")
        if row.get("of", "worst") == "worst":
            worst = max(found, key=distance)
            shown, note = [worst], f" (worst of {len(found)})" if len(found) > 1 else ""
        else:
            shown, note = found, ""
        lines.append("| {}{} | {} | {} | {} | {} | `{}` |".format(
            row["case"], note, row["source"], "; ".join(map(expected_words, shown)),
            "; ".join(digits(one.computed) for one in shown), "; ".join(filter(None, map(off_words, shown))),
            row["test"].replace("|", "\\|")))
    return lines


def all_lines(cases):
    lines = []
    for name, case in cases.items():
        approximate = [one for one in case["comparisons"] if one.relation == "==" and one.tolerance]
        used = max(map(distance, approximate), default=None)
        result = "all pass" if not case["failed"] else f"**{case['failed']} fail**"
        share = "" if used is None else f"{100 * used:.0f} %"
        lines.append(f"| {name} | {case['checks']} | {result} | {share} | {case['seconds']:.1f} |")
    return lines


def page(wanted, cases, commit):
    checks = sum(case["checks"] for case in cases.values())
    failed = sum(case["failed"] for case in cases.values())
    words = ["# Verification", "",
             f"Written by `make verification` on {datetime.date.today()}, floe {commit}: {len(cases)} cases, {checks} checks, "
             f"{failed} failed, on one rank. `make verify-ranks` runs them on 2, 3 and 4.", "",
             "Expected and computed numbers are those that the tests compare, taken from their report; none is typed by hand. "
             "`< x` is a bound that a test sets. *Error* is the relative difference. Sources: closed forms are in the "
             "comment above each test; a `.py` is a program in tests/verification/references, independent of floe and run "
             "by `make references`. The identities (force is the gradient of the energy, joints do no "
             "work, and so on) are in `tests/unit`, on 1 to 4 ranks.", "",
             "| case | source | expected | computed | error | test |", "|---|---|---|---|---|---|"]
    words += rows_of(wanted, cases)
    for title, folder in (("All verification cases", "tests/verification"), ("All convergence cases", "tests/convergence")):
        words += ["", f"## {title}", "",
                  f"`{folder}`. The fourth column is the difference of the worst comparison of a case, in per cent of the difference "
                  "at which it would fail, where the test writes its tolerance as a number. That difference is the larger of the "
                  "relative tolerance times the expected number and the absolute one; where a test writes an absolute one alone, "
                  "Catch2 also takes a relative difference of 1.2e-5. Tolerances below 2e-8 are left out, because the report "
                  "has ten decimals.", "", "| test | checks | result | tolerance used | seconds |",
                  "|---|--:|---|--:|--:|"]
        words += all_lines({name: case for name, case in cases.items() if case["file"].startswith(folder)})
    return "\n".join(words) + "\n", failed


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", default="build")
    parser.add_argument("--out", default="docs/verification.md")
    parser.add_argument("--reports", help="folder for Catch2's reports (default: in the build)")
    choices = parser.parse_args()
    with open(os.path.join(HERE, "table.toml"), "rb") as file:
        wanted = tomllib.load(file)["row"]
    folder = choices.reports or os.path.join(choices.build, "verification")
    os.makedirs(folder, exist_ok=True)
    cases = {}
    for name in ("verification", "convergence"):
        cases.update(run(os.path.join(choices.build, "tests", "test_" + name), folder))
    version = subprocess.run([os.path.join(choices.build, "floe"), "--version"], capture_output=True, text=True, check=True)
    text, failed = page(wanted, cases, version.stdout.split(maxsplit=1)[1].strip())
    with open(choices.out, "w", encoding="utf-8") as file:
        file.write(text)
    print(f"{choices.out}: {len(wanted)} rows, {len(cases)} cases, {failed} failed checks")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
