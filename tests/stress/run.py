"""`floe stress` against closed forms, published tables, full order, CalculiX: run.py FLOE."""
import pathlib
import shutil
import sys
import tempfile

import h5py
import numpy as np

import calculix
from fields import CLAMPED, LAMINATE, PLANAR, ROLLED, SHAKEN, SPATIAL, STRIP, Fields, close, floe, recovered, table

FLOE = pathlib.Path(sys.argv[1]).resolve()


def strip_under_force(folder):
    """Bending 6 M / (b t^2) on top and bottom, tension N / (b t), nu = 0; in every formulation. M = F (L - x) in the linear
    one; the tension straightens the others, M = F sinh(k (L - x)) / (k cosh k L), k^2 = N / EI."""
    pull, k = 2 / (0.05 * 2e-3), np.sqrt(2 / (7e10 * 0.05 * 2e-3**3 / 12))
    for cells in ("quadrilaterals", "triangles"):
        for formulation in ("vm+md", "nlffr", "lffr", "cfr"):
            path, _ = recovered(FLOE, folder, STRIP.replace("CELLS", cells), formulation=formulation)
            found = Fields(path, "strip")
            inner = found.x[:, 0] > 0.03  # beside the clamp the strip stays as wide, which nu = 0 allows, but not its rows
            x = found.x[inner, 0]
            moment = 0.01 * ((1 - x) if formulation == "lffr" else np.sinh(k * (1 - x)) / (k * np.cosh(k)))
            for name, sign in (("stress_top", -1), ("stress_bottom", 1)):
                close(found[name][inner, 0], pull + sign * 6 * moment / (0.05 * 2e-3**2), 0.01, f"{cells} {formulation} {name}")
            close(found["membrane_force"][inner, 0], 0 * x + 2 / 0.05, 1e-3, f"{cells} {formulation} N")
            close(found["bending_moment"][inner, 0], -moment / 0.05, 0.01, f"{cells} {formulation} M")
            close(found["strain_top"][inner], found["stress_top"][inner] / 7e10 * [1, 1, 2], 1e-9, "strain")
            worst = np.maximum(np.abs(found["stress_top"][:, 0]), np.abs(found["stress_bottom"][:, 0]))
            close(found["von_mises"][inner], worst[inner], 5e-3, "von Mises")
            close(found["stress_max"][inner], found["stress_bottom"][inner, 0], 5e-3, "principal stress")
            close(found["von_mises_of_motion"], found["von_mises"], 1e-6, "maximum of equilibria that are all the same")


def plate_under_pressure(folder):
    """Taylor and Govindjee 2004: M = 0.0229051 q a^2 in the middle, -0.0513338 q a^2 at the edges, nu = 0.3; here at the
    middles of the elements beside them."""
    path, said = recovered(FLOE, folder, CLAMPED, formulation="nlffr")
    found = Fields(path, "plate")
    middle = np.argsort(np.linalg.norm(found.x - [0.5, 0.5, 0], axis=1))[:4]
    close(found["bending_moment"][middle, :2], 10 * 0.0229051 + np.zeros((4, 2)), 0.015, "moment in the middle")
    close(found["von_mises_top"][middle], 6 * 10 * 0.0229051 / 0.01**2 + np.zeros(4), 0.015, "von Mises in the middle")
    row = np.abs(found.x[:, 1] - found.x[middle[0], 1]) < 1e-9
    x, M = found.x[row, 0], found["bending_moment"][row, 0]
    edge = np.polyval(np.polyfit(x[x < 0.2], M[x < 0.2], 2), 0)
    close(edge, -10 * 0.0513338, 0.03, "moment at the edge")
    assert "singular" not in said, said  # all edges are held: their corners are no ends


def navier(folder):
    """Simply supported square plate under pressure, nu = 0.3: M = 0.0478864 q a^2 in the middle, by Navier's series."""
    series = sum(16 / (np.pi**4 * m * n) * (m**2 + 0.3 * n**2) / (m**2 + n**2)**2 * np.sin(m * np.pi / 2) * np.sin(n * np.pi / 2)
                 for m in range(1, 200, 2) for n in range(1, 200, 2))
    hinged = CLAMPED
    for edge, axis in (("left", "[0, 1, 0]"), ("right", "[0, 1, 0]"), ("bottom", "[1, 0, 0]"), ("top", "[1, 0, 0]")):
        hinged = hinged.replace(f"{{type: fixed, between: [ground, plate.{edge}]}}",
                                f"{{type: revolute, between: [ground, plate.{edge}], axis: {axis}}}")
    path, _ = recovered(FLOE, folder, hinged, formulation="lffr")
    found = Fields(path, "plate")
    middle = np.argsort(np.linalg.norm(found.x - [0.5, 0.5, 0], axis=1))[:4]
    close(found["bending_moment"][middle, :2], 10 * series + np.zeros((4, 2)), 0.01, "moment in the middle")
    close(found["stress_bottom"][middle, 0], -6 * 10 * series / 0.01**2 + np.zeros(4), 0.01, "stress in the middle")


def layers(folder):
    """Pull of a cross-ply laminate with nu = 0: eps = N / sum E h, each layer E eps."""
    path, _ = recovered(FLOE, folder, LAMINATE)
    found = Fields(path, "strip")
    inner = (found.x[:, 0] > 0.2) & (found.x[:, 0] < 0.8)
    eps = 100 / 0.1 / (2 * 1.4e11 * 1e-3 + 1e10 * 1e-3)
    for layer, E in ((1, 1.4e11), (2, 1e10), (3, 1.4e11)):
        close(found[f"stress_layer_{layer}"][inner, 0], E * eps + np.zeros(inner.sum()), 1e-3, f"layer {layer}")
    close(found["von_mises"][inner], 1.4e11 * eps + np.zeros(inner.sum()), 1e-3, "of all layers")


def beams(folder):
    """N / A and M c / I: exact at both ends of the elements under a force at the tip."""
    for formulation in ("vm+md", "nlffr", "cfr"):
        path, _ = recovered(FLOE, folder, PLANAR, formulation=formulation)
        found = Fields(path, "beam")
        start = found.x[:, 0] - 0.1
        close(found["section_force"][:, 0], 500 + 0 * start, 1e-3, f"{formulation} N")
        k = np.sqrt(500 / (2e11 * 1.0666666666666667e-7))  # tension straightens: M = -V sinh(k (L - x)) / (k cosh k L)
        moment = lambda x: -3 * np.sinh(k * (2 - x)) / (k * np.cosh(2 * k))  # noqa: E731
        close(found["section_moment_start"][:, 2], moment(start), 0.01, f"{formulation} M")
        worst = 500 / 8e-4 + np.abs(moment(start)) * 0.02 / 1.0666666666666667e-7
        close(found["stress_max"], worst, 0.01, f"{formulation} fibres")
        path, _ = recovered(FLOE, folder, SPATIAL, formulation=formulation)
        found = Fields(path, "beam")
        left = 1.5 - (found.x[:, 1] - 1.5 / 24)  # from the start of the element to the tip
        # x along +y, y along +x (width 0.03), z = x cross y along -z (height 0.05)
        Iy, Iz = 0.03 * 0.05**3 / 12, 0.05 * 0.03**3 / 12
        bend = 2 * left * 0.015 / Iz + 3 * left * 0.025 / Iy
        close(found["stress_max"], 100 / 0.0015 + bend, 0.01, f"{formulation} corners")
        close(found["stress_min"], 100 / 0.0015 - bend, 0.01, f"{formulation} corners")
        close(found["section_force"], np.tile([100, 2, 3], (12, 1)), 0.01, f"{formulation} forces")


def beams_of_decks(folder):
    """M c / I of the shapes of PBARL and of the stress points of PBAR, both sides of a tee (20 x 40 x 6 x 6 mm) under a force
    of 10 N at 1 m along its web; elements without either are counted, and the maximum is that of the others."""
    width, height, t = 0.02, 0.04, 0.006
    areas, arms = np.array([width * t, (height - t) * t]), np.array([t / 2, (height + t) / 2])
    centre = areas @ arms / areas.sum()  # from the top
    inertia = width * t**3 / 12 + t * (height - t)**3 / 12 + areas @ (arms - centre)**2
    grids = "".join(f"GRID,{i + 1},,{i / 10},0.,0.\nGRID,{i + 101},,{i / 10},1.,0.\n" for i in range(11))
    cards = {"tee": "PBARL,6,1,,T\n,.02,.04,.006,.006\n",
             "points": f"PBAR,6,1,{areas.sum()},{inertia},1.-8,1.-9,,,+\n+,{centre},0.,{centre - height},0.\n"}
    for name, card in cards.items():
        bars = "".join(f"CBAR,{i},6,{i},{i + 1},0.,1.,0.\nCBAR,{i + 100},7,{i + 100},{i + 101},0.,1.,0.\n" for i in range(1, 11))
        (folder / "deck.bdf").write_text("BEGIN BULK\n" + grids + "GRID,99,,0.,.5,0.\nCBAR,98,6,1,99,1.,0.,0.\nCBAR,99,6,99,101,1.,0.,0.\n" +
                                         bars + card + "PBAR,7,1,1.-4,1.-8,1.-8,1.-9\nMAT1,1,7.+10,,.3,2700.\nENDDATA\n")
        path, said = recovered(FLOE, folder, """
bodies:
  b: {mesh: {file: {path: deck.bdf}}, reduction: {modes: 4}}
joints:
  root: {type: fixed, between: [ground, {body: b, node: [0, 0, 0]}]}
loads:
  tip: {type: force, at: {body: b, node: [1, 0, 0]}, force: [0, 10, 0]}
motion: {end: 1, step: 0.1}
""", formulation="lffr")
        found = Fields(path, "b")
        loaded = (found.x[:, 1] < 1e-9) & (found.x[:, 0] > 1e-9)
        arm = 1 - (found.x[loaded, 0] - 0.05)  # of the start of the element
        close(found["stress_max"][loaded], 10 * arm * (height - centre) / inertia, 1e-3, f"{name}: web, which is bent most")
        close(found["stress_min"][loaded], -10 * arm * centre / inertia, 1e-3, f"{name}: flange")
        assert "10 of 22 elements have forces and moments, but no stresses" in said and "the maximum is that of the others" in said, said


def linear_beam(folder):
    """A linear motion has linear stresses: M / W, no axial force, whatever the deflection (here 8 % of the length); also of a
    reduced body with a linear elastic force."""
    scene = """
bodies:
  b:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 10}}
    section: {shape: rectangle, width: 0.02, height: 0.01, orientation: [0, 1, 0]}
    material: {E: 2.1e11, nu: 0.3, rho: 7800}
    frame: {type: clamped, at: start}
    reduction: {modes: 3, attachment: all, elastic_force: linear}
joints: {root: {type: fixed, between: [ground, b.start]}}
loads: {f: {type: force, at: b.end, force: [0, 0, 84]}}
probes: {tip: {at: b.end}}
"""
    for formulation in ("lffr", "vm+md"):
        path, _ = recovered(FLOE, folder, scene, formulation=formulation)
        found = Fields(path, "b")
        worst = 84 * (1.05 - found.x[:, 0]) / (0.02 * 0.01**2 / 6)  # at the start of the element
        close(found["stress_max"], worst, 0.01, f"{formulation} fibres")
        close(found["stress_min"], -worst, 0.01, f"{formulation} fibres")
        assert np.abs(found["section_force"][:, 0]).max() < 1e-6 * 84, f"{formulation} axial force"


def round_bars(folder):
    """N / A, |M| r / I and T r / J of bars and tubes bent about two axes and twisted, read from decks."""
    deck = "*NODE\n" + "".join(f"{i + 1}, {i / 10}, 0, 0\n" for i in range(11)) + "*ELEMENT, TYPE=B31, ELSET=bar\n" + "".join(
        f"{i + 1}, {i + 1}, {i + 2}\n" for i in range(10)) + "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n"
    for shape, area, inertia in (("CIRC\n0.02", np.pi * 0.02**2, np.pi * 0.02**4 / 4),
                                 ("PIPE\n0.02, 0.005", np.pi * (0.02**2 - 0.015**2), np.pi * (0.02**4 - 0.015**4) / 4)):
        (folder / "bar.inp").write_text(deck + f"*BEAM SECTION, ELSET=bar, MATERIAL=steel, SECTION={shape}\n0, 1, 0\n")
        path, _ = recovered(FLOE, folder, """
bodies: {bar: {mesh: {file: {path: bar.inp}}, reduction: {modes: 4, attachment: all}}}
joints: {root: {type: fixed, between: [ground, {body: bar, node: [0, 0, 0]}]}}
loads:
  tip: {type: force, at: {body: bar, node: [1, 0, 0]}, force: [500, 3, 4]}
  turn: {type: moment, at: {body: bar, node: [1, 0, 0]}, moment: [20, 0, 0]}
motion: {end: 1, step: 0.1}
""", formulation="lffr")
        found = Fields(path, "bar")
        bend = 5 * (1.05 - found.x[:, 0]) * 0.02 / inertia  # at the start of the element
        close(found["stress_max"], 500 / area + bend, 0.01, f"{shape} in tension")
        close(found["stress_min"], 500 / area - bend, 0.01, f"{shape} in compression")
        shear = 20 * 0.02 / (2 * inertia)
        close(found["von_mises"], np.sqrt((500 / area + bend) ** 2 + 3 * shear**2), 0.01, f"{shape} twisted")
    # the centre of the section 30 mm beside the nodes: a force through it does not twist the bar, one at the nodes does
    for turn in (0.12, 0):
        path, _ = recovered(FLOE, folder, f"""
bodies:
  bar:
    mesh: {{line: {{from: [0, 0, 0], to: [1, 0, 0], elements: 10}}}}
    section: {{shape: circle, radius: 0.02, centroid: [0.03, 0], orientation: [0, 1, 0]}}
    material: {{E: 2e11, nu: 0.3, rho: 7800}}
joints: {{root: {{type: fixed, between: [ground, bar.start]}}}}
loads:
  tip: {{type: force, at: bar.end, force: [0, 0, 4]}}
  turn: {{type: moment, at: bar.end, moment: [{turn}, 0, 0]}}
motion: {{end: 1, step: 0.1}}
""", formulation="nlffr")
        found = Fields(path, "bar")
        shear = (0.12 - turn) / (np.pi * 0.02**3 / 2)
        close(found["von_mises"], np.sqrt(found["stress_max"] ** 2 + 3 * shear**2), 1e-3, f"force beside the centre, {turn}")
        close(found["stress_max"], 4 * (1.05 - found.x[:, 0]) * 4 / (np.pi * 0.02**3), 0.01, "bent about its centre")
    _, said = recovered(FLOE, folder, SPATIAL.replace(
        "shape: rectangle, width: 0.03, height: 0.05", "A: 1.5e-3, Iy: 3.1e-7, Iz: 1.1e-7, J: 1e-7, fibres: [[.015, .025]]"))
    assert "given by constants and fibres is without torsion" in said, said


def large_rotations(folder):
    """Pure bending: M t / 2 I everywhere, at any rotation."""
    moment = 7e10 * 0.05 * 2e-3**3 / 12 * np.pi / 3
    path, _ = recovered(FLOE, folder, ROLLED.replace("MOMENT", repr(moment)), formulation="cfr")
    found = Fields(path, "strip")
    inner = (found.x[:, 0] > 0.1) & (found.x[:, 0] < 0.9)
    stress = 7e10 * 1e-3 * np.pi / 3
    close(found["stress_top"][inner, 0], -stress + np.zeros(inner.sum()), 0.01, "top")
    close(found["membrane_force"][inner], np.zeros((inner.sum(), 3)) + 1e-2 * stress * 2e-3, 1.5, "no membrane force")
    line = ROLLED.replace("MOMENT", repr(moment)).replace(
        "{plate: {along: [1, 0, 0], across: [0, 0.05, 0], elements: [24, 2], cells: quadrilaterals}}",
        "{line: {from: [0, 0, 0], to: [1, 0, 0], elements: 12}}").replace(
        "{thickness: 2e-3}", "{shape: rectangle, width: 0.05, height: 2e-3, orientation: [0, 1, 0]}").replace(
        "strip.left", "strip.start").replace("strip.right", "strip.end")
    path, _ = recovered(FLOE, folder, line, formulation="cfr")
    found = Fields(path, "strip")
    close(found["stress_max"], stress + np.zeros(12), 1e-3, "fibres of a beam")
    close(np.abs(found["section_moment_end"][:, 1]), moment + np.zeros(12), 1e-3, "its moment")
    flat = line.replace(", nu: 0", "").replace("[0, 0, 0]", "[0, 0]").replace("[1, 0, 0]", "[1, 0]").replace('[0, "-t*', '"t*').replace('", 0]', '"').replace(
        "{shape: rectangle, width: 0.05, height: 2e-3, orientation: [0, 1, 0]}", "{A: 1e-4, I: 0.05*2e-3^3/12, fibre: 1e-3}")
    path, _ = recovered(FLOE, folder, flat, formulation="cfr")
    found = Fields(path, "strip")
    close(found["stress_max"], stress + np.zeros(12), 1e-3, "fibres of a beam in the plane")
    close(found["section_moment_end"][:, 2], moment + np.zeros(12), 1e-3, "its moment")
    close(found["section_force"], np.zeros((12, 3)) + 1e-6 * moment, 1.5, "no section forces")


def reduced_against_full_order(folder):
    """4 modes and their derivatives: von Mises' stress of all elements over the motion, with and without correction."""
    histories, fields = {}, {}
    for name, formulation, words in (("full", "nlffr", ()), ("corrected", "vm+md", ()), ("plain", "vm+md", ("--uncorrected",))):
        path, said = recovered(FLOE, folder, SHAKEN, *words, "--at", "0.02", "--history", "plate:0.2,0.15",
                               command="run", formulation=formulation)
        assert ("correction" in said) == (name == "corrected"), said
        fields[name] = Fields(path, "plate")
        histories[name] = table(folder / "out/stress.csv")
    exact = histories["full"]
    assert exact["t"][-1] == 0.03
    error = {name: np.sqrt(np.mean((history["plate.1.von_mises"] - exact["plate.1.von_mises"])**2)
                           / np.mean(exact["plate.1.von_mises"]**2)) for name, history in histories.items()}
    assert error["corrected"] < 0.02 and error["corrected"] < 0.5 * error["plain"], error
    regular = (fields["full"]["singular"] == 0)
    close(fields["corrected"]["von_mises_of_motion"][regular], fields["full"]["von_mises_of_motion"][regular], 0.03,
          "extremes over the motion")
    return error


def corrected_from_the_start(folder):
    """A plate that rests in its equilibrium under a pressure: its stresses are the same at the start and later, corrected."""
    scene = CLAMPED.replace("motion: {", "motion: {start: equilibrium, ").replace("modes: ", "derivatives: none, modes: ")
    path, said = recovered(FLOE, folder, scene, "--history", "plate:0.2,0.15", command="run", formulation="vm+md")
    assert "correction" in said, said
    stress = table(folder / "out/stress.csv")["plate.1.von_mises"]
    recovered(FLOE, folder, scene, "--history", "plate:0.2,0.15", "--uncorrected", command="run", formulation="vm+md")
    plain = table(folder / "out/stress.csv")["plate.1.von_mises"]
    assert abs(plain[-1] / stress[-1] - 1) > 0.01, (plain[-1], stress[-1])  # the correction counts
    close(stress, stress[-1] + 0 * stress, 1e-3, "von Mises at rest")


def body_from_a_file(folder):
    """The scene from which a file was made has its elements: the same stresses as without the file."""
    shaken = SHAKEN.replace("{type: pressure, body: plate, pressure: \"400*smooth(t, 0, 0.01)\"}",
                            "{type: force, at: plate.top, force: [0, 0, \"20*smooth(t, 0, 0.01)\"]}")
    assert shaken != SHAKEN
    path, _ = recovered(FLOE, folder, shaken, "--uncorrected", "--at", "0.02", command="run", more=["--no-estimate"])
    expected = Fields(path, "plate")
    (folder / "source.yaml").write_text(shaken)
    floe(FLOE, folder, "reduce", "source.yaml", "-o", "plate.h5", "--force")
    scene = "bodies: {wing: {reduced: plate.h5}}\n" + shaken[shaken.index("joints:"):].replace("plate.", "wing.")
    (folder / "scene.yaml").write_text(scene)
    floe(FLOE, folder, "run", "scene.yaml", "-o", "out", "--force", "--no-estimate")
    told = floe(FLOE, folder, "stress", "out", "--force", code=2)
    assert "no flexible body has a mesh" in told, told
    floe(FLOE, folder, "stress", "out", "--force", "--at", "0.02", "--source", "wing:source.yaml")
    found = Fields(folder / "out/stress.h5", "wing")
    for name in ("stress_top", "von_mises_of_motion", "membrane_force"):
        close(found[name], expected[name], 1e-6, name)
    for source, phrase in (("wong:source.yaml", "--source wong:source.yaml: names no body from a file; expected BODY:SCENE.yaml with one of wing"),
                           ("wing:nothing.yaml", "nothing.yaml")):
        assert phrase in floe(FLOE, folder, "stress", "out", "--force", "--source", source, code=2)


def the_same_on_ranks(folder):
    """Fields, extremes and histories on 1, 2 and 3 ranks, of reduced and full-order results."""
    for formulation in ("vm+md", "nlffr"):
        (folder / "scene.yaml").write_text(SHAKEN)
        floe(FLOE, folder, "run", "scene.yaml", "--formulation", formulation, "-o", "out", "--force", "--no-estimate")
        said, found = [], []
        for ranks in (1, 2, 3):
            said.append(floe(FLOE, folder, "stress", "out", "-o", f"on{ranks}.xdmf", "--frames", "3", "--force", ranks=ranks))
            with h5py.File(folder / f"on{ranks}.h5", "r") as file:
                values = {}
                file.visititems(lambda name, each: values.update({name: each[()]}) if isinstance(each, h5py.Dataset) else None)
            found.append((values, table(folder / f"on{ranks}.csv")))
        for values, history in found[1:]:
            assert values.keys() == found[0][0].keys()
            for name, expected in found[0][0].items():
                if name.endswith("time_of_maximum"):
                    continue  # ties of a symmetric plate
                assert np.allclose(values[name], expected, rtol=1e-7, atol=1e-9 * max(1, np.abs(expected).max())), name
            for name, expected in found[0][1].items():
                assert np.allclose(history[name], expected, rtol=1e-6, atol=1e-9 * np.abs(expected).max()), name
        assert said[0].splitlines()[:5] == said[1].splitlines()[:5] == said[2].splitlines()[:5], said


def mesh_of_l(path, n):
    """Gmsh 2.2: an L of three squares of side 1 in n x n quadrilaterals each."""
    numbers, nodes, cells = {}, [], []

    def node(i, j):
        if (i, j) not in numbers:
            numbers[i, j] = len(nodes) + 1
            nodes.append((i / n, j / n))
        return numbers[i, j]
    for i in range(2 * n):
        for j in range(2 * n):
            if i < n or j < n:
                cells.append([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)])
    edges = [(node(0, j), node(0, j + 1)) for j in range(2 * n)]
    ends = [(node(2 * n, j), node(2 * n, j + 1)) for j in range(n)]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '1 1 "root"', '1 2 "end"', '2 3 "skin"',
             "$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{i + 1} {x} {y} 0" for i, (x, y) in enumerate(nodes)] + ["$EndNodes", "$Elements"]
    rows = [(1, 1, e) for e in edges] + [(1, 2, e) for e in ends] + [(3, 3, c) for c in cells]
    lines.append(str(len(rows)))
    lines += [f"{i + 1} {kind} 2 {tag} {tag} {' '.join(map(str, at))}" for i, (kind, tag, at) in enumerate(rows)]
    path.write_text("\n".join([*lines, "$EndElements", ""]))


def singular_places(folder):
    """The re-entrant corner of an L grows with refinement and is named; so are the ends of its held edge and a point load."""
    worst = []
    for n in (4, 8, 16):
        mesh_of_l(folder / "l.msh", n)
        path, said = recovered(FLOE, folder, """
bodies:
  l:
    mesh: {file: {path: l.msh}}
    section: {thickness: 0.02}
    material: {E: 7e10, nu: 0.3, rho: 2700}
joints: {root: {type: fixed, between: [ground, l.root]}}
loads:
  pull: {type: force, at: l.end, force: [0, 1000, 0]}
motion: {end: 1, step: 0.1}
""", formulation="lffr")
        found = Fields(path, "l")
        corner = found["singular"] == 3
        assert corner.sum() == 3 and np.all(np.linalg.norm(found.x[corner] - [1, 1, 0], axis=1) < 1 / n)
        ends = found["singular"] == 2
        assert ends.sum() == 2 and np.all(found.x[ends, 0] < 1 / n)
        worst.append(found["von_mises"][corner].max())
    assert worst[0] * 1.2 < worst[1] and worst[1] * 1.2 < worst[2], worst
    assert "singular" in said
    path, _ = recovered(FLOE, folder, STRIP.replace("CELLS", "triangles").replace("at: strip.right", "at: strip.p3"))
    found = Fields(path, "strip")
    assert np.all(np.linalg.norm(found.x[found["singular"] == 1] - [1, 0.05, 0], axis=1) < 0.03)


def refusals(folder):
    """One line, exit code 2, nothing written."""
    (folder / "scene.yaml").write_text(PLANAR)
    floe(FLOE, folder, "run", "scene.yaml", "-o", "out", "--force", "--no-estimate")
    for words, phrase in ((["out", "--at", "7"], "--at 7: is not within the simulation; expected 0 to 1 s"),
                          (["out", "--history", "boom:1,0"], "--history boom:1,0: names no body with stresses"),
                          (["out", "--history", "beam:1,x"], "--history beam:1,x: expected BODY:X,Y,Z"),
                          (["nothing"], "motion 'nothing': is not there"),
                          (["out", "-o", "a.txt"], "stress 'a.txt': expected a name that ends in .xdmf")):
        told = floe(FLOE, folder, "stress", *words, code=2)
        assert phrase in told and told.count("\n") == 1, told
    assert not (folder / "out/stress.h5").exists()
    floe(FLOE, folder, "stress", "out")
    assert "exists; use another name, or replace it with --force" in floe(FLOE, folder, "stress", "out", code=2)
    (folder / "scene.yaml").write_text(PLANAR.replace("500", "600"))
    assert "has changed since the run; expected the same, or --scene FILE" in floe(FLOE, folder, "stress", "out", "--force", code=2)
    (folder / "other.yaml").write_text(PLANAR.replace("elements: 10", "elements: 12"))
    told = floe(FLOE, folder, "stress", "out", "--force", "--scene", "other.yaml", code=2)
    assert "body beam: has 11 nodes in the results and 13 in the scene" in told, told
    (folder / "scene.yaml").write_text(PLANAR.replace(", fibre: 0.02", ""))
    floe(FLOE, folder, "run", "scene.yaml", "-o", "out", "--force", "--no-estimate")
    said = floe(FLOE, folder, "stress", "out", "--force")
    assert "all 10 elements have forces and moments, but no stresses" in said and "others" not in said, said


def springs_are_no_elements(folder):
    """The springs of a straight edge are neither counted nor have they stresses; the tension is nearly uniform (rotations of
    the corners about the normal are free)."""
    scene = CLAMPED.replace("[24, 24]", "[4, 4]").replace("type: fixed", "type: support")
    for name, hold in (("left", "hold: [x, z]"), ("bottom", "hold: [y, z]"), ("top", "hold: [z]"),
                       ("right", "hold: [z], straight: [x]")):
        scene = scene.replace(f"plate.{name}]}}", f"plate.{name}], {hold}}}")
    scene = scene.replace("{type: pressure, body: plate, pressure: 10}", "{type: force, at: plate.right, force: [50, 0, 0]}")
    for ranks in (1, 3):
        path, said = recovered(FLOE, folder, scene, ranks=ranks)
        assert "16 elements of plate" in said, said
        found = Fields(path, "plate")
        assert len(found.x) == 16 and found["membrane_force"].shape[0] == 16
        close(found["membrane_force"][:, 0], np.full(16, 50.0), 0.12, "N")
    said = floe(FLOE, folder, "check", "scene.yaml")
    assert "plate        16 " in said, said
    floe(FLOE, folder, "reduce", "scene.yaml", "-o", "plate.h5")
    assert ", 16 elements" in floe(FLOE, folder, "info", "plate.h5")


def main():
    tests = [strip_under_force, plate_under_pressure, navier, layers, beams, beams_of_decks, linear_beam, round_bars, large_rotations, reduced_against_full_order,
             corrected_from_the_start, body_from_a_file,
             the_same_on_ranks, singular_places, springs_are_no_elements, refusals]
    if shutil.which("ccx"):
        tests.append(lambda folder: calculix.plate_of_second_order(FLOE, folder))
    else:
        print("SKIPPED: CalculiX is not installed")
    wanted = sys.argv[2:]
    for test in tests:
        if wanted and test.__name__ not in wanted:
            continue
        with tempfile.TemporaryDirectory() as name:
            said = test(pathlib.Path(name))
            print(f"passed: {test.__name__}" + (f" {said}" if said else ""), flush=True)


if __name__ == "__main__":
    main()
