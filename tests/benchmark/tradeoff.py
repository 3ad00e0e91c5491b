#!/usr/bin/env python3
"""make tradeoff: floe tradeoff for every example with a simulation, and docs/tradeoff.md with its tables and pictures."""
import argparse
import datetime
import json
import os
import shutil
import subprocess
import sys

# In the order of the document. rotating_blade has no simulation, only spectra.
EXAMPLES = ["cantilever", "robot_arm", "pendulum", "slider_crank", "spin_up", "start", "controlled_arm", "shaken_plate", "satellite",
            "rotor", "blade"]
NOTES = "tradeoff_notes.md"


def measure(floe, example, folder, limit):
    """None, or why there are no results."""
    if example == "blade" and not os.path.exists("examples/blade/blade.msh"):
        subprocess.run([sys.executable, "examples/blade/mesh.py"], check=True)
    command = [floe, "tradeoff", f"examples/{example}/scene.yaml", "-o", folder, "--force"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit, check=False)
    except subprocess.TimeoutExpired:
        return f"not within {limit} s"
    return None if done.returncode == 0 else done.stderr.strip().splitlines()[-1]


def effectivity(variants):
    """Of every model with a whole estimate: estimated over true total of the worst probe, errors from 1e-4 % to 30 %."""
    ratios = []
    for variant in variants:
        if variant["stopped"] or "required" in variant or variant["estimate_lacks"] or not variant["estimate"] or None in variant["total"] + variant["estimate"]:
            continue
        error = max(variant["total"])
        if 1e-6 < error < 0.3:
            ratios.append(max(variant["estimate"]) / error)
    return ratios


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return next((line.split(":")[1].strip() for line in file if line.startswith("model name")), "unknown processor")


def section(example, folder, out):
    with open(os.path.join(folder, "tradeoff.json"), encoding="utf-8") as file:
        found = json.load(file)
    with open(os.path.join(folder, "tradeoff.md"), encoding="utf-8") as file:
        page = file.read().strip()
    lines = [f"## {found['title']}", ""]
    picture = os.path.join(folder, "tradeoff.png")
    if os.path.exists(picture):
        shutil.copyfile(picture, os.path.join(out, f"tradeoff_{example}.png"))
        lines += [f"![Total error versus computing time, {found['title']}](tradeoff_{example}.png)", ""]
    made = found["provenance"]["floe"]
    lines += [page, "", f"Measured with floe {made['version']} ({made['commit']}).", ""]
    ratios = sorted(effectivity(found["variants"]))
    if ratios:
        inside = sum(0.3 <= ratio <= 3 for ratio in ratios)
        lines += [f"Ratio of estimated and true total (reduced models with errors from 1e-4 % to 30 %): {ratios[0]:.2g} to "
                  f"{ratios[-1]:.2g}, median {ratios[len(ratios) // 2]:.2g}; {inside} of {len(ratios)} between 0.3 and 3.", ""]
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--floe", required=True)
    parser.add_argument("--out", default="docs")
    parser.add_argument("--work", default="results/tradeoff")
    parser.add_argument("--limit", type=int, default=3600, help="seconds for an example (default: 3600)")
    parser.add_argument("--reuse", action="store_true", help="take results that are in --work already as they are")
    parser.add_argument("examples", nargs="*", default=EXAMPLES)
    arguments = parser.parse_args()
    sections, any_result, failed = [], False, []
    for example in arguments.examples:
        folder = os.path.join(arguments.work, example)
        there = arguments.reuse and os.path.exists(os.path.join(folder, "tradeoff.json"))
        why = None if there else measure(os.path.abspath(arguments.floe), example, folder, arguments.limit)
        print(f"{example}: {why or 'done'}", flush=True)
        if why:
            failed.append(example)
            sections += [f"## {example}", "", f"No result: {why}.", ""]
            continue
        sections += section(example, folder, arguments.out)
        any_result = True
    left_out = [example for example in EXAMPLES if example not in arguments.examples]
    if left_out:
        sections += ["## Examples that were not simulated for this page", "",
                     f"{', '.join(left_out)}: `makefiles/tradeoff.sh build {' '.join(EXAMPLES)}` (`make tradeoff`) writes the page with all "
                     "examples; `floe tradeoff examples/NAME/scene.yaml` writes one of them.", ""]
    if any_result:
        with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), NOTES), encoding="utf-8") as file:
            notes = file.read().strip()
        date = datetime.date.today().isoformat()
        head = ["# Accuracy versus computing time", "", notes, "",
                f"Written by `make tradeoff` on {date}, {processor()}.", ""]
        with open(os.path.join(arguments.out, "tradeoff.md"), "w", encoding="utf-8") as file:
            file.write("\n".join(head + sections).rstrip() + "\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
