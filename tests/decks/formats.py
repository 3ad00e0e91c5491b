#!/usr/bin/python3
"""A plate and a frame as .inp, .bdf (small, large and free field) and .msh (2.2): the same frequencies to 1e-10; plates,
a curved panel and the frame of second order as .inp and .msh, the panel as .bdf. Where ccx is installed also within 1 % of CalculiX on the
same nodes (2 % for triangles of second order).

Plates by their stiffness (*SHELL GENERAL SECTION, MID2 of PSHELL) as by their thickness to 1e-10; two bars joined by a CBUSH against
the closed form; a panel with a SPRINGA against CalculiX.

    tests/decks/formats.py FLOE"""
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import h5py

E, NU, RHO = 2.1e11, 0.3, 7800.0


def plate(nx=60, ny=40):
    """A free plate of 1 by 0.6 m, 5 mm thick."""
    nodes = {j * (nx + 1) + i + 1: (i / nx, 0.6 * j / ny, 0.0) for j in range(ny + 1) for i in range(nx + 1)}
    cells = []
    for j in range(ny):
        for i in range(nx):
            a = j * (nx + 1) + i + 1
            cells.append((a, a + 1, a + nx + 2, a + nx + 1))
    return {"nodes": nodes, "shells": cells, "beams": [], "thickness": 0.005, "fixed": []}


def frame():
    """A portal of bars of 20 by 30 mm, 1 m high and 1.5 m wide, with a leg to the back, clamped at its feet."""
    n = 60
    points = [(0, 0, 0), (0, 0, 1.0), (1.5, 0, 1.0), (1.5, 0, 0), (0, 0.8, 0)]
    nodes, at, beams = {}, {}, []
    for k, p in enumerate(points):
        nodes[k + 1], at[k] = p, k + 1
    for group, (a, b) in enumerate([(0, 1), (1, 2), (2, 3), (1, 4)]):
        last = at[a]
        for i in range(1, n + 1):
            if i == n:
                here = at[b]
            else:
                here = len(nodes) + 1
                nodes[here] = tuple(points[a][c] + (points[b][c] - points[a][c]) * i / n for c in range(3))
            beams.append((last, here, group))
            last = here
    return {"nodes": nodes, "shells": [], "beams": beams, "thickness": 0, "fixed": [1, 4, 5]}


def panel(nx, ny, triangles, radius=None):
    """A free plate of second order of 1 by 0.6 m, 5 mm thick, or the same bent about x to a radius."""
    def place(i, j):
        x, y = i / (2 * nx), 0.6 * j / (2 * ny)
        if radius is None:
            return (x, y, 0.0)
        a = (y - 0.3) / radius
        return (x, radius * math.sin(a), radius * math.cos(a))
    numbers, nodes, cells = {}, {}, []
    def node(i, j):
        if (i, j) not in numbers:
            numbers[i, j] = len(numbers) + 1
            nodes[numbers[i, j]] = place(i, j)
        return numbers[i, j]
    for j in range(0, 2 * ny, 2):
        for i in range(0, 2 * nx, 2):
            c = [node(i, j), node(i + 2, j), node(i + 2, j + 2), node(i, j + 2)]
            e = [node(i + 1, j), node(i + 2, j + 1), node(i + 1, j + 2), node(i, j + 1)]
            if triangles:
                m = node(i + 1, j + 1)
                cells += [(c[0], c[1], c[2], e[0], e[1], m), (c[0], c[2], c[3], m, e[2], e[3])]
            else:
                cells.append((*c, *e))
    return {"nodes": nodes, "shells": cells, "beams": [], "thickness": 0.005, "fixed": []}


def curved_frame():
    """The same portal of beams of three nodes."""
    model = frame()
    beams = model["beams"]
    model["beams"] = [(a, b, g, m) for (a, m, g), (_, b, _) in zip(beams[::2], beams[1::2])]
    return model


DIRECTIONS = [(1, 0, 0), (0, 0, 1), (1, 0, 0), (1, 0, 0)]  # of the 20 mm side, of each member
WIDTH, HEIGHT = 0.02, 0.03
# CalculiX has one solid element across the section, whose warping is at most x y: its torsion constant is
# a^3 b^3 / (3 (a^2 + b^2)), 18 % above Saint-Venant's.
SOLID_TORSION = (WIDTH * HEIGHT)**3 / (3 * (WIDTH**2 + HEIGHT**2))


def inp(model, second=False, torsion=None):
    lines = ["*NODE"] + [f"{k}, {x!r}, {y!r}, {z!r}" for k, (x, y, z) in model["nodes"].items()]
    if model["shells"]:
        kind = {4: "S4", 6: "S6", 8: "S8R"}[len(model["shells"][0])]
        lines += [f"*ELEMENT, TYPE={kind}, ELSET=SKIN"]
        lines += [f"{i + 1}, " + ", ".join(map(str, c)) for i, c in enumerate(model["shells"])]
    for group in sorted({b[2] for b in model["beams"]}):
        if len(model["beams"][0]) == 4:
            lines += [f"*ELEMENT, TYPE=B32R, ELSET=BAR{group}"]
            lines += [f"{i + 1}, {b[0]}, {b[3]}, {b[1]}" for i, b in enumerate(model["beams"]) if b[2] == group]
            continue
        rows = [(i, a, b) for i, (a, b, g) in enumerate(model["beams"]) if g == group]
        if second:  # elements of three of the same nodes
            lines += [f"*ELEMENT, TYPE=B32R, ELSET=BAR{group}"]
            lines += [f"{i + 1}, {a}, {b}, {c}" for (i, a, b), (_, _, c) in zip(rows[::2], rows[1::2])]
            continue
        lines += [f"*ELEMENT, TYPE=B31, ELSET=BAR{group}"]
        lines += [f"{i + 1}, {a}, {b}" for i, a, b in rows]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{E}, {NU}", "*DENSITY", f"{RHO}"]
    if model["shells"]:
        lines += ["*SHELL SECTION, ELSET=SKIN, MATERIAL=STEEL", f"{model['thickness']}"]
    for group in sorted({b[2] for b in model["beams"]}):
        direction = ", ".join(f"{float(x)}" for x in DIRECTIONS[group])
        if torsion:
            lines += [f"*BEAM GENERAL SECTION, ELSET=BAR{group}, DENSITY={RHO}",
                      f"{WIDTH * HEIGHT!r}, {WIDTH * HEIGHT**3 / 12!r}, 0.0, {HEIGHT * WIDTH**3 / 12!r}, {torsion!r}", direction,
                      f"{E}, {E / 2 / (1 + NU)!r}"]
        else:
            lines += [f"*BEAM SECTION, ELSET=BAR{group}, MATERIAL=STEEL, SECTION=RECT", f"{WIDTH}, {HEIGHT}", direction]
    if model["fixed"]:
        lines += ["*NSET, NSET=SPC1", ", ".join(map(str, model["fixed"])), "*BOUNDARY", "SPC1, 1, 6"]
    return "\n".join(lines) + "\n*STEP\n*FREQUENCY\n16\n*END STEP\n"


def tied(model):
    """The plate in two halves with nodes of their own, tied along the nodes at the same points."""
    middle = sorted({n for c in model["shells"][:len(model["shells"]) // 2] for n in c} & {n for c in model["shells"][len(model["shells"]) // 2:] for n in c})
    copies = {n: len(model["nodes"]) + 1 + i for i, n in enumerate(middle)}
    half = len(model["shells"]) // 2
    whole = dict(model, nodes={**model["nodes"], **{copies[n]: model["nodes"][n] for n in middle}},
                 shells=model["shells"][:half] + [tuple(copies.get(n, n) for n in c) for c in model["shells"][half:]])
    edge = lambda cells, nodes: [f"{i + 1}, S{k + 3}" for i, c in cells for k in range(4) if {c[k], c[(k + 1) % 4]} <= nodes]
    cells = list(enumerate(whole["shells"]))
    more = ["*SURFACE, NAME=LOWER"] + edge(cells[:half], set(middle)) + ["*SURFACE, NAME=UPPER"] + edge(cells[half:], set(copies.values()))
    return inp(whole).replace("*STEP", "\n".join(more) + "\n*TIE, NAME=T\nUPPER, LOWER\n*STEP")


def moved(model):
    """The plate as a part of Abaqus, whose instance is moved and turned."""
    part, rest = inp(model).split("*MATERIAL")
    materials, section = rest.split("*SHELL SECTION")
    section, step = section.split("*STEP")
    return (f"*PART, NAME=P\n{part}*SHELL SECTION{section}*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=P-1, PART=P\n1., 2., 3.\n"
            f"0., 0., 0., 1., 1., 0., 70.\n*END INSTANCE\n*END ASSEMBLY\n*MATERIAL{materials}*STEP{step}")


def one_of_two(model):
    """The same beside a second instance of it, of another part and tied to it at a place of both."""
    text = moved(model)
    second = re.sub(r"(\*SHELL SECTION.*\n).*", r"\g<1>1.", text[text.index("*PART"):text.index("*ASSEMBLY")].replace("NAME=P\n", "NAME=Q\n"))
    joint = ("*NSET, NSET=HERE, INSTANCE=P-1\n1\n*NSET, NSET=THERE, INSTANCE=Q-1\n2\n*SURFACE, NAME=A, TYPE=NODE\nHERE\n"
             "*SURFACE, NAME=B, TYPE=NODE\nTHERE\n*TIE, NAME=T\nB, A\n*NODE\n1, 0, 0, 0\n*NSET, NSET=HUB\n1\n"
             "*COUPLING, REF NODE=HUB, SURFACE=B\n*KINEMATIC\n")
    return text.replace("*ASSEMBLY", second + "*ASSEMBLY").replace(
        "*END ASSEMBLY", "*INSTANCE, NAME=Q-1, PART=Q\n*END INSTANCE\n" + joint + "*END ASSEMBLY")


def rigid_end(model, columns, rows):
    """The plate, clamped at x = 0, with its last two columns of nodes rigidly on a mass beside it."""
    nodes = dict(model["nodes"])
    mass, rotation = len(nodes) + 1, len(nodes) + 2
    nodes.update({mass: (1.2, 0.3, 0.1), rotation: (1.2, 0.3, 0.1)})
    ends = [j * (columns + 1) + i + 1 for j in range(rows + 1) for i in (columns - 2, columns - 1, columns)]
    more = (f"*ELEMENT, TYPE=MASS, ELSET=M\n100000, {mass}\n*MASS, ELSET=M\n5.\n*NSET, NSET=END\n" + "".join(f"{n},\n" for n in ends)
            + f"*RIGID BODY, NSET=END, REF NODE={mass}, ROT NODE={rotation}\n")
    fixed = [j * (columns + 1) + 1 for j in range(rows + 1)]
    text = inp(dict(model, nodes=nodes, fixed=[]))
    return text.replace("*STEP", more + "*NSET, NSET=SPC1\n" + "".join(f"{n},\n" for n in fixed) + "*BOUNDARY\nSPC1, 1, 6\n*STEP")


def card(form, name, *fields):
    """One card in small, large or free field."""
    words = ["" if f is None else f if isinstance(f, str) else repr(f) if isinstance(f, float) else str(f) for f in fields]
    if form == "free":
        rows = [words[i:i + 8] for i in range(0, len(words), 8)]
        return "\n".join(",".join([name if k == 0 else ""] + row) for k, row in enumerate(rows)) + "\n"
    size, per, mark = (16, 4, "*") if form == "large" else (8, 8, "")
    rows = [words[i:i + per] for i in range(0, len(words), per)]
    assert all(len(w) <= size for w in words) or form == "small"
    return "\n".join(f"{(name if k == 0 else '') + mark if k == 0 or mark else '':8s}" + "".join(w.rjust(size) for w in row)
                     for k, row in enumerate(rows)) + "\n"


def short(x):
    """A number of at most 16 characters that reads back as the same, or as near as may be."""
    return repr(x) if len(repr(x)) <= 16 else f"{x:.10g}" if "e" in f"{x:.10g}" else f"{x:.14f}"[:16]


def bdf(model, form, torsion=None):
    text = "SOL 103\nCEND\nMETHOD = 1\nBEGIN BULK\n"
    for k, (x, y, z) in model["nodes"].items():
        text += card("free" if form == "free" else "large", "GRID", k, None, *(short(float(v)) if form != "free" else float(v) for v in (x, y, z)))
    for i, c in enumerate(model["shells"]):
        text += card(form, {4: "CQUAD4", 6: "CTRIA6", 8: "CQUAD8"}[len(c)], i + 1, 3, *c)
    for i, (a, b, g) in enumerate(model["beams"]):
        text += card(form, "CBAR", i + 1, 5, a, b, *map(float, DIRECTIONS[g]))
    text += card("free", "MAT1", 1, E, None, NU, RHO)
    if model["shells"]:
        text += card(form, "PSHELL", 3, 1, model["thickness"], 1)
    elif torsion:
        text += card("free", "PBAR", 5, 1, WIDTH * HEIGHT, HEIGHT * WIDTH**3 / 12, WIDTH * HEIGHT**3 / 12, torsion)
    else:
        text += card(form, "PBARL", 5, 1, None, "BAR", None, None, None, None, HEIGHT, WIDTH)
    if model["fixed"]:
        text += card(form, "SPC1", 1, 123456, *model["fixed"])
    return text + "ENDDATA\n"


def msh(model):
    text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n6\n0 9 \"SPC1\"\n2 8 \"SKIN\"\n"
    text += "".join(f"1 {g + 1} \"BAR{g}\"\n" for g in range(4)) + "$EndPhysicalNames\n"
    text += f"$Nodes\n{len(model['nodes'])}\n" + "".join(f"{k} {x!r} {y!r} {z!r}\n" for k, (x, y, z) in model["nodes"].items())
    rows = [f"15 2 9 1 {k}" for k in model["fixed"]]
    rows += [f"{8 if len(b) == 4 else 1} 2 {b[2] + 1} 1 " + " ".join(map(str, (b[0], b[1], *b[3:]))) for b in model["beams"]]
    rows += [f"{ {4: 3, 6: 9, 8: 16}[len(c)] } 2 8 1 " + " ".join(map(str, c)) for c in model["shells"]]
    return text + f"$EndNodes\n$Elements\n{len(rows)}\n" + "".join(f"{i + 1} {r}\n" for i, r in enumerate(rows)) + "$EndElements\n"


def scene(path, model, instance=None):
    own = ""
    if path.endswith(".msh"):
        material = f"material: {{E: {E}, nu: {NU}, rho: {RHO}}}"
        if model["shells"]:
            own = f"    section: {{thickness: {model['thickness']}}}\n    {material}\n"
        else:
            own = f"    {material}\n    parts:\n" + "".join(
                f"      BAR{g}: {{section: {{shape: rectangle, width: {WIDTH}, height: {HEIGHT}, orientation: {list(d)}}}}}\n"
                for g, d in enumerate(DIRECTIONS))
    held = "joints: {foot: {type: fixed, between: [ground, b.SPC1]}}\n" if model["fixed"] else ""
    chosen = f", instance: {instance}" if instance else ""
    frame_of = "" if model["fixed"] else "    frame: mean-axis\n"
    return f"bodies:\n  b:\n    mesh: {{file: {{path: {path}{chosen}}}}}\n    reduction: {{modes: 10}}\n{frame_of}{own}{held}"


def frequencies(floe, folder, name, text, model, instance=None):
    (folder / name).write_text(text)
    (folder / "scene.yaml").write_text(scene(name, model, instance))
    done = subprocess.run([floe, "reduce", "scene.yaml", "--force", "-o", "b.h5"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, f"{name}: {done.stderr or done.stdout}"
    with h5py.File(folder / "b.h5") as file:
        return [float(omega) / (2 * math.pi) for omega in file["frequencies/omega"]]


def mass_properties(floe, folder, text):
    """Mass, centre of gravity and second moments int rho x x' about it (xx, yy, zz, xy, xz, yz), by `floe check`."""
    (folder / "part.inp").write_text(text)
    done = subprocess.run([floe, "check", "part.inp"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    rows = [[float(w) for w in line.split()[1:8]] for line in done.stdout.splitlines() if re.match(r"body +[-\d.e+]+ +[-\d.e+]+ +[-\d.e+]+ ", line)]
    (mass, x, y, z, *_), (xx, yy, zz, xy, xz, yz) = [r for r in rows if len(r) in (6, 7)][-2:]
    half = (xx + yy + zz) / 2
    return mass, (x, y, z), (half - xx, half - yy, half - zz, -xy, -xz, -yz)


def calculix_mass(folder, text):
    """The same by CalculiX (EMAS), of a deck that a static step follows."""
    (folder / "ccx.inp").write_text(text[:text.index("*STEP")] + "*BOUNDARY\n1, 1, 6\n*STEP\n*STATIC\n*CLOAD\n9, 1, 1.\n"
                                    "*EL PRINT, ELSET=SKIN, TOTALS=ONLY\nEMAS\n*END STEP\n")
    subprocess.run(["ccx", "ccx"], cwd=folder, capture_output=True, text=True, timeout=600)
    numbers = [[float(w) for w in line.split()] for line in (folder / "ccx.dat").read_text().splitlines()
               if re.fullmatch(r"(\s+[-\d.]+E[+-]\d+)+\s*", line)]
    return numbers[0][0], tuple(numbers[2]), tuple(numbers[3])


def calculix(folder, text, count, rigid):
    (folder / "ccx.inp").write_text(text)
    subprocess.run(["ccx", "ccx"], cwd=folder, capture_output=True, text=True, timeout=600)
    rows = re.findall(r"^\s+\d+\s+([\d.E+-]+)\s+([\d.E+-]+)\s+([\d.E+-]+)\s+[\d.E+-]+\s*$", (folder / "ccx.dat").read_text(), re.M)
    return [float(r[2]) for r in rows][rigid:rigid + count]


def by_stiffness(model):
    """The plate by the 21 numbers of its stiffness, and by another material that bends."""
    t = model["thickness"]
    numbers = lambda c: [c, NU * c, c, 0.0, 0.0, (1 - NU) / 2 * c]
    a, d = numbers(E * t / (1 - NU**2)), numbers(E * t**3 / 12 / (1 - NU**2))
    values = a + [0.0, 0.0, 0.0, d[0], 0.0, 0.0, 0.0, d[1], d[2], 0.0, 0.0, 0.0, 0.0, 0.0, d[5]]
    lines = "\n".join(", ".join(map(repr, values[i:i + 8])) for i in (0, 8, 16))
    text = inp(model).replace(f"*SHELL SECTION, ELSET=SKIN, MATERIAL=STEEL\n{t}", f"*SHELL GENERAL SECTION, ELSET=SKIN, DENSITY={RHO * t!r}\n{lines}")
    bends = bdf(model, "free").replace(card("free", "PSHELL", 3, 1, t, 1), card("free", "PSHELL", 3, 1, t, 2, 1.5) + card("free", "MAT1", 2, E / 1.5, None, NU))
    assert "GENERAL" in text and "1.5" in bends
    return text, bends


def sprung_roots(length, stiffness, bending, count):
    """beta of the symmetric modes of two equal bars, free at their outer ends, joined by a rotational spring:
    w_xxx(0) = 0, EI w_xx(0) = 2 k w_x(0), w_xx(L) = w_xxx(L) = 0."""
    def f(beta):
        x, k = beta * length, 4 * stiffness / (bending * beta)
        c, s, ch, sh = math.cos(x), math.sin(x), math.cosh(x), math.sinh(x)
        return (ch - c) * (ch - c + k * sh) - (s + sh) * (sh - s + k * ch)
    roots, step = [], 0.02 / length
    at = step
    while len(roots) < count:
        low, high = at, at + step
        if f(low) * f(high) < 0:
            for _ in range(80):
                middle = (low + high) / 2
                low, high = (low, middle) if f(low) * f(middle) <= 0 else (middle, high)
            roots.append(low)
        at += step
    return roots


def sprung(floe):
    """@return  whether two bars with a spring between them have the frequencies of the closed form"""
    n, length, side, stiffness = 20, 1.0, 0.004, 13.0
    bending, line = E * side**4 / 12, RHO * side**2
    text = "BEGIN BULK\n" + card("free", "MAT1", 1, E, None, NU, RHO)
    text += card("free", "PBAR", 5, 1, side**2, side**4 / 12, side**4 / 12, 0.1406 * side**4)
    for half, first in ((-1, 1), (1, 101)):
        for i in range(n + 1):
            text += card("free", "GRID", first + i, None, half * length * i / n, 0.0, 0.0)
        for i in range(n):
            text += card("free", "CBAR", first + i, 5, first + i, first + i + 1, 0.0, 1.0, 0.0)
    text += card("free", "CBUSH", 500, 7, 1, 101, None, None, None, 0)
    text += card("free", "PBUSH", 7, "K", 1e10, 1e10, 1e10, 1e8, stiffness, stiffness) + "ENDDATA\n"
    with tempfile.TemporaryDirectory() as scratch:
        (pathlib.Path(scratch) / "bars.bdf").write_text(text)
        done = subprocess.run([floe, "check", "bars.bdf", "--frequencies", "6"], cwd=scratch, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        own = [float(f) for f in re.findall(r"^body +\d+ +([-+.\de]+)$", done.stdout, re.M)][-6:]
    symmetric = sprung_roots(length, stiffness, bending, 2)
    betas = sorted(2 * [symmetric[0], symmetric[1], math.sqrt(61.672822868) / (2 * length)])
    exact = [beta**2 * math.sqrt(bending / line) / (2 * math.pi) for beta in betas]
    error = max(abs(a / b - 1) for a, b in zip(own, exact))
    print(f"spring closed form {error:.1e} of 1e-04: " + " ".join(f"{a:.5g}/{b:.5g}" for a, b in zip(own, exact)))
    return len(own) == 6 and error <= 1e-4


def hinged(floe):
    """@return  whether a RBE2 of 123 holds two edges of a plate as supports of x, y, z do, and one of 123456 clamps them"""
    model = plate(24, 16)
    edges = [[k for k, x in model["nodes"].items() if x[0] == side] for side in (0, 1)]
    supports = "".join(card("free", "SPC1", s + 7, 123, *edge) for s, edge in enumerate(edges))
    link = lambda which: "GRID,9001,,-.1,.3,.2\n" + card("free", "RBE2", 9001, 9001, which, *edges[0], *edges[1])
    scene = "bodies: {plate: {mesh: {file: {path: part.bdf}}, reduction: {modes: 6}}}\njoints:\n"
    held = "".join(f"  j{s}: {{type: support, between: [ground, plate.SPC{s + 7}], hold: [x, y, z]}}\n" for s in (0, 1))
    fixed = "  j: {type: fixed, between: [ground, {body: plate, node: [-.1, .3, .2]}]}\n"
    found = {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name, cards, joints in (("supports", supports, held), ("123", link(123), fixed),
                                    ("123456", link(123456), fixed)):
            (folder / "part.bdf").write_text(bdf(model, "free").replace("ENDDATA", cards + "ENDDATA"))
            (folder / "scene.yaml").write_text(scene + joints)
            done = subprocess.run([floe, "check", "scene.yaml", "--frequencies", "6"], cwd=folder, capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
            found[name] = [float(row[1]) for row in re.findall(r"^plate +\d+ +(\S+) +([.\de+]+)$", done.stdout, re.M)]
        # on one line: a hinge within the body; its arm has no mass, so that the plate is free but for a rigid edge
        one_line, rigid = ("GRID,9001,,-.1,.3,.2\n" + card("free", "RBE2", 9001, 9001, which, *edges[0])
                           for which in (123, 123456))
        for name, cards in (("free", ""), ("hinge", one_line), ("rigid", rigid)):
            (folder / "part.bdf").write_text(bdf(model, "free").replace("ENDDATA", cards + "ENDDATA"))
            done = subprocess.run([floe, "check", "part.bdf", "--frequencies", "6"], cwd=folder, capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
            found[name] = [float(f) for f in re.findall(r"^body +\d+ +([-+.\de]+)\b", done.stdout, re.M)[-6:]]
        assert len(found["hinge"]) == 6, done.stdout
        ordered = all(a < b < c for a, b, c in zip(found["free"], found["hinge"], found["rigid"]))
        print("RBE2 123 on one line, between a free and a rigid edge: " + " ".join(f"{f:.5g}" for f in found["hinge"]))
    error = max(abs(a / b - 1) for a, b in zip(found["123"], found["supports"]))
    print(f"RBE2 123 as supports {error:.1e} of 1e-03: " + " ".join(f"{a:.5g}/{b:.5g}" for a, b in zip(found["123"], found["supports"])))
    print(f"RBE2 123456: {found['123456'][0] / found['123'][0]:.3g} times the first frequency")
    return len(found["123"]) == 6 and error <= 1e-3 and ordered and found["123456"][0] > 2 * found["123"][0]


def with_spring(model, nodes, stiffness):
    """The deck with a SPRINGA between two nodes."""
    more = f"*ELEMENT, TYPE=SPRINGA, ELSET=SPRING\n100000, {nodes[0]}, {nodes[1]}\n*SPRING, ELSET=SPRING\n\n{stiffness}\n"
    return inp(model).replace("*STEP", more + "*STEP")


def sprung_panel(floe):
    """@return  whether a curved panel whose corners a spring joins is within 1 % of CalculiX, and the spring matters"""
    model = panel(12, 8, False, 0.5)
    corners = [min(model["nodes"], key=lambda k: (model["nodes"][k][0], sign * model["nodes"][k][1])) for sign in (1, -1)]
    text = with_spring(model, corners, 2e5)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        own, without = (frequencies(floe, folder, "part.inp", t, model) for t in (text, inp(model)))
        shift = max(abs(a / b - 1) for a, b in zip(own, without))
        print(f"SPRINGA moves a frequency by {shift:.1%}")
        if not shutil.which("ccx"):
            return shift > 0.03
        reference = calculix(folder, text, 10, 6)
        error = max(abs(a / b - 1) for a, b in zip(own, reference))
        print(f"SPRINGA CalculiX  {error:.2%} of 1%: " + " ".join(f"{f:.4g}/{r:.4g}" for f, r in zip(own, reference)))
        return shift > 0.03 and len(reference) == 10 and error <= 0.01


def second_order(floe):
    """@return  whether all is within its limit"""
    good = True
    # S8R on the same nodes; S6 of CalculiX is a solid wedge, too stiff in bending where the mesh is coarse
    for name, model, tolerance in (("plate S8R", panel(12, 8, False), 0.01), ("panel S8R", panel(12, 8, False, 0.5), 0.01),
                                   ("plate S6", panel(24, 16, True), 0.02), ("frame B32R", curved_frame(), 0.01)):
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            own = frequencies(floe, folder, "part.inp", inp(model), model)
            other = frequencies(floe, folder, "part.msh", msh(model), model)
            error = max(abs(a / b - 1) for a, b in zip(own, other))
            print(f"{name:10s} msh 2.2   {error:.1e} of 1e-10")
            good &= len(own) == 10 and error <= 1e-10
            if model["shells"]:
                other = frequencies(floe, folder, "part.bdf", bdf(model, "free"), model)
                error = max(abs(a / b - 1) for a, b in zip(own, other))
                print(f"{name:10s} bdf free  {error:.1e} of 1e-10")
                good &= len(other) == 10 and error <= 1e-10
            if not shutil.which("ccx"):
                continue
            reference = calculix(folder, inp(model), 10, 0 if model["fixed"] else 6)
            if model["beams"]:
                own = frequencies(floe, folder, "part.inp", inp(model, torsion=SOLID_TORSION), model)
            errors = [a / b - 1 for a, b in zip(own, reference)]
            print(f"{name:10s} CalculiX  {max(map(abs, errors)):.2%} of {tolerance:.0%}: "
                  + " ".join(f"{f:.4g}/{r:.4g}" for f, r in zip(own, reference)))
            good &= len(reference) == 10 and max(map(abs, errors)) <= tolerance
    return good


def main():
    floe, failed = str(pathlib.Path(sys.argv[1]).resolve()), False
    failed |= not second_order(floe)
    failed |= not sprung(floe)
    failed |= not sprung_panel(floe)
    failed |= not hinged(floe)
    for name, model, tolerance in (("plate", plate(), 0.01), ("frame", frame(), 0.01)):
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            found = {"inp": frequencies(floe, folder, "part.inp", inp(model), model),
                     "bdf small": frequencies(floe, folder, "part.bdf", bdf(model, "small"), model),
                     "bdf large": frequencies(floe, folder, "part.nas", bdf(model, "large"), model),
                     "bdf free": frequencies(floe, folder, "part.dat", bdf(model, "free"), model),
                     "msh 2.2": frequencies(floe, folder, "part.msh", msh(model), model)}
            if model["shells"]:
                found["inp tied"] = frequencies(floe, folder, "tied.inp", tied(model), model)
                found["inp moved"] = frequencies(floe, folder, "moved.inp", moved(model), model)
                found["inp instance"] = frequencies(floe, folder, "two.inp", one_of_two(model), model, "p-1")
                text, bends = by_stiffness(model)
                found["inp A, B, D"] = frequencies(floe, folder, "stiffness.inp", text, model)
                found["bdf MID2"] = frequencies(floe, folder, "bends.bdf", bends, model)
            first = found["inp"]
            assert len(first) == 10, first
            for form, other in found.items():
                error = max(abs(a / b - 1) for a, b in zip(other, first))
                # coordinates of 16 characters have 14 digits
                limit = 1e-10
                print(f"{name:6s} {form:12s} {error:.1e} of {limit:.0e}")
                failed |= not error <= limit
            if shutil.which("ccx") and model["shells"]:
                (own, centre, moments), (mass, other_centre, other) = mass_properties(floe, folder, inp(model)), calculix_mass(folder, inp(model))
                error = max(abs(own / mass - 1), math.dist(centre, other_centre), math.dist(moments, other) / math.hypot(*other))
                print(f"{name:6s} mass, centre of gravity and moments of inertia, CalculiX {error:.1e} of 1e-05")
                failed |= not error <= 1e-5
            if shutil.which("ccx"):
                reference = calculix(folder, inp(model, bool(model["beams"])), 10, 0 if model["fixed"] else 6)
                own = first
                if model["beams"]:
                    own = frequencies(floe, folder, "part.bdf", bdf(model, "free", SOLID_TORSION), model)
                    print(f"{name:6s} with the torsion of a solid element: {max(abs(a / b - 1) for a, b in zip(own, first)):.2%} apart")
                errors = [a / b - 1 for a, b in zip(own, reference)]
                print(f"{name:6s} CalculiX   {max(map(abs, errors)):.2%} of {tolerance:.0%}: "
                      + " ".join(f"{f:.4g}/{r:.4g}" for f, r in zip(own, reference)))
                failed |= len(reference) != 10 or not max(map(abs, errors)) <= tolerance
    if shutil.which("ccx"):
        with tempfile.TemporaryDirectory() as scratch:
            folder, (columns, rows) = pathlib.Path(scratch), (48, 24)
            text = rigid_end(plate(columns, rows), columns, rows)
            own, reference = frequencies(floe, folder, "part.inp", text, dict(plate(), fixed=[1])), calculix(folder, text, 10, 0)
            errors = [a / b - 1 for a, b in zip(own, reference)]
            print(f"rigid  CalculiX   {max(map(abs, errors)):.2%} of 1%: " + " ".join(f"{f:.4g}/{r:.4g}" for f, r in zip(own, reference)))
            failed |= len(reference) != 10 or not max(map(abs, errors)) <= 0.01
    sys.exit(failed)



if __name__ == "__main__":
    main()
