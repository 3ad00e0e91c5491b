#!/usr/bin/python3
"""Links that leave rotations free, in decks: against closed forms (a beam with a hinge, clamped and simply supported; a plate with a
hinge along its middle), CalculiX (*EQUATION on the same nodes), and the same model of two bodies with a joint.

    tests/decks/hinges.py FLOE"""
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy as np

from formats import E, NU, RHO, calculix

WIDTH, HEIGHT, LENGTH, HINGE = 0.004, 0.006, 1.0, 0.6  # m; width along y, height along z


def roots(f, start, step, count):
    """The first zeros of a function that changes its sign there."""
    found, at, last = [], start, f(start)
    while len(found) < count:
        now = f(at + step)
        if last * now < 0:
            low, high, sign = at, at + step, last
            for _ in range(60):
                middle = (low + high) / 2
                low, high = (middle, high) if f(middle) * sign > 0 else (low, middle)
            found.append(low)
        at, last = at + step, now
    return found


def shape(x, beta, order):
    """cos, sin, cosh, sinh of beta x, differentiated, over beta^order."""
    c, s, ch, sh = math.cos(beta * x), math.sin(beta * x), math.cosh(beta * x), math.sinh(beta * x)
    return [[c, s, ch, sh], [-s, c, sh, ch], [-c, -s, ch, sh], [s, -c, sh, ch]][order]


def beam(depth, hinge, count):
    """Frequencies of a beam that is clamped at 0 and simply supported at LENGTH, with a hinge or without one."""
    zero, a = [0] * 4, HINGE
    def determinant(beta):
        at = lambda x, order: shape(x, beta, order)
        minus = lambda row: [-v for v in row]
        rows = [at(0, 0) + zero, at(0, 1) + zero, zero + at(LENGTH, 0), zero + at(LENGTH, 2), at(a, 0) + minus(at(a, 0)),
                at(a, 3) + minus(at(a, 3)), at(a, 2) + minus(at(a, 2)), at(a, 2) + zero if hinge else at(a, 1) + minus(at(a, 1))]
        scaled = np.array(rows) / np.abs(rows).max(axis=1)[:, None]
        return np.linalg.det(scaled)
    speed = math.sqrt(E * depth**2 / 12 / RHO)
    return [beta**2 * speed / (2 * math.pi) for beta in roots(determinant, 0.5, 0.05, count)]


def bars(n):
    """Nodes of two bars that meet at HINGE, 1 to n + 1 and 101 to 101 + n, and their elements."""
    nodes, elements = {}, []
    for first, x0, x1 in ((1, 0.0, HINGE), (101, HINGE, LENGTH)):
        for i in range(n + 1):
            nodes[first + i] = x0 + (x1 - x0) * i / n
        elements += [(first + i, first + i + 1) for i in range(n)]
    return nodes, elements


def bars_inp(n, links, which=(1, 101)):
    """`which` of the two bars."""
    nodes, elements = bars(n)
    chosen = [(a, b) for a, b in elements if (1 if a < 101 else 101) in which]
    text = "*NODE\n" + "".join(f"{k}, {x!r}, 0., 0.\n" for k, x in nodes.items()) + "*ELEMENT, TYPE=B31, ELSET=BAR\n"
    text += "".join(f"{i + 1}, {a}, {b}\n" for i, (a, b) in enumerate(chosen))
    text += f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{E}, {NU}\n*DENSITY\n{RHO}\n*BEAM SECTION, ELSET=BAR, MATERIAL=STEEL, SECTION=RECT\n"
    text += f"{WIDTH}, {HEIGHT}\n0., 1., 0.\n"
    sets = {"LEFT": 1, "INNER": n + 1, "OUTER": 101, "RIGHT": 101 + n}
    text += "".join(f"*NSET, NSET={name}\n{k}\n" for name, k in sets.items() if (1 if k < 101 else 101) in which)
    return text + links


def equations(pairs, directions, transform=""):
    return transform + "*EQUATION\n" + "".join(f"2\n{a}, {d}, 1., {b}, {d}, -1.\n" for a, b in pairs for d in directions)


def bars_bdf(n, link):
    nodes, elements = bars(n)
    text = f"BEGIN BULK\nMAT1,1,{E!r},,{NU},{RHO}\nPBARL,5,1,,BAR,,,,,+A\n+A,{WIDTH},{HEIGHT}\nCORD2R,7,,0.,0.,0.,0.,1.,0.,+C\n+C,0.,0.,1.\n"
    text += "".join(f"GRID,{k},,{x!r},0.,0.{',7' if k == 101 else ''}\n" for k, x in nodes.items())
    up = {101: "1.,0.,0."}  # the vector is in displacement axes
    text += "".join(f"CBAR,{i + 1},5,{a},{b},{up.get(a, '0.,0.,1.')}\n" for i, (a, b) in enumerate(elements))
    return text + f"SPC1,1,123456,1\nSPC1,2,123456,{101 + n}\n{link}ENDDATA\n"


def modes(floe, folder, deck, text, scene):
    (folder / deck).write_text(text)
    (folder / "scene.yaml").write_text(scene)
    done = subprocess.run([floe, "modes", "scene.yaml"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr or done.stdout
    return [float(f) for f in re.findall(r"^b +\d+ +(\S+)", done.stdout, re.M)]


def compare(name, own, reference, tolerance):
    error = max(abs(a / b - 1) for a, b in zip(own, reference, strict=True))
    print(f"{name:28s} {error:.1e} of {tolerance:.0e}: " + " ".join(f"{a:.5g}/{b:.5g}" for a, b in zip(own, reference)))
    return error <= tolerance


def gerber(floe):
    n = 24
    ball = sorted(beam(WIDTH, True, 4) + beam(HEIGHT, True, 4))[:5]
    about_y = sorted(beam(WIDTH, False, 4) + beam(HEIGHT, True, 4))[:5]  # bending in the plane of x and z
    scene = ("bodies: {b: {mesh: {file: {path: %s}}, reduction: {modes: 5}}}\njoints:\n  root: {type: fixed, between: [ground, b.%s]}\n"
             "  end: {type: support, between: [ground, b.%s], hold: [y, z, rx]}\n")
    inp, bdf = scene % ("part.inp", "LEFT", "RIGHT"), scene % ("part.bdf", "SPC1", "SPC2")
    pair, last = [(101, n + 1)], n + 1
    turned = "*NSET, NSET=H\n101, %d\n*TRANSFORM, NSET=H\n0., 1., 0., 0., 0., 1.\n" % last
    cases = [("*MPC PIN", "part.inp", bars_inp(n, f"*MPC\nPIN, 101, {last}\n"), ball),
             ("PIN the other way", "part.inp", bars_inp(n, f"*MPC\nPIN, {last}, 101\n"), ball),
             ("*EQUATION 1-3", "part.inp", bars_inp(n, equations(pair, (1, 2, 3))), ball),
             ("*EQUATION without 5", "part.inp", bars_inp(n, equations(pair, (1, 2, 3, 4, 6))), about_y),
             ("*TRANSFORM, without 4", "part.inp", bars_inp(n, equations(pair, (1, 2, 3, 5, 6), turned)), about_y),
             ("*EQUATION with 4", "part.inp", bars_inp(n, equations(pair, (1, 2, 3, 4))), ball),
             ("RBE2 123", "part.bdf", bars_bdf(n, f"RBE2,900,{last},123,101\n"), ball),
             ("RBE2 12345, CD", "part.bdf", bars_bdf(n, f"RBE2,900,{last},12345,101\n"), about_y),  # direction 6 is y
             ("RBE2 1235, CD", "part.bdf", bars_bdf(n, f"RBE2,900,{last},1235,101\n"), ball)]
    good = True
    with tempfile.TemporaryDirectory() as scratch:
        for name, deck, text, exact in cases:
            own = modes(floe, pathlib.Path(scratch), deck, text, inp if deck.endswith("inp") else bdf)
            good &= compare(name, own, exact, 3e-4)
    return good


def levy(count):
    """Frequencies of the plate of 1 by 1 m, simply supported on all sides, with a hinge along x = 0.5: those of halves, whose inner
    edge is free (symmetric) or simply supported."""
    t, a = 0.005, 0.5
    speed = math.sqrt(E * t**2 / (12 * (1 - NU**2)) / RHO)
    found = []
    for n in range(1, 6):
        k = n * math.pi
        found += [speed * ((m * math.pi / a)**2 + k**2) for m in range(1, 4)]
        def f(w):
            p, q = math.sqrt(w / speed + k**2), w / speed - k**2
            r = math.sqrt(abs(q))
            s, c = (math.sin(r * a), r * math.cos(r * a)) if q > 0 else (math.sinh(r * a), r * math.cosh(r * a))
            return (math.tanh(p * a) * (p**2 - NU * k**2) * c * (q + (2 - NU) * k**2)
                    - s * (q + NU * k**2) * p * (p**2 - (2 - NU) * k**2))
        found += roots(f, speed * k**2 * 0.3, speed * k**2 / 40.3, 3)
    return sorted(w / (2 * math.pi) for w in found)[:count]


def halves(nx, ny, links, kind="S4"):
    """Two plates of 0.5 by 1 m that meet at x = 0.5."""
    nodes, cells, pairs = {}, [], []
    for half in (0, 1):
        number = lambda i, j: 10000 * half + j * (nx + 1) + i + 1
        for j in range(ny + 1):
            for i in range(nx + 1):
                if kind == "S4" or i % 2 == 0 or j % 2 == 0:
                    nodes[number(i, j)] = (half * 0.5 + 0.5 * i / nx, j / ny)
        step = 1 if kind == "S4" else 2
        for j in range(0, ny, step):
            for i in range(0, nx, step):
                corners = [number(i, j), number(i + step, j), number(i + step, j + step), number(i, j + step)]
                middles = [number(i + 1, j), number(i + 2, j + 1), number(i + 1, j + 2), number(i, j + 1)] if step == 2 else []
                cells.append(corners + middles)
    pairs = [(10000 + j * (nx + 1) + 1, j * (nx + 1) + nx + 1) for j in range(ny + 1)]
    text = "*NODE\n" + "".join(f"{k}, {x!r}, {y!r}, 0.\n" for k, (x, y) in nodes.items()) + f"*ELEMENT, TYPE={kind}, ELSET=SKIN\n"
    text += "".join(f"{i + 1}, " + ", ".join(map(str, c)) + "\n" for i, c in enumerate(cells))
    text += f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{E}, {NU}\n*DENSITY\n{RHO}\n*SHELL SECTION, ELSET=SKIN, MATERIAL=STEEL\n0.005\n"
    dependent = {a for a, _ in pairs}  # CalculiX refuses supports there
    edge = lambda name, where: f"*NSET, NSET={name}\n" + "".join(f"{k},\n" for k, x in nodes.items() if where(*x) and k not in dependent)
    text += edge("SIDES", lambda x, y: x in (0, 1)) + edge("ENDS", lambda x, y: y in (0, 1))
    return text + links(pairs)


def plate(floe):
    scene = ("bodies: {b: {frame: mean-axis, mesh: {file: {path: part.inp}}, reduction: {modes: 8}}}\njoints:\n"
             "  sides: {type: support, between: [ground, b.SIDES], hold: [x, y, z]}\n  ends: {type: support, between: [ground, b.ENDS], hold: [x, y, z]}\n")
    good = True
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name, links in (("plate, *MPC PIN", lambda pairs: "*MPC\n" + "".join(f"PIN, {a}, {b}\n" for a, b in pairs)),
                            ("plate, without 5", lambda pairs: equations(pairs, (1, 2, 3, 4, 6)))):
            own = modes(floe, folder, "part.inp", halves(24, 48, links), scene)
            good &= compare(name, own, levy(8), 5e-3)
        if shutil.which("ccx"):
            text = halves(12, 24, lambda pairs: equations(pairs, (1, 2, 3)), "S8R")
            own = modes(floe, folder, "part.inp", text, scene)
            reference = calculix(folder, text + "*BOUNDARY\nSIDES, 1, 3\nENDS, 1, 3\n*STEP\n*FREQUENCY\n12\n*END STEP\n", 8, 0)
            good &= compare("plate, CalculiX", own, reference, 1e-2)
    return good


def refined(floe):
    """A deck whose elements are divided once against one with as many elements: the middles of the hinge's edges are linked, too."""
    scene = ("bodies: {b: {mesh: {file: {path: part.inp, refine: %d}}, reduction: {modes: 8}}}\njoints:\n"
             "  sides: {type: support, between: [ground, b.SIDES], hold: [x, y, z, rx, ry, rz]}\n")
    good = True
    with tempfile.TemporaryDirectory() as scratch:
        for name, kind, directions in (("refined, *EQUATION 1-3", "S4", (1, 2, 3)), ("refined, without 5", "S4", (1, 2, 3, 4, 6)),
                                       ("refined, S8R", "S8R", (1, 2, 3, 4, 6))):
            coarse, own, fine = (modes(floe, pathlib.Path(scratch), "part.inp", halves(n, 2 * n, lambda pairs: equations(pairs, directions), kind),
                                       scene % refine) for n, refine in ((4, 0), (4, 1), (8, 0)))
            good &= compare(name, own, fine, 1e-7) and abs(coarse[0] / fine[0] - 1) > 1e-4
    return good


def tip(floe, folder, scene, formulation, ranks=1):
    (folder / "scene.yaml").write_text(scene)
    command = [floe, "run", "scene.yaml", "--formulation", formulation, "--no-estimate", "--force", "-o", "out"]
    if ranks > 1:
        command = ["mpiexec", "-n", str(ranks), *command]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr or done.stdout
    return np.loadtxt(folder / "out" / "probes.csv", delimiter=",", skiprows=1)[:, 1:]


def in_file(folder, opening):
    """@return  whether the nodes at the hinge are at one point in the file of a motion, with rotations that differ by more"""
    with h5py.File(folder / "out" / "result.h5") as file:
        body, U = file["bodies/b"], file["motion/U"][-1]
        positions, dofs = body["shapes/positions"][()], body["nodes_of_motion"][()]
        pair = [i for i, x in enumerate(positions) if abs(x[0] - positions[:, 0].min() - HINGE) < 1e-9]
        at = [U[int(dofs[i, 0]):int(dofs[i, 0]) + 6] for i in pair]
        return len(pair) == 2 and not dofs[pair, 1:].any() and np.abs(at[0][:3] - at[1][:3]).max() < 1e-9 and abs(at[0][4] - at[1][4]) > opening


def motions(floe):
    """One body with a link against two with a joint: a pendulum of two bars in large rotations (cfr), and the clamped and supported
    beam under a force, small, in all formulations."""
    n, good = 12, True  # cfr lumps masses: its difference from the others is of order 2
    one = "bodies: {b: {mesh: {file: {path: one.inp}}, reduction: {modes: 16}}}\njoints:\n"
    two = "bodies:\n  a: {mesh: {file: {path: a.inp}}}\n  b: {mesh: {file: {path: b.inp}}}\njoints:\n"
    hinge = "  hinge: {type: revolute, between: [a.INNER, b.OUTER], axis: [0, 1, 0]}\n"
    pivot = "  root: {type: revolute, between: [ground, %s.LEFT], axis: [0, 1, 0]}\n"
    swing = "gravity: [0, 0, -9.81]\nprobes: {tip: {at: b.RIGHT}}\nmotion: {end: 0.4, step: 1e-3}\n"
    held = "  root: {type: fixed, between: [ground, %s.LEFT]}\n  end: {type: support, between: [ground, b.RIGHT], hold: [y, z, rx]}\n"
    push = "loads: {push: {type: force, at: b.OUTER, force: [0, 0, 1e-3*sin(40*t)]}}\nprobes: {tip: {at: b.OUTER}}\nmotion: {end: 0.3, step: 1e-3}\n"
    shaken = push.replace("b.OUTER", "b.RIGHT")
    at_link = "  root: {type: fixed, between: [ground, %s.LEFT]}\n  middle: {type: fixed, between: [ground, b.OUTER]}\n"  # on its own rotations
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "one.inp").write_text(bars_inp(n, equations([(101, n + 1)], (1, 2, 3, 4, 6))))
        for name, which in (("a", (1,)), ("b", (101,))):
            (folder / f"{name}.inp").write_text(bars_inp(n, "", which))
        for name, joints, rest, runs in (("pendulum", pivot, swing, [("cfr", 1, 1e-6), ("cfr", 3, 1e-6)]),
                                         ("beam", held, push, [("cfr", 1, 1e-6), ("nlffr", 1, 1e-3), ("nlffr", 4, 1e-3), ("lffr", 1, 1e-3),
                                                               ("vm", 1, 1e-3), ("vm+md", 2, 1e-3)]),
                                         ("fixed at the link", at_link, shaken, [("cfr", 1, 1e-6), ("nlffr", 2, 3e-3)])):
            reference = tip(floe, folder, two + joints % "a" + hinge + rest, "cfr")
            size = np.abs(reference).max()
            for formulation, ranks, tolerance in runs:
                own = tip(floe, folder, one + joints % "b" + rest, formulation, ranks)
                error = np.abs(own - reference).max() / size
                good &= name != "pendulum" or in_file(folder, 0.1)
                print(f"{name}, {formulation} on {ranks} ranks: {error:.1e} of {tolerance:.0e} of {size:.3g} m")
                good &= error <= tolerance
    return good


def step_inp(arm, dependent="D"):
    """Two bars of two elements whose ends I and D are `arm` apart along z, with a *KINEMATIC that leaves the rotation about y free."""
    x = {1: (0, 0), 2: (0.3, 0), 3: (HINGE, 0), 4: (HINGE, arm), 5: (0.8, arm), 6: (LENGTH, arm)}
    text = "*NODE\n" + "".join(f"{k}, {a!r}, 0., {z!r}\n" for k, (a, z) in x.items()) + "*ELEMENT, TYPE=B31, ELSET=BAR\n1,1,2\n2,2,3\n3,4,5\n4,5,6\n"
    text += f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{E}, {NU}\n*DENSITY\n{RHO}\n*BEAM SECTION, ELSET=BAR, MATERIAL=STEEL, SECTION=RECT\n"
    text += f"{WIDTH}, {HEIGHT}\n0., 1., 0.\n*NSET, NSET=BOTH\n4, 5\n"
    text += "".join(f"*NSET, NSET={name}\n{k}\n" for name, k in (("A", 1), ("I", 3), ("D", 4), ("E", 5), ("B", 6)))
    return text + f"*SURFACE, NAME=S, TYPE=NODE\n{dependent},\n*COUPLING, REF NODE={3 if dependent == 'D' else 4}, SURFACE=S, CONSTRAINT NAME=K\n*KINEMATIC\n1, 4\n6, 6\n"


def static(floe, folder, scene, formulation):
    """@return  the last row of the probes"""
    (folder / "scene.yaml").write_text(scene)
    done = subprocess.run([floe, "static", "scene.yaml", "--formulation", formulation, "--steps", "1", "--at", "1", "--no-estimate", "--force",
                           "-o", "out"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr or done.stdout
    return np.loadtxt(folder / "out" / "probes.csv", delimiter=",", skiprows=1)[-1, 1:]


def at_the_link(floe):
    """Moments, rotations and forces of sections at a dependent node at an arm: against beam theory (the arm keeps the first bar from
    rotating at the link), statics, and one formulation against the others."""
    bodies = "bodies: {b: {mesh: {file: {path: step.inp}}, reduction: {modes: 6, attachment: all}}}\njoints:\n"
    clamped = bodies + "".join("  %s: {type: support, between: [ground, b.%s], hold: [x, y, z, rx, ry, rz]}\n" % (n, n) for n in "AB")
    moment = clamped + ("loads: {m: {type: moment, at: b.%s, moment: [0, 1e-4*t, 0]}}\n"
                        "probes: {z: {at: b.D}, d: {at: b.D, quantity: rotation}, both: {at: b.BOTH, quantity: rotation}}\n")
    section = bodies + ("  a: {type: fixed, between: [ground, b.A]}\n  e: {type: spherical, between: [ground, b.B]}\n"
                        "loads: {f: {type: force, at: b.E, force: [0, 0, 1e-3*t]}}\n"
                        "probes: {D: {at: b.D, quantity: section_force}, M: {at: b.D, quantity: section_moment}}\n")
    EI, M, a, b = E * WIDTH * HEIGHT**3 / 12, 1e-4, HINGE, LENGTH - HINGE
    force = M * b**2 / 2 / (b**3 / 3 + a**3 / 12)
    exact = [force * a**3 / 12 / EI, (M * b - force * b**2 / 2) / EI]
    good = True
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "step.inp").write_text(step_inp(0.02))
        for place in ("D", "BOTH"):
            reference = static(floe, folder, moment % place, "nlffr")
            if place == "D":
                good &= compare("moment at an arm", [reference[2], reference[4]], exact, 3e-2)
            for formulation in ("cfr", "vm+md"):
                own = static(floe, folder, moment % place, formulation)
                good &= compare(f"moment at {place}, {formulation}", own[[2, 4, 7]], reference[[2, 4, 7]], 1e-6)
        for formulation in ("cfr", "nlffr", "vm+md"):
            D, moments = np.split(static(floe, folder, section, formulation), 2)
            good &= compare(f"section, {formulation}", [D[2]], [5e-4], 1e-4) and abs(moments[1]) < 1e-9
    return good


def supports(floe):
    """Supports at a dependent node against those of the same beam where this node is the independent one; at an arm, one formulation
    against the others."""
    scene = ("bodies: {b: {mesh: {file: {path: part.inp}}, reduction: {modes: 4, attachment: all}}}\njoints:\n"
             + "".join("  %s: {type: support, between: [ground, b.%s], hold: [x, y, z, rx, ry, rz]}\n" % (n, n) for n in "AB")
             + "  c: {type: support, between: [ground, b.D], hold: [%s]}\n")
    push = "loads: {f: {type: force, at: b.E, force: [0, 0, 1e-3*t]}}\nprobes: {e: {at: b.E}}\n"
    good = True
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for hold, arm in (("z", 0.0), ("ry", 0.0), ("x, y, z, rx, ry, rz", 0.0), ("ry", 0.02)):
            independent = "D" if arm > 0 else "I"
            own, reference = (modes(floe, folder, "part.inp", step_inp(arm, node), scene % hold) for node in ("D", independent))
            if arm == 0:
                good &= compare(f"support [{hold}]", own, reference, 1e-7)
            reference = static(floe, folder, scene % hold + push, "nlffr")[2]
            (folder / "part.inp").write_text(step_inp(arm))
            for formulation in ("cfr", "nlffr", "vm+md"):
                own = static(floe, folder, scene % hold + push, formulation)[2]
                good &= compare(f"support [{hold}], {formulation}", [own], [reference], 1e-6)
    return good


def warned(floe):
    """@return  whether free rotations of a pendulum of two bars that are not small are reported in lffr, whose modes are not found"""
    scene = ("bodies: {b: {mesh: {file: {path: step.inp}}, reduction: {modes: 6}}}\njoints:\n"
             "  root: {type: revolute, between: [ground, b.A], axis: [0, 1, 0]}\ngravity: [0, 0, -9.81]\nmotion: {end: 0.4, step: 1e-3}\n")
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "step.inp").write_text(step_inp(0.02))
        (folder / "scene.yaml").write_text(scene)
        done = subprocess.run([floe, "run", "scene.yaml", "--formulation", "lffr", "--no-estimate", "-o", "out"], cwd=folder, capture_output=True, text=True)
        text = done.stdout + done.stderr
        good = done.returncode == 0 and "foreshortening (slopes up to" in text and "links that leave rotations free may leave" in text
        print(f"warned: {good}" + ("" if good else ": " + text))
        return good


def refusals(floe):
    """@return  whether joints that hold nodes with rotations of their own as one, displacements of those at an arm, and motions without
    stiffness, are refused"""
    at_arm = "bodies: {b: {mesh: {file: {path: step.inp}}, reduction: {modes: 2}}}\njoints:\n  c: {type: support, between: [ground, b.D], hold: [z]}\n"
    joint = ("bodies: {b: {mesh: {file: {path: part.inp}}, reduction: {modes: 2}}}\njoints:\n"
             "  j: {type: fixed, between: [ground, b.HINGE]}\n")
    free = "bodies: {b: {frame: mean-axis, mesh: {file: {path: part.inp}}, reduction: {modes: 2}}}\n"
    good = True
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        pin = lambda pairs: ("*MPC\n" + "".join(f"PIN, {a}, {b}\n" for a, b in pairs) + "*NSET, NSET=HINGE\n" + "".join(f"{a},\n" for a, _ in pairs))
        (folder / "part.inp").write_text(halves(4, 4, pin))
        (folder / "step.inp").write_text(step_inp(0.02))
        for scene, code, message in ((joint, 2, "joints.j: its place b.HINGE has nodes whose rotations a link of part.inp leaves free"),
                                     (at_arm, 2, "joints.c.hold: its node follows another one but for rotations of its own, by a link at an arm; expected"),
                                     (free, 1, "links that leave rotations free may leave a motion without stiffness")):
            (folder / "scene.yaml").write_text(scene)
            done = subprocess.run([floe, "modes", "scene.yaml"], cwd=folder, capture_output=True, text=True)
            refused = done.returncode == code and message in done.stderr
            print(f"refused: {refused}" + ("" if refused else f", {done.returncode}: {done.stderr or done.stdout}"))
            good &= refused
    return good


def main():
    floe = str(pathlib.Path(sys.argv[1]).resolve())
    good = [gerber(floe), plate(floe), refined(floe), motions(floe), at_the_link(floe), supports(floe), warned(floe), refusals(floe)]
    sys.exit(0 if all(good) else 1)


if __name__ == "__main__":
    main()
