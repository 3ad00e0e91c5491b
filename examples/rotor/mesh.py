#!/usr/bin/env python3
"""Writes blade.inp (CalculiX/Abaqus): a tapered, twisted blade of S4 shells with places root, tip and aft. No other program is needed."""
import math
import pathlib

ROOT, SPAN = 0.15, 2.0  # m along x, from the axis
CHORD, TWIST = (0.18, 0.10), (14.0, 4.0)  # m, degrees about x, at the root and at the tip
ALONG, ACROSS = 16, 3
THICKNESS = {"INNER": 0.008, "OUTER": 0.005}  # m, of the halves


def point(s, c):
    chord, angle = (a + s * (b - a) for a, b in (CHORD, TWIST))
    angle = math.radians(angle)
    y = (c - 0.25) * chord  # the quarter chord is straight
    return ROOT + s * (SPAN - ROOT), y * math.cos(angle), -y * math.sin(angle)


def number(i, j):
    return 1 + i * (ACROSS + 1) + j


def main():
    lines = ["** A blade along x; lengths in m.", "*NODE"]
    for i in range(ALONG + 1):
        for j in range(ACROSS + 1):
            lines.append(f"{number(i, j)}, " + ", ".join(f"{x:.6f}" for x in point(i / ALONG, j / ACROSS)))
    for part, first in (("INNER", 0), ("OUTER", ALONG // 2)):
        lines.append(f"*ELEMENT, TYPE=S4, ELSET={part}")
        for i in range(first, first + ALONG // 2):
            for j in range(ACROSS):
                corners = (number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1))
                lines.append(f"{1 + i * ACROSS + j}, " + ", ".join(map(str, corners)))
    for name, nodes in (("ROOT", [number(0, j) for j in range(ACROSS + 1)]),
                        ("TIP", [number(ALONG, 1)]), ("AFT", [number(ALONG, ACROSS)])):
        lines += [f"*NSET, NSET={name}", ", ".join(map(str, nodes))]
    lines += ["*MATERIAL, NAME=ALUMINIUM", "*ELASTIC", "7.0E10, 0.33", "*DENSITY", "2700."]
    for part, thickness in THICKNESS.items():
        lines += [f"*SHELL SECTION, ELSET={part}, MATERIAL=ALUMINIUM", f"{thickness}"]
    (pathlib.Path(__file__).parent / "blade.inp").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
