"""Decks whose units, densities, supports or loads are not what they seem: what every command says of them."""
NODES = "*NODE\n1, 0, 0, 0\n2, {0}, 0, 0\n3, {1}, 0, 0\n4, 0, {0}, 0\n5, {0}, {0}, 0\n6, {1}, {0}, 0\n"
SHELLS = "*ELEMENT, TYPE=S4, ELSET=LEFT\n1, 1, 2, 5, 4\n*ELEMENT, TYPE=S4, ELSET=RIGHT\n2, 2, 3, 6, 5\n*NSET, NSET=ROOT\n1, 4\n*NSET, NSET=TIP\n6\n"
MATERIALS = "*MATERIAL, NAME=STEEL\n*ELASTIC\n{0}, 0.3\n*DENSITY\n{1}\n"
FOAM = "*MATERIAL, NAME=FOAM\n*ELASTIC\n2e11, 0.3\n"
SECTIONS = "*SHELL SECTION, ELSET=LEFT, MATERIAL=STEEL\n{0}\n*SHELL SECTION, ELSET=RIGHT, MATERIAL={1}\n{0}\n"
STEP = "*STEP\n*STATIC\n*BOUNDARY\nROOT, 1, 6\n*CLOAD\n6, 3, 1.0\n*DLOAD\nLEFT, P, 10.\n*END STEP\n"

METRES = (NODES.format(1, 2), MATERIALS.format(2e11, 7800))
MILLIMETRES = (NODES.format(1000, 2000), MATERIALS.format(2e5, 7.8e-9))


def deck(units, thickness, material="STEEL", more=""):
    nodes, materials = units
    return nodes + SHELLS + materials + (FOAM if material == "FOAM" else "") + SECTIONS.format(thickness, material) + more


def scene(mesh="path: part.inp", more=""):
    return (f"bodies: {{p: {{mesh: {{file: {{{mesh}}}}}{more}, reduction: {{modes: 2, derivatives: none}}}}}}\n"
            "joints: {root: {type: fixed, between: [ground, p.ROOT]}}\nloads: {f: {type: force, at: p.TIP, force: [0, 0, t]}}\n"
            "probes: {tip: {at: p.TIP}}\nmotion: {end: 2e-4, step: 1e-4}\n")


MASSLESS = ("part.inp: material FOAM has no density: it adds stiffness without mass to part RIGHT (1 of 2 elements); "
            "expected *DENSITY")
STEPS = "is ignored (*STATIC, *BOUNDARY, *CLOAD, *DLOAD): supports and loads are those of the scene"
BEFORE = "part.inp:25: *BOUNDARY is ignored: supports are joints of the scene"
# 2 mm in metres on a mesh whose diagonal is sqrt(5) m after scaling, sqrt(5) 1000 mm before
SCALED = ("part.inp: scale 0.001 applies to coordinates only", "part LEFT is 2 thick, 89 % of the scaled extent 2.236",
          "(0.089 % in the deck's own units)")
BY_NAME = ", parts: {%s}" % ", ".join(f"{part}: {{section: {{thickness: 0.002}}, material: {{E: 2e11, nu: 0.3, rho: 7800}}}}"
                                     for part in ("LEFT", "RIGHT"))
COMMANDS = {"run": ["run", "scene.yaml", "-o", "out"], "modes": ["modes", "scene.yaml"], "check": ["check", "scene.yaml"],
            "static": ["static", "scene.yaml", "--steps", "1", "--at", "1e-3", "-o", "out"],
            "compare": ["compare", "scene.yaml", "--formulations", "vm", "-o", "out"], "reduce": ["reduce", "scene.yaml", "-o", "p.h5"]}


# one quadrilateral of second order; its edge at x = 0, and a corner
ALONE = ("*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 0.5, 0, 0\n6, 1, 0.5, 0\n7, 0.5, 1, 0\n8, 0, 0.5, 0\n"
         "*ELEMENT, TYPE=S8R, ELSET=LEFT\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*NSET, NSET=EDGE\n1, 4, 8\n*NSET, NSET=ROOT\n1\n*NSET, NSET=TIP\n3\n"
         + MATERIALS.format(7e10, 2700) + "*SHELL SECTION, ELSET=LEFT, MATERIAL=STEEL\n0.01\n")
MECHANISM = "1 of 1 elements is a quadrilateral of second order (S8R) without an edge in common with another shell"


def once(*phrases):
    """Each stands on stdout once."""
    def check(folder):
        text = (folder / "stdout").read_text()
        for phrase in phrases:
            assert text.count(phrase) == 1, f"stdout has {text.count(phrase)} times {phrase!r}"
    return check


def cases(Case):
    for name, words in COMMANDS.items():
        yield Case(f"deck: no density, {name}", words, 0, lines=0, shows=(MASSLESS,), check=once(MASSLESS), scene=scene(),
                   files={"part.inp": deck(METRES, 0.01, "FOAM")})
        yield Case(f"deck: supports and loads, {name}", words, 0, lines=0, check=once(STEPS, BEFORE), scene=scene(),
                   files={"part.inp": deck(METRES, 0.01, more="*BOUNDARY\nROOT, 1, 6\n" + STEP)})
        yield Case(f"deck: scale, {name}", words, 0, lines=0, check=once(*SCALED), scene=scene("path: part.inp, scale: 1e-3"),
                   files={"part.inp": deck(MILLIMETRES, 2)})
    for name in ("modes", "run", "static"):
        yield Case(f"deck: a single S8R, {name}", COMMANDS[name], 1, (MECHANISM, "take two or more of them side by side"), lines=1,
                   scene=scene(), files={"part.inp": ALONE})
    yield Case("deck: a single S8R held at an edge", COMMANDS["modes"], 0, lines=0, shows=("[Hz]",),
               scene=scene().replace("p.ROOT", "p.EDGE"), files={"part.inp": ALONE})
    for name in ("modes", "check"):
        yield Case(f"deck: in place of a scene, {name}", [name, "part.inp"] + ["--frequencies", "2"] * (name == "check"), 0, lines=0,
                   shows=("body", "[Hz]"), files={"part.inp": deck(METRES, 0.01)})
        yield Case(f"deck: that is not there, {name}", [name, "none.inp"], 2, says=("none.inp",), lines=1)
    rigid = deck(METRES, 0.01, more="*NSET, NSET=WHOLE, GENERATE\n2, 6, 1\n*RIGID BODY, REF NODE=1, NSET=WHOLE\n")
    yield Case("deck: one that cannot deform", ["check", "part.inp", "--frequencies", "2"], 0, lines=0, shows=("none",),
               files={"part.inp": rigid})
    silent = {"never": ("Note: part.inp", "has no density", "scale"), "lines": 0}
    yield Case("deck: in millimetres throughout", ["modes", "scene.yaml"], 0, scene=scene(),
               files={"part.inp": deck(MILLIMETRES, 2)}, **silent)
    yield Case("deck: scaled, with sections of the scene", ["modes", "scene.yaml"], 0, files={"part.inp": deck(MILLIMETRES, 2)},
               scene=scene("path: part.inp, scale: 1e-3", BY_NAME), **silent)
    sprung = deck(METRES, 0.01, more="*ELEMENT, TYPE=SPRINGA, ELSET=S\n9, 1, 6\n*SPRING, ELSET=S\n\n1e5\n")
    for name, fault, says in (("doubled element", ("*NSET, NSET=ROOT", "*ELEMENT, TYPE=S4, ELSET=LEFT\n3, 1, 2, 5, 4\n*NSET, NSET=ROOT"), "element 3 has the nodes of element 1"),
                              ("collapsed element", ("1, 1, 2, 5, 4", "1, 1, 2, 5, 5"), "element 1 has the same node twice")):
        yield Case(f"deck: refined, {name}", COMMANDS["modes"], 2, says=(says,), scene=scene("path: part.inp, refine: 1"),
                   files={"part.inp": deck(METRES, 0.01).replace(*fault)})
    yield Case("deck: springs", COMMANDS["run"], 0, lines=0, scene=scene(), files={"part.inp": sprung})
    yield Case("deck: springs, cfr", COMMANDS["run"] + ["--formulation", "cfr"], 0, lines=0, scene=scene(), files={"part.inp": sprung})
    yield Case("deck: springs, frames", COMMANDS["modes"], 2, ("the spring between nodes 1 and 6 of body p joins two of its 2 frames; expected",),
               lines=1, scene=scene(more=", frames: 2"), files={"part.inp": sprung})
    yield Case("deck: a stiffness that is not positive", COMMANDS["modes"], 2, ("the section of LEFT: a shell's membrane stiffness A is not positive",),
               lines=1, scene=scene(), files={"part.inp": deck(METRES, 0.01, more="*SHELL GENERAL SECTION, ELSET=LEFT\n-1., 0.\n0., 1.\n0.\n")})
