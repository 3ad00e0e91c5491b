#!/usr/bin/env python3
"""Writes blade.msh (Gmsh 4.1): a tapered, twisted, cambered shell of triangles.

mesh.py [FILE [ALONG ACROSS]]: elements along the span and across the chord. No other program is needed.
Physical surfaces inner, middle and outer are the parts; curves root, tip and leading, and points lead and trail (of the
tip), the places.
"""
import math
import pathlib
import sys

SPAN = 1.2  # m, along x
CHORD = (0.30, 0.15)  # m, at the root and at the tip
TWIST = (30.0, 0.0)  # degrees, about x
CAMBER = (0.04, 0.02)  # height of the arc over its chord
PARTS = ("inner", "middle", "outer")  # a third of the span each


def between(ends, s):
    return ends[0] + s * (ends[1] - ends[0])


def point(s, c):
    """The mid-surface at the share s of the span, c of the chord."""
    chord = between(CHORD, s)
    y, z = (c - 0.5) * chord, 4 * c * (1 - c) * between(CAMBER, s) * chord
    angle = math.radians(between(TWIST, s))
    return s * SPAN, y * math.cos(angle) - z * math.sin(angle), y * math.sin(angle) + z * math.cos(angle)


def blade(along, across):
    """Nodes, triangles of each part, lines of each curve, points: tags count from 1."""
    def tag(i, j):
        return 1 + i * (across + 1) + j

    nodes = [point(i / along, j / across) for i in range(along + 1) for j in range(across + 1)]
    triangles = {part: [] for part in PARTS}
    for i in range(along):
        part = triangles[PARTS[len(PARTS) * i // along]]
        for j in range(across):
            a, b, c, d = tag(i, j), tag(i + 1, j), tag(i + 1, j + 1), tag(i, j + 1)
            part += [(a, b, c), (a, c, d)] if (i + j) % 2 == 0 else [(a, b, d), (b, c, d)]
    lines = {"root": [(tag(0, j), tag(0, j + 1)) for j in range(across)],
             "tip": [(tag(along, j), tag(along, j + 1)) for j in range(across)],
             "leading": [(tag(i, across), tag(i + 1, across)) for i in range(along)]}
    return nodes, triangles, lines, {"trail": [(tag(along, 0),)], "lead": [(tag(along, across),)]}


def write(path, nodes, *groups):
    """`groups` of surfaces, curves and points: elements by name."""
    kinds = [(2, 2), (1, 1), (0, 15)]  # dimension, Gmsh's type of element
    blocks = [(dimension, kind, name, elements)
              for (dimension, kind), group in zip(kinds, groups) for name, elements in group.items()]
    box = " ".join(f"{pick(x[i] for x in nodes):.17g}" for pick in (min, max) for i in range(3))
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", f"{len(blocks)}"]
    lines += [f'{dimension} {n} "{name}"' for n, (dimension, _, name, _) in enumerate(blocks, 1)]
    lines += ["$EndPhysicalNames", "$Entities", " ".join(str(sum(b[0] == d for b in blocks)) for d in range(4))]
    for n, (dimension, _, _, elements) in sorted(enumerate(blocks, 1), key=lambda block: block[1][0]):
        place = " ".join(f"{x:.17g}" for x in nodes[elements[0][0] - 1]) if dimension == 0 else box
        lines.append(f"{n} {place} 1 {n}" + (" 0" if dimension else ""))
    lines += ["$EndEntities", "$Nodes", f"1 {len(nodes)} 1 {len(nodes)}", f"2 1 0 {len(nodes)}"]
    lines += [str(n) for n in range(1, len(nodes) + 1)]
    lines += [" ".join(f"{x:.17g}" for x in node) for node in nodes]
    count = sum(len(elements) for *_, elements in blocks)
    lines += ["$EndNodes", "$Elements", f"{len(blocks)} {count} 1 {count}"]
    last = 0
    for n, (dimension, kind, _, elements) in enumerate(blocks, 1):
        lines.append(f"{dimension} {n} {kind} {len(elements)}")
        for element in elements:
            last += 1
            lines.append(" ".join(map(str, (last, *element))))
    lines += ["$EndElements", ""]
    pathlib.Path(path).write_text("\n".join(lines))


if __name__ == "__main__":
    words = sys.argv[1:]
    target = words[0] if words else pathlib.Path(__file__).with_name("blade.msh")
    sizes = [int(word) for word in words[1:3]] or [114, 30]
    write(target, *blade(*sizes))
