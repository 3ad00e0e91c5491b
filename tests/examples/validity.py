#!/usr/bin/env python3
"""Validity warnings of the examples, as they are: none but those that their pages explain.

validity.py FLOE: 0 if all is as it should be. Not here: blade, whose mesh a script makes, and rotating_blade, which has no
motion (its Campbell diagram is a test of its own).
"""
import json
import pathlib
import subprocess
import sys
import tempfile

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
# What the warnings are about: the paper's beam bends beyond one frame's strains, the satellite's panels within elements.
EXPECTED = {"start": set(), "cantilever": {"slope"}, "pendulum": set(), "slider_crank": set(), "robot_arm": set(), "spin_up": set(),
            "shaken_plate": set(), "controlled_arm": set(), "satellite": {"mesh"}, "rotor": set()}


def main():
    floe, failed = pathlib.Path(sys.argv[1]).resolve(), 0
    with tempfile.TemporaryDirectory() as folder:
        for example, expected in EXPECTED.items():
            done = subprocess.run([floe, "run", EXAMPLES / example / "scene.yaml", "-o", example, "--no-estimate"], cwd=folder,
                                  capture_output=True, text=True, timeout=200)
            assert done.returncode == 0, f"{example}:\n{done.stdout}{done.stderr}"
            summary = json.loads((pathlib.Path(folder) / example / "summary.json").read_text())
            found = {line["what"] for line in summary.get("out_of_range", [])}
            if found != expected:
                failed += 1
                print(f"FAIL {example}: {sorted(found)}, not {sorted(expected)}: {summary['warnings']}", flush=True)
    print(f"{len(EXPECTED)} examples, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
