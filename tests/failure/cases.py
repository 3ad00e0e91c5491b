"""The table of the failure tests."""
import dataclasses
import json
import os
import pathlib
import signal
from typing import Callable, Optional, Union

import decks
import reduced
import runtime
import space
from results import absent, estimated, files, full, kept, killed, no_error_of, no_results, not_looked, nothing, stands, stopped_once
from scenes import GAP, HELD_ROD, PLATE, RIGID, rod, scene

ENVIRONMENT = dict(os.environ)
BLADE = pathlib.Path(__file__).resolve().parents[2] / "examples/blade/options"


@dataclasses.dataclass
class Case:
    name: str
    arguments: list
    codes: Union[int, tuple] = 0
    says: tuple = ()  # phrases that stand exactly once on stderr
    shows: tuple = ()  # phrases that stand on stdout
    never: tuple = ()  # phrases that stand nowhere
    lines: Optional[int] = None  # how many messages of floe
    scene: Union[str, bytes, None] = dataclasses.field(default_factory=scene)
    files: dict = dataclasses.field(default_factory=dict)
    prepare: Optional[Callable] = None  # changes the folder before the run
    environment: dict = dataclasses.field(default_factory=dict)
    file_size: Optional[int] = None  # no file grows beyond so many KiB
    ranks: tuple = (1, 2)  # 2: on several
    stdout: str = "stdout"  # where it goes, from the folder
    signal: Optional[int] = None  # is sent when rows are written
    check: Optional[Callable] = None

    def __post_init__(self):
        self.codes = self.codes if isinstance(self.codes, tuple) else (self.codes,)


# Strip of shells on a hub; its frequencies in cfr are those of one rank.
ROTATING_STRIP = """
bodies:
  hub:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [0.1, 0, 0], elements: 1}}
    section: {shape: rectangle, width: 0.05, height: 0.05, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
  strip:
    mesh: {plate: {origin: [0.1, -0.05, 0], along: [1, 0, 0], across: [0, 0.1, 0], elements: [8, 2]}}
    section: {thickness: 2e-3}
    material: {E: 7e10, nu: 0.3, rho: 2700}
joints:
  drive: {type: driven, between: [ground, hub.start], axis: [0, 0, 1], angle: "t"}
  weld: {type: fixed, between: [hub.end, strip.left]}
"""
MODAL = {"bodies.beam.damping": {"modal": [0.01]}}
MEAN_DEFLECTION = {"bodies.beam.frame": "mean-axis", "probes.bend": {"at": "beam.middle", "quantity": "deflection"}}
ROTATION = {"joints.clamp": {"type": "driven", "between": ["ground", "beam.start"], "angle": "2*t"}, "motion.start": "steady_rotation",
            "loads": None}  # not in cfr in the plane


def rows_of(folder, word, count):
    """So many rows of a table on standard output have this word."""
    found = sum(word in line.split() for line in (folder / "stdout").read_text().splitlines())
    assert found == count, f"{found} rows with {word!r}, not {count}"


def run(formulation="vm+md", *more):
    return ["run", "scene.yaml", "--formulation", formulation, "-o", "out", *more]


def case(name, *, formulations=("vm+md",), options=(), changes=None, **rest):
    """One case for each formulation: `floe run` of the scene with `changes`."""
    rest.setdefault("scene", scene(changes))
    for formulation in formulations:
        full_name = name if len(formulations) == 1 else f"{name}, {formulation}"
        yield Case(full_name, run(formulation, *options), **rest)


COMMANDS = [
    Case("help", ["--help"], shows=("Usage: floe", "run", "compare", "schema"), lines=0),
    *(Case(f"help of {c}", [c, "--help"], shows=("SCENE",)) for c in ("run", "compare", "tradeoff", "sweep", "static", "campbell", "modes", "check")),
    Case("help of PETSc", ["-help"], shows=("compare", "-log_view")),
    Case("help of the solvers", run("vm+md", "-help"), shows=("-modes_eps_nev", "-motion_ts_dt")),
    Case("version", ["--version"], shows=("floe 0",), lines=0),
    Case("schema", ["schema"], shows=("motion", "spectral_radius")),
    Case("check", ["check", "scene.yaml"], shows=("1 joints",)),
    Case("check of attachment modes", ["check", "scene.yaml"], lines=0, shows=("1 attachment mode, all 6 static derivatives of each pair",),
         scene=scene({"bodies.beam.reduction": {"modes": 2, "attachment": "all"}, "loads": {"tip": {"type": "force", "at": "beam.end", "force": [0, 1]}}})),
    Case("check of many products", ["check", "scene.yaml"], lines=0, shows=("Note: body f: up to 77 basis vectors, and 3003 products",),
         scene="bodies: {f: {mesh: {plate: {along: [1, 0, 0], across: [0, 0.2, 0], elements: [40, 15]}}, strains: second_order, section: "
               "{thickness: 0.005}, material: {E: 7e10, nu: 0.3, rho: 2700}, reduction: {modes: 11}}}\n"
               "joints: {root: {type: fixed, between: [ground, f.left]}}\n"),
    Case("check of an event of no component", ["check", "scene.yaml"], 2, ('is "tip.w"; expected one of tip.x, tip.y',), lines=1, check=nothing,
         scene=scene({"events": {"off": {"stop": True, "probe": "tip.w", "crosses": 1}}})),
    Case("check of many elements", ["check", "scene.yaml"], shows=("300003", "is not built"),
         scene=scene({"bodies.beam.mesh.line.elements": 100000})),
    Case("modes of nearly all dofs", ["modes", "scene.yaml"], lines=0, shows=("Note: body f: mode", "(limit 1e-04)"),
         scene="bodies: {f: {mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 60}}, section: {shape: rectangle, "
               "width: 0.01, height: 0.02, orientation: [0, 1, 0]}, material: {E: 7e10, nu: 0.3, rho: 2700}, "
               "reduction: {modes: 355, derivatives: none}}}\n"),
    Case("modes cut among equal ones", ["modes", "scene.yaml"], lines=0,
         shows=("Note: body f: 1 more mode has the frequency of mode 1, the last one, and is omitted; ask for 2 modes",),
         scene=rod(modes=1, more=HELD_ROD)),
    Case("shear that is no list", ["modes", "scene.yaml"], 2, ("shear_factor",), lines=1,
         scene=rod(", shear_factor: 0.9")),
    Case("shear of one direction", ["modes", "scene.yaml"], 2, ("shear_factor", "is not two numbers greater than 0"), lines=1,
         scene=rod(", shear_factor: [0.9]")),
    Case("equilibria with modes cut among equal ones", ["static", "scene.yaml", "-o", "out"], 0, lines=0,
         shows=("Note: body f: 1 more mode has the frequency of mode 1",),
         scene=rod(modes=1, more=HELD_ROD + "loads: {tip: {type: force, at: f.end, force: [0, t, 0]}}\nprobes: {tip: {at: f.end}}\n")),
    *(Case(f"an initial deformation without its shortening in {formulation}", run(formulation), 1,
           ("the simulation stopped at t = 0", "initial.deformation of beam: its strain energy is",
            "the deflections stretch the body", "start: equilibrium"), lines=1,
           scene=scene({"bodies.beam.initial": {"deformation": [0, "0.3*x^2"]}, "loads": None, "bodies.beam.section.EA": 1e9}))
      for formulation in ("vm+md", "nlffr", "cfr")),
    Case("a selection for an initial deformation without its shortening", run("vm+md", "--accuracy", "reduction:20%"), lines=0,
         shows=("Note: initial.deformation of beam: its strain energy is",),
         scene=scene({"bodies.beam.initial": {"deformation": [0, "0.05*x^2"]}, "loads": None})),
    Case("a comparison with shear", ["compare", "scene.yaml", "-o", "out"], 0, lines=0, shows=("CFR", "NLFFR"),
         scene=scene({"bodies.beam.section.GA": 1e6})),
    *(Case(f"modal damping of a body in frames, {formulation}", run(formulation), 0, lines=0, check=files("finished", 51),
           scene=scene({"bodies.beam.frames": 2, "bodies.beam.damping": {"modal": [0.01]}}))
      for formulation in ("vm+md", "nlffr", "cfr")),
    Case("modal damping of a body in frames, accuracy", run("vm+md", "--accuracy", "5%"), 0, lines=0,
         scene=scene({"bodies.beam.frames": 2, "bodies.beam.damping": {"modal": [0.01]}})),
    Case("modes as they should be", ["modes", "scene.yaml"], lines=0, never=("Note: body beam: mode",)),
    Case("check without a motion", ["check", "scene.yaml"], lines=0, scene=scene({"motion": None}),
         shows=("1 joints", "no motion: sufficient for modes, reduce, static and campbell"), never=("steps of",)),
    Case("check of too many modes", ["check", "scene.yaml"], 2,
         ("bodies.f.reduction.modes: 40 modes requested of a body that has 18 elastic dofs under its conditions",), lines=1,
         scene=rod(modes=40, more=HELD_ROD + "motion: {end: 1, step: 1e-2}\n")),
    Case("modes", ["modes", "scene.yaml"], shows=("rad/s",)),
    *(Case(f"full standard output of {words[0]}", words, 1, ("cannot write to ",),
           lines=1, stdout="/dev/full", ranks=(1,))
      for words in (["modes", "scene.yaml"], run(), ["check", "scene.yaml"], ["schema"], ["--help"])),
    Case("no command", [], 2, ("subcommand is required",), lines=1),
    Case("unknown command", ["rnu", "scene.yaml"], 2, ('"rnu" is not a command', "floe --help"), lines=1, check=nothing),
    Case("unknown option", ["run", "scene.yaml", "--formulaton", "vm"], 2, ("--formulaton",), lines=1, check=nothing),
    Case("no scene", ["run"], 2, ("SCENE is required",), lines=1),
    Case("unknown formulation", run("vm+mb"), 2,
         ('"vm+mb" is not one of', 'did you mean "vm+md"?'), lines=1, check=nothing),
    Case("formulation named twice", ["compare", "scene.yaml", "--formulations", "vm,lffr,vm", "-o", "out"], 2,
         ('"vm" is given twice',), lines=1, check=nothing),
    Case("trade-off against a reduced model", ["tradeoff", "scene.yaml", "--reference", "vm", "-o", "out"], 2,
         ("--reference: is vm; expected nlffr or cfr",), lines=1, check=nothing),
    Case("trade-off against cfr, which the scene does not have",
         ["tradeoff", "scene.yaml", "--reference", "cfr", "-o", "out"], 2,
         ("--reference cfr: formulation cfr", "is steady_rotation", "expected --reference nlffr"), lines=1,
         scene=scene(ROTATION), check=nothing),
    Case("residual responses of a body alone", ["reduce", "scene.yaml", "-o", "beam.h5"], 2,
         ("bodies.beam.reduction.responses", "needs a simulation of the whole scene"), lines=1,
         scene=scene({"bodies.beam.reduction": {"modes": 2, "responses": 3}})),
    Case("residual responses, less than none", run(), 2, ("bodies.beam.reduction.responses",), lines=1,
         scene=scene({"bodies.beam.reduction": {"modes": 2, "responses": -1}}), check=nothing),
    Case("trade-off in no time", ["tradeoff", "scene.yaml", "--time-budget", "0", "-o", "out"], 2, ("--time-budget",),
         check=nothing),
    Case("trade-off for no accuracy", ["tradeoff", "scene.yaml", "--accuracy", "0", "-o", "out"], 2, ("accuracy",),
         check=nothing),
    Case("unknown formulation of several", ["compare", "scene.yaml", "--formulations", "cfr,nlfr", "-o", "out"], 2,
         ('"nlfr" is not one of', 'did you mean "nlffr"?'), lines=1, check=nothing),
]

SCENES = [
    Case("scene missing", run(), 2, ("scene.yaml: cannot be read: No such file",), lines=1, scene=None, check=nothing),
    Case("scene is a folder", run(), 2, ("is a folder; expected a scene file",), lines=1, scene=None,
         prepare=lambda folder: (folder / "scene.yaml").mkdir(), check=nothing),
    Case("scene empty", run(), 2, ("scene.yaml: is empty; expected a scene",), lines=1, scene="", check=nothing),
    Case("scene binary", run(), 2, ("is not a text file; expected a scene in YAML",), lines=1,
         scene=bytes(range(256)), check=nothing),
    Case("scene no YAML", run(), 2, ("scene.yaml:3:7: is not valid YAML",), lines=1,
         scene="title: x\nbodies: {a: [1, 2\nmotion: 3\n", check=nothing),
    *case("several faults", codes=2, lines=3, check=nothing,
          says=("bodies.beam.section.EI", "motion.stepp: unknown key",
                'did you mean "step"?', "motion.step: is missing"),
          changes={"bodies.beam.section.EI": -1, "motion": {"end": 1, "stepp": 0.1}}),
    *case("unknown key", codes=2, lines=1, check=nothing, changes={"titel": "x"},
          says=("scene.yaml:57:2: titel: unknown key; expected one of", 'did you mean "title"?')),
    *case("density zero", codes=2, says=("bodies.beam.section.rhoA: is 0",), changes={"bodies.beam.section.rhoA": 0},
          lines=1, check=nothing),
    *case("frame through one place", codes=2, says=("from and to are the same node", "expected two different places"),
          changes={"bodies.beam.frame": {"type": "pinned", "from": "end", "to": "end"}}, lines=1, check=nothing),
    *case("place that matches nothing", codes=2, says=('has no place "tip"',), lines=1, check=nothing,
          changes={"probes.tip.at": "beam.tip"}),
    *case("joint apart", codes=2, says=("apart at the start", "expected one point"), lines=1, check=nothing,
          changes={"joints.far": {"type": "revolute", "between": [{"body": "ground", "node": [3, 0]}, "beam.end"]}}),
    *case("joint apart by its initial position", formulations=("vm+md", "cfr"), codes=2, says=("apart at the start",),
          changes={**RIGID, "bodies.link.initial": {"position": [0, 0.1]}}, lines=1, check=nothing),
    *case("driven angle not 0 at the start", codes=2, lines=1, says=("at t = 0", "expected 0"), check=no_results,
          changes={"joints.clamp": {"type": "driven", "between": ["ground", "beam.start"], "angle": "0.1 + t"}}),
    *case("more modes than dofs", codes=2, says=("100 modes", "scene.yaml:"), lines=1, check=no_results,
          changes={"bodies.beam.reduction.modes": 100}),
    *case("modal damping", formulations=("vm+md", "nlffr", "cfr"), changes=MODAL, check=files("finished", 51)),
    *case("deflection from a mean-axis frame in cfr", formulations=("cfr",), lines=0, changes=MEAN_DEFLECTION,
          check=files("finished", 51)),
    *case("load in body axes in cfr", formulations=("cfr",), lines=0, changes={"loads.tip.axes": "body"},
          check=files("finished", 51)),
    *case("steady rotation in cfr", formulations=("cfr",), codes=2, lines=1, check=no_results,
          says=("scene.yaml:", "which formulation cfr has in space only"), changes=ROTATION),
    *case("formula not a number when read", codes=2, lines=1, check=nothing,
          says=("loads.tip.force[2]", "is not a number at t ="), changes={"loads.tip.force": [0, "sqrt(0.03 - t)"]}),
]

OWN = '{"provenance": {"floe": {"version": "0.1"}}}'
PLATE_MOTION = PLATE.replace("[60, 30]", "[4, 2]") + """loads: {tip: {type: force, at: plate.right, force: [0, 0, t]}}
motion: {end: 0.001, step: 0.001}
"""

HUB = """
bodies:
  hub: {rigid: true, mesh: {line: {from: [-1, 0.5, 0], to: [0, 0.5, 0], elements: 1}},
        section: {shape: circle, radius: 0.1, orientation: [0, 1, 0]}, material: {E: 1, nu: 0.3, rho: 1000}}
  plate:
    mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [4, 2]}}
    section: {thickness: 0.002}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 2}
joints:
  root: {type: fixed, between: [hub.end, plate.left]}
"""
IN_SPACE = [
    *(Case(f"pressure on {name}, {formulation}", run(formulation), 2, (says,), scene=HUB + load + "motion: {end: 0.002, step: 0.001}\n",
           lines=1, check=no_results)
      for name, load, says in (
          ("beams", "loads: {p: {type: pressure, body: hub, pressure: 1}}\n", "the mesh of body hub has no shells"),
          ("a part that is not there", "loads: {p: {type: pressure, body: plate, part: skin, pressure: 1}}\n",
           'loads.p.part: plate has no part "skin"'))
      for formulation in ("vm+md", "nlffr")),
    Case("a hinge along an edge at a rigid piece", run(), 2, ("joints.hinge: its edge has nodes of a rigid region",), lines=1,
         check=no_results, scene=HUB + "  hinge: {type: revolute, between: [ground, plate.bottom], edges: mean}\n"
         "motion: {end: 0.002, step: 0.001}\n"),
    Case("a hinge line that a rigid piece leads", run(), scene=HUB
         + "  hinge: {type: revolute, between: [ground, plate.bottom]}\nmotion: {end: 0.002, step: 0.001}\n",
         check=files("finished", 3)),
    Case("an edge of a piece that a clamp holds besides", run(), scene=HUB
         + "  clamp: {type: fixed, between: [ground, plate.bottom]}\nmotion: {end: 0.002, step: 0.001}\n",
         check=files("finished", 3)),
]

FOLDERS = [
    Case("motion of no folder", ["motion", "none"], 2, ("motion 'none': is not there; expected the folder of a run",), lines=1,
         check=absent("none")),
    Case("motion of no run", ["motion", "out"], 2, ("motion 'out': has no result.h5",), lines=1, files={"out/mine.txt": "mine"}),
    Case("motion of a damaged result", ["motion", "out"], 2, ("motion 'out': result.h5: ",), lines=1,
         files={"out/result.h5": "no HDF5"}, check=absent("out/motion.xdmf")),
    Case("motion enlarged by no number", ["motion", "out", "--amplify", "nan"], 2, ("--amplify: is nan; expected a number",), lines=1),
    Case("plot of nothing", ["plot", "none"], 2, ("plot: none: does not exist",), lines=1),
    Case("report on nothing", ["report", "none"], 2, ("report: none: is not a folder",), lines=1),
    Case("folder not empty", run(), 2, ("out': is not empty", "--force"), lines=1, files={"out/mine.txt": "mine"},
         check=kept("out/mine.txt", "mine")),
    Case("folder without a name", ["run", "scene.yaml", "-o", ""], 2, ("needs a name",), lines=1, check=nothing),
    *case("folder that nothing came into", codes=2, lines=1, says=("an option -modes_... is rejected", "in EPSSetDimensions_Default", "EPSSolve"),
          never=("epssetup.c", "epsdefault.c"), options=("-modes_eps_ncv", "1"), check=nothing),
    Case("folder forced", run("vm+md", "--force"), 0, files={"out/mine.txt": "mine", "out/summary.json": OWN},
         check=lambda folder: (kept("out/mine.txt", "mine")(folder), files("finished", 51)(folder))),
    Case("folder forced for a bad scene", run("vm+md", "--force"), 2, ("100 modes",), lines=1,
         scene=scene({"bodies.beam.reduction.modes": 100}), files={"out/summary.json": OWN},
         check=kept("out/summary.json", OWN)),
    *case("folder forced for a scene that cannot be built", formulations=("cfr",), options=("--force",), codes=2,
          lines=1, says=("is steady_rotation",), changes=ROTATION,
          files={"out/summary.json": OWN}, check=kept("out/summary.json", OWN)),
    Case("folder forced with another's summary", run("vm+md", "--force"), 2,
         ("out': summary.json in it is not a result of floe;",), lines=1, files={"out/summary.json": "{}"},
         check=kept("out/summary.json", "{}")),
    Case("comparison forced with another's probes", ["compare", "scene.yaml", "-o", "out", "--force"], 2,
         ("out/vm': probes.csv in it is not a result of floe;",), lines=1, files={"out/vm/probes.csv": "t [s],x\n"},
         check=lambda folder: (kept("out/vm/probes.csv", "t [s],x\n")(folder), absent("out/cfr")(folder))),
    *(Case(f"static to t = {at}", ["static", "scene.yaml", "--at", at, "-o", "out"], 2,
           (f"--at: is {at}; expected a positive number",), lines=1, check=nothing)
      for at in ("nan", "inf", "0", "-1", "1e-400", "2s")),
    Case("shapes in a folder that is not there", ["modes", "scene.yaml", "--write", "none/q.xdmf"], 2,
         ("shapes 'none/q.xdmf': cannot write none/q.xdmf: No such file",), never=("partial",), lines=1),
    Case("partitioning by another library", run("vm+md", "-mesh_mat_partitioning_type", "ptscotch"), 0, lines=0,
         scene=PLATE_MOTION, check=files("finished", 2)),
    Case("folder is a file", run(), 2, ("exists and is not a folder",), lines=1, files={"out": "mine"},
         check=kept("out", "mine")),
    Case("folder below a file", ["run", "scene.yaml", "-o", "mine/out"], 2, ("mine/out': ", "Not a directory"),
         lines=1, files={"mine": "mine"}, check=kept("mine", "mine")),
    Case("folder not writable", ["run", "scene.yaml", "-o", "/proc/floe"], 2, ("/proc/floe': ",), lines=1),
    Case("folder of compare not empty", ["compare", "scene.yaml", "-o", "out"], 2, ("is not empty",), lines=1,
         files={"out/mine.txt": "mine"}, check=kept("out/mine.txt", "mine")),
    Case("folder by default", ["run", "scene.yaml", "--formulation", "lffr"], 0,
         check=files("finished", 51, out="results/scene-lffr")),
    Case("scene in a read-only folder", ["run", "there/scene.yaml", "-o", "out"], 0, scene=None,
         files={"there/scene.yaml": scene()}, prepare=lambda folder: (folder / "there").chmod(0o555),
         check=files("finished", 51)),
]

# Adaptive: the rows are not known before, so that the result grows: it is written anew, twice as large, after 4096
# steps (vm+md: 0.7 MiB) or 16 (nlffr: 3 MiB).
GROWING = {"motion.end": 1000, "motion.tolerance": 1e-4, "bodies.beam.reduction": {"modes": 3, "derivatives": "none"}}
GROWING_FAST = {**GROWING, "bodies.beam.mesh.line.elements": 4000}
# Minutes of steps, few of them stored: room for all that the motion will store is made at its start (1e7 rows: 2.7 GB).
LONG = {"motion.end": 100, "motion.step": 1e-4, "motion.every": 10}
SMALL_FILES = {"PMIX_MCA_gds": "hash", "OMPI_MCA_btl": "self,tcp"}  # Open MPI's own would be too large

# s that mpirun waits before SIGTERM and again before SIGKILL, however soon the ranks end
PATIENT = {"OMPI_MCA_odls_base_sigkill_timeout": "4"}

# Let go from a bow, in steps of some periods of the axial vibrations that this excites.
RELEASED = {"bodies.beam.initial": {"deformation": ["-0.3^2*9/8*(4/3*x^3 - x^4 + x^5/5)", "0.3*(3*x^2 - x^3)/2"]},
            "bodies.beam.section.EA": 1e7, "loads": {}, "motion.end": 1}
STIFF_START = {**RELEASED, "bodies.beam.damping": {"stiffness": 2e-4}, "motion.tolerance": 1e-3}
def errors_after_events(*ranges):
    """The step_error of each event is between two numbers."""
    def check(folder):
        found = [event.get("step_error", 0) for event in json.loads((folder / "out/summary.json").read_text())["events"]]
        assert len(found) == len(ranges) and all(low <= one <= high for one, (low, high) in zip(found, ranges)), found
    return check


LET_GO = {"bodies.beam.mesh": {"line": {"from": [0, 0], "to": [1, 0], "elements": 12}},
          "bodies.beam.section": {"A": 1e-4, "I": 2.1e-10}, "bodies.beam.material": {"E": 2e9, "rho": 1000},
          "bodies.beam.damping": {"stiffness": 1e-4}, "motion.end": 2.5, "events": {"off": {"unlock": "clamp", "at": 1.7}},
          "loads.tip.force": [0, "0.4*(1-smooth(t,1.2,1.5))*smooth(t,0,0.3)"]}

FAULTS = [
    *case("formula fails in the run", formulations=("vm+md", "nlffr", "cfr"), codes=1, lines=1,
          says=("stopped at t = 0.02 of 0.05, after 20 steps", "is not a number at t = 0.021"),
          changes={"loads.tip.force": [0, GAP]}, check=files("failed", 21, "is not a number", 0.02)),
    *case("formula fails between stored steps", formulations=("vm+md", "nlffr"), codes=1, lines=1,
          changes={"loads.tip.force": [0, GAP], "motion.every": 7}, check=files("failed", 4, "is not a number", 0.02)),
    *case("angle fails in the run", formulations=("vm+md", "nlffr"), codes=1, lines=1, says=("is not a number",),
          changes={"joints.clamp": {"type": "driven", "between": ["ground", "beam.start"], "angle": f"t^3 + 0*{GAP}"}},
          check=files("failed", reason="is not a number")),
    *case("moment fails in the run", formulations=("vm+md", "nlffr"), codes=1, lines=1,
          says=("is infinite at t = 0.021",),
          changes={"loads.m": {"type": "moment", "at": "beam.end", "moment": "abs(t - 0.021) < 1e-4 ? 1/0*t : t"}},
          check=files("failed", 21, "is infinite")),
    *case("a load from rest that begins within round-off of a step", formulations=("vm+md", "nlffr"), lines=0,
          changes={"bodies.beam.mesh.line": {"from": [0.1, 0.2], "to": [1.03, 0.57], "elements": 10}, "motion.end": 1,
                   "loads.tip.force": [0, "0.1*max(0, t - 0.5)"], "motion.step": 0.01}, check=files("finished", 101)),
    *case("step does not converge", formulations=("vm+md", "nlffr"), codes=1, lines=1,
          says=("the simulation stopped at t = ", "did not converge", "smaller motion.step"),
          changes={"loads.tip.force": [0, 1e9], "motion.step": 0.05, "motion.end": 1},
          check=files("failed", reason="did not converge")),
    *case("step cut too often", formulations=("vm+md", "nlffr"), codes=1, lines=1,
          options=("-motion_ts_max_reject", "1"), says=("the simulation stopped at t = ", "steps repeated"),
          changes={"loads.tip.force": [0, 1e7], "motion.step": 0.05, "motion.end": 1, "motion.tolerance": 1e-6},
          check=files("failed")),
    *case("steps of one iteration that run away", formulations=("vm+md", "nlffr"), codes=1, lines=1,
          options=("-motion_snes_rtol", "1e300", "-motion_snes_lag_jacobian", "1"),
          says=("the simulation stopped at t = 0.0", "did not converge", "smaller motion.step"),
          changes=RELEASED, check=files("failed", reason="did not converge")),
    *case("the same, not every step recorded", formulations=("vm+md", "nlffr"), codes=1, lines=1,
          options=("-motion_snes_rtol", "1e300", "-motion_snes_lag_jacobian", "1"),
          says=("the simulation stopped at t = 0.0", "did not converge", "smaller motion.step"),
          changes={**RELEASED, "motion.every": 2}, check=files("failed", reason="did not converge")),
    *case("energy that nothing brought", options=("-motion_snes_rtol", "1e300"), lines=0,
          shows=("Note: total energy: grows by", "(limit 10 %)", "take a smaller motion.step"),
          changes={**RELEASED, "motion.end": 0.002}, check=files("finished", 3)),
    *case("a pulse between stored instants", lines=0, never=("total energy",), check=files("finished", 6),
          changes={"loads.tip.force": [0, "50*pulse(t, 0.021, 0.025)"], "motion.output": 0.01}),
    *case("a bent beam with dampers is let go", formulations=("nlffr",), lines=0, never=("total energy",),
          shows=("Note: event off (unlock joint clamp) at t = 1.7 s: the step after it has an estimated error of 7",
                 "take a smaller motion.step"),
          changes={**LET_GO, "motion.step": 0.005}, check=files("finished", rows=None)),
    *case("an event follows the step that a bent beam is let go in", formulations=("nlffr",), lines=0,
          changes={**LET_GO, "motion.step": 0.005, "bodies.other": {"rigid": {"mass": 1, "inertia": 1, "centre": [5, 5]}},
                   "joints.other": {"type": "fixed", "between": [{"body": "ground", "node": [5, 5]}, "other.centre"]},
                   "events": {"off": {"unlock": "clamp", "at": 1.7}, "second": {"unlock": "other", "at": 1.705}}},
          check=lambda folder: (files("finished", rows=None)(folder), errors_after_events([0.5, 2], [0, 0.2])(folder))),
    *case("a bent beam with dampers is let go in short steps", formulations=("nlffr",), lines=0,
          never=("total energy", "event off (unlock joint clamp) at"),
          changes={**LET_GO, "motion.step": 0.00125}, check=files("finished", rows=None)),
    *case("a stiff start with adaptive steps", changes={**STIFF_START, "motion.end": 0.01}, lines=0,
          never=("total energy",), check=files("finished", rows=None)),
    *case("a stiff start with few tries", codes=1, lines=1, options=("-motion_ts_max_reject", "3"),
          says=("the error of a step of", "is above the tolerance", "Try another motion.tolerance than 0.001"),
          changes=STIFF_START, check=files("failed", 1, "above the tolerance", 0)),
    *case("joints repeat each other", formulations=("vm+md", "nlffr"), lines=0,
          shows=("joint c: 3 of its 3 constraints are redundant with other joints and eliminated",),
          changes={**RIGID, "joints.b": {"type": "fixed", "between": [{"body": "ground", "node": [2, 0]}, "link.end"]},
                   "joints.c": {"type": "fixed", "between": [{"body": "ground", "node": [1, 0]}, "link.start"]}},
          check=files("finished", 51)),
    *case("steps allowed run out", formulations=("vm+md", "nlffr"), codes=1, lines=1,
          options=("-motion_ts_max_steps", "5"),
          says=("stopped at t = 0.005 of 0.05, after 5 steps", "-motion_ts_max_steps"),
          check=files("failed", 6, "-motion_ts_max_steps", 0.005)),
    *case("disk full from the start", formulations=("vm+md", "nlffr"), codes=1, lines=1, file_size=8,
          environment=SMALL_FILES, says=("result.h5.partial: File too large",), check=no_results),
    *case("disk full for the shapes", codes=1, lines=1, scene=PLATE + "motion: {end: 1e-3, step: 1e-3}\n", file_size=500,
          environment=SMALL_FILES, says=("result.h5.partial: File too large",), check=no_results),
    *case("disk full in the run", codes=1, lines=1, changes=GROWING, file_size=1600, environment=SMALL_FILES,
          says=("File too large", "the simulation stopped at t = "), check=full),
    *case("disk full in the run at full order", formulations=("nlffr",), codes=1, lines=1, changes=GROWING_FAST,
          file_size=5600, ranks=(1,), says=("File too large", "the simulation stopped at t = "), check=full),
    *case("killed", formulations=("vm+md", "nlffr"), codes=(-9, 137), changes=LONG, signal=signal.SIGKILL,
          check=killed),
    *case("told to end", formulations=("vm+md", "nlffr"), codes=(1, 143, 130), changes=LONG, signal=signal.SIGTERM,
          environment=PATIENT, check=stopped_once),
    Case("Ctrl-C in compare", ["compare", "scene.yaml", "--formulations", "vm,nlffr", "-o", "out"], (1, 130),
         lines=1, scene=scene(LONG), signal=signal.SIGINT, environment=PATIENT,
         check=lambda folder: (files("failed", reason="interrupted", out="out/vm")(folder),
                               absent("out/nlffr")(folder))),
    *case("Ctrl-C", codes=(1, 130), changes=LONG, signal=signal.SIGINT,
          environment=PATIENT, check=files("failed", reason="interrupted")),
]

OPTIONS = [
    *case("prefix nearly ours", codes=2, lines=1, options=("-mode_eps_nev", "3"), check=nothing,
          says=("-mode_eps_nev", "did you mean -modes_eps_nev?")),
    *case("prefix left out", codes=2, lines=1, options=("-ts_dt", "1e-4"), check=nothing,
          says=("-ts_dt", "did you mean -motion_ts_dt?")),
    *case("prefix unknown", codes=2, lines=1, options=("-foo_bar", "1"), check=nothing,
          says=("option -foo_bar: unknown prefix; expected -modes_...",)),
    *case("options of PETSc as a whole", options=("-options_left", "-options_view", "-log_view", ":/dev/null"),
          lines=0, shows=("#PETSc Option Table entries", "There are no unused options"), check=files("finished", 51)),
    *(c for value in ("-1", "0", "nan") for option in ("-motion_ts_dt", "-motion_ts_max_time")
      for c in case(f"{option} {value}", codes=2, lines=1, options=(option, value), ranks=(1,), check=nothing,
                    says=(f"option {option} {value}: is not a positive number",))),
    *case("modes by a solver that needs more", codes=2, lines=1, options=("-modes_eps_type", "lanczos"), check=nothing,
          says=("reorthogonalization type", "in EPSSetUp_Lanczos, called by EPSSolve"), never=("lanczos.c",)),
    *case("factors of a package that has none", codes=1, lines=1, check=nothing, never=("matrix.c",),
          options=("-derivatives_pc_factor_mat_solver_type", "superlu"), says=("MatSolverType superlu does not",)),
    *case("option unused", codes=2, lines=1, options=("-motion_ts_foo", "1"), says=("-motion_ts_foo 1: unknown",), check=nothing),
    *case("option of no solver", codes=2, lines=1, options=("-modes_eps_nve", "3"), says=("-modes_eps_nve 3",), check=nothing),
    *case("option of another command", codes=2, lines=1, options=("-campbell_pep_nev", "3"), check=nothing,
          says=("option -campbell_pep_nev 3: floe run has no solver with this prefix; expected it with campbell",)),
    *case("option of a solver that the scene does not need", codes=2, lines=1, options=("-static_snes_max_it", "5"),
          says=("-static_snes_max_it 5: not used in this run; its results are complete",), check=files("finished", 51)),
    *(c for option, nearest in (
        ("-motion_snes_monitorr", "-motion_snes_monitor"), ("-motion_ksp_converged_reasn", "-motion_ksp_converged_reason"),
        ("-modes_eps_vieww", "-modes_eps_view"), ("-derivatives_mat_mumps_icntl_144 9", "-derivatives_mat_mumps_icntl_14"),
        ("-mat_mumps_icntl_144 9", "-mat_mumps_icntl_14"), ("-static_ksp_tpye gmres", "-static_ksp_type"),
        ("-mesh_mat_partitioning_typ metis", "-mesh_mat_partitioning_type"), ("-bv_typ svec", "-bv_type"),
        ("-log_vieww", "-log_view"), ("-mat_vieww", "-mat_view"))
      for c in case(f"{option}, read by nothing", codes=2, lines=1, options=option.split(), says=(f"did you mean {nearest}?",),
                    check=nothing)),
    *case("option of a type that is not selected", codes=2, lines=1, options=("-derivatives_mg_levels_pc_type", "sor"),
          says=("-derivatives_mg_levels_pc_type sor: unknown, or of a type that is not selected",), check=nothing),
    *case("options within a preconditioner that is selected", lines=0, check=files("finished", 51),
          options=("-derivatives_ksp_type", "cg", "-derivatives_pc_type", "gamg", "-derivatives_mg_levels_pc_type", "sor",
                   "-derivatives_mg_levels_ksp_max_it", "3", "-motion_snes_view", ":/dev/null", "-modes_eps_view_pre", ":/dev/null",
                   "-bv_type", "svec", "-motion_ksp_converged_reason", ":/dev/null")),
    *case("partitioner unknown", codes=2, lines=1, options=("-mesh_mat_partitioning_type", "foo"), check=nothing,
          says=("option -mesh_mat_partitioning_type foo: is rejected: PETSc error 86",)),
    *case("viewer unknown", codes=2, lines=1, options=("-motion_ts_dt", "1e-3", "-motion_snes_monitor", "ascci:x"), check=nothing,
          says=("option -motion_snes_monitor ascci:x: is rejected: PETSc error 86",)),
    Case("option of a stage that the command lacks", ["modes", "scene.yaml", "-static_snes_max_it", "5"], 2, lines=1,
         says=("option -static_snes_max_it 5: floe modes has no solver with this prefix; expected it with run",)),
    *case("solvers of other sense", codes=2, lines=2, check=nothing,
          options=("-motion_ts_exact_final_time", "interpolate", "-motion_snes_type", "ksponly"),
          says=("option -motion_ts_exact_final_time interpolate: is rejected", "option -motion_snes_type ksponly: is rejected")),
    *case("fault of an option that the message lacks", codes=1, lines=1, options=("-derivatives_mat_mumps_icntl_7", "1"),
          says=("Valid values are", "(option given: -derivatives_mat_mumps_icntl_7 1)"), check=no_results),
    *(c for line, says in (("foo bar", '"foo" is not an option'), ("-motion_ts_dt 0.005 0.1", '"0.1" follows option and value'),
                           ("alias -a", "alias has no two options after it"), ("-1abc 3", '"-1abc" is not an option'))
      for c in (*case(f"line of an options file, {line}", codes=2, lines=1, options=("-options_file", "options"),
                      files={"options": f"# fine\n{line}\n"}, says=(f"options:2: {says}",), check=nothing, ranks=(1,)),
                *case(f"line of .petscrc, {line}", codes=2, lines=1, files={".petscrc": f"\n{line}\n"},
                      says=(f".petscrc:2: {says}",), check=nothing))),
    *case(".petscrc", files={".petscrc": "# a comment\n  -motion_ts_dt 0.005  # another\n"}, check=files("finished", 11)),
    *case("options in YAML", codes=2, lines=1, options=("-options_file_yaml", "options"), files={"options": "a: 1\n"},
          says=("option -options_file_yaml: is not read",), check=nothing),
    *case("options from a file", options=("-options_file", "options"), files={"options": "-motion_ts_dt 0.005\n"},
          check=files("finished", 11)),
    *case("options file unused", codes=2, lines=1, options=("-options_file", "options"),
          files={"options": "-motion_ts_foo 1\n"}, says=("-motion_ts_foo",), check=nothing),
    *case("options file missing", codes=2, lines=1, options=("-options_file", "options"), check=nothing,
          says=("options cannot be read",)),
    *case("end from an option", options=("-motion_ts_max_time", "0.01"), check=files("finished", 11, end=0.01)),
    Case("command after an option", ["-log_view", *run()], 0, check=files("finished", 51)),
    *case("modes that do not converge", codes=1, lines=1,
          options=("-modes_eps_max_it", "1", "-modes_eps_ncv", "4", "-modes_eps_tol", "1e-13"),
          says=("-modes_eps_...", "found 0 of 3 modes", "DIVERGED_ITS"), check=no_results,
          changes={"bodies.beam.mesh.line.elements": 40}),
    *case("derivatives that do not converge", codes=1, lines=1, check=no_results, says=("derivatives_ksp_",),
          options=("-derivatives_ksp_type", "cg", "-derivatives_ksp_max_it", "1", "-derivatives_pc_type", "none")),
    *case("solver of steps that does not converge", formulations=("nlffr",), codes=1, lines=1,
          options=("-motion_ksp_type", "gmres", "-motion_ksp_max_it", "1", "-motion_pc_type", "none"),
          says=("stopped at t = 0 of", "-motion_ksp_", "DIVERGED_"), check=files("failed", 1, "DIVERGED_")),
    *case("option value is none", codes=2, lines=1, options=("-motion_ts_dt", "abc"), says=("option -motion_ts_dt abc: is rejected",)),
    *case("type of TS unknown", codes=2, lines=1, options=("-motion_ts_type", "alpah2"),
          says=("Unknown TS type: alpah2",)),
    *case("type of TS for first-order systems", formulations=("vm+md", "nlffr"), codes=2, lines=1,
          options=("-motion_ts_type", "bdf"), says=("-motion_ts_type bdf: integrates first-order systems",),
          check=no_results),
    *case("type of TS of PETSc", options=("-motion_ts_type", "alpha2"), lines=0,
          shows=("Note: -motion_ts_type alpha2",),
          check=files("finished", 51)),
    *case("type of TS of PETSc and an event of a probe", formulations=("vm+md", "nlffr"), codes=2, lines=1,
          options=("-motion_ts_type", "alpha2"), check=no_results,
          says=("-motion_ts_type alpha2: does not interpolate within steps, where the time of event enough is found",),
          changes={"events": {"enough": {"stop": True, "probe": "tip.y", "crosses": 2e-4}}}),
    *case("an event stops the motion before it begins", codes=2, lines=1, check=no_results,
          says=("events.none.at: is 0; expected a time after the start",),
          changes={"events": {"none": {"stop": True, "at": 0}}}),
    *case("spectral radius 1", codes=2, lines=1, options=("-motion_ts_generalized_alpha_radius", "1"),
          says=("spectral radius",)),
]

def pendulum(weight):
    """Hinged, at an angle of -1, under a weight along y: it hangs at (0, -1)."""
    return scene({"bodies.beam.initial": {"angle": -1}, "bodies.beam.section": {"EA": 1e6, "EI": 100, "rhoA": 1},
                  "joints.clamp": {"type": "revolute", "between": ["ground", "beam.start"]},
                  "loads.tip": {"type": "distributed", "body": "beam", "force": [0, weight]}, "motion": None,
                  "probes.tip.quantity": "position"})


# A rigid body clamped to the ground, and to a body that is clamped to the ground at the same place.
TRIANGLE = {"bodies.post": {"mesh": {"line": {"from": [0, 0], "to": [0, 1], "elements": 8}},
                            "section": {"EA": 1e4, "EI": 1, "rhoA": 1}, "rigid": True},
            "joints.foot": {"type": "fixed", "between": ["ground", "post.start"]},
            "joints.corner": {"type": "fixed", "between": ["beam.start", "post.start"]},
            "joints.head": {"type": "revolute", "between": ["ground", "post.end"]}}

MANY = scene({"bodies.beam.mesh.line.elements": 4000})

UNUSUAL = [
    *case("free body", formulations=("vm+md", "nlffr", "cfr"), changes={"joints": None}, check=files("finished", 51)),
    *case("no load", changes={"loads": None}, check=files("finished", 51)),
    *case("no probes", changes={"probes": None}, check=files("finished", 51)),
    *case("rigid bodies alone", formulations=("vm+md", "nlffr", "cfr"), check=files("finished", 51),
          changes={"bodies.beam.rigid": True, "bodies.beam.reduction": None,
                   "joints.clamp": {"type": "revolute", "between": ["ground", "beam.start"]}}),
    *(Case(f"static, {f}", ["static", "scene.yaml", "--formulation", f, "--steps", "5", "-o", "out"], shows=("5 equilibria",),
           check=files("finished", 6)) for f in ("vm+md", "nlffr", "cfr")),
    *(Case(f"path of equilibria, {f}", ["static", "scene.yaml", "--formulation", f, "--path", "--steps", "5", "-o", "out"], 0,
           shows=("5 equilibria",), check=files("finished", 6)) for f in ("vm+md", "nlffr", "cfr")),
    Case("path of equilibria that ends early", ["static", "scene.yaml", "--path", "--points", "3", "-o", "out"], 0,
         shows=("No estimate of the error: a path", "the path of equilibria ends at t = ", "after 3 points (--points)"),
         check=files("finished", 4)),
    Case("path of an unconstrained body", ["static", "scene.yaml", "--path", "-o", "out"], 1,
         ("no equilibrium at t = ", "singular tangent stiffness (body beam)"), lines=1, scene=scene({"joints": None}),
         check=files("failed", 0, "no equilibrium")),
    Case("path from where a load begins", ["static", "scene.yaml", "--path", "-o", "out"], 0,
         scene=scene({"loads.tip.force": [0, "1e-3*sqrt(t)"]}), check=files("finished", None)),
    Case("points without a path", ["static", "scene.yaml", "--points", "3", "-o", "out"], 2, ("--points requires --path",),
         lines=1),
    Case("path of no points", ["static", "scene.yaml", "--path", "--points", "0", "-o", "out"], 2, ("--points",), lines=1),
    *(Case(f"estimate of a motion that an event ends, {name}", run(), lines=0, shows=("event enough at t = 0.0", "estimated error "),
           never=("No estimate",), check=lambda folder: estimated((10, 40), "tip")(folder),
           scene=scene({"events": {"enough": {"stop": True, **when}}}))
      for name, when in (("at a time", {"at": 0.02}), ("by a formula", {"when": "t - 0.0222"}),
                         ("by a probe", {"probe": "tip.y", "crosses": 2e-4}))),
    Case("estimate of a motion whose joints change", run(), lines=0, shows=("reduction: formulation nlffr, same mesh", "model: formulation cfr"),
         never=("No estimate",), check=estimated((45, 55), "tip", by="formulation nlffr, same mesh"),
         scene=scene({"events": {"off": {"unlock": "clamp", "at": 0.02}}})),
    Case("accuracy of a motion that an event ends", run("vm+md", "--accuracy", "1%"), 2, ("no selection is possible: events",),
         lines=1, scene=scene({"events": {"enough": {"stop": True, "at": 0.02}}})),
    *(Case(f"estimate of equilibria, {f}", ["static", "scene.yaml", "--formulation", f, "--steps", "5", "-o", "out"], lines=0,
           shows=("estimated error  reduction", "estimated error ", "relative to the full-order model of the same mesh"),
           check=lambda folder: (files("finished", 6)(folder), estimated((1, 5), "tip")(folder))) for f in ("vm", "vm+md")),
    Case("no estimate of equilibria", ["static", "scene.yaml", "--no-estimate", "-o", "out"], lines=0,
         never=("estimated error", "No estimate"), check=files("finished", 11)),
    *(Case(f"static of what nothing holds, {f}", ["static", "scene.yaml", "--formulation", f, "-o", "out"], 1,
           ("no equilibrium at t = ", "singular tangent stiffness (body beam)"), lines=1,
           scene=scene({"joints": None}), check=files("failed", 0, "no equilibrium")) for f in ("vm+md", "nlffr", "cfr")),
    *(Case(f"static of a pendulum whose weight grows, {f}", ["static", "scene.yaml", "--formulation", f, "--steps", "4",
                                                             "-o", "out"], 0, lines=0,
           shows=("the table begins at t = 0.25", " -1\n"), never=("unstable",),
           scene=pendulum("-9.81*t"), check=files("finished", 4)) for f in ("vm+md", "nlffr", "cfr")),
    *(Case(f"static of a pendulum, {f}", ["static", "scene.yaml", "--formulation", f, "--steps", "2", "-o", "out"], 0,
           lines=0, shows=(" -1\n",), never=("unstable", "no equilibrium"), scene=pendulum("-9.81"),
           check=files("finished", 3)) for f in ("vm+md", "nlffr", "cfr")),
    Case("static of what nothing holds, beyond 1000 unknowns", ["static", "scene.yaml", "--formulation", "nlffr", "-o", "out"],
         1, ("no equilibrium at t = ", "(body p): an unconstrained rigid-body motion, along which the loads are not zero"), lines=1, ranks=(1,),
         scene="bodies: {p: {mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [16, 10]}}, section: {thickness: "
               "5e-3}, material: {E: 2.1e11, nu: 0.3, rho: 7850}}}\nloads: {f: {type: force, at: p.p3, force: [0, 0, 1]}}\n",
         check=files("failed", 0, "no equilibrium")),
    Case("static with joints that repeat", ["static", "scene.yaml", "--formulation", "cfr", "-o", "out"], 1,
         ("redundant constraints (joint ",), never=("singular tangent stiffness",), lines=1, scene=scene(TRIANGLE)),
    *(Case(f"static of a column beyond its critical load, {f}", ["static", "scene.yaml", "--formulation", f, "--steps", "1",
                                                                 "--at", "1", "-o", "out"], 0, lines=0,
           shows=("is unstable in 1 direction",), check=files("finished", 2),
           scene=scene({"bodies.beam.mesh.line.elements": 150, "loads.tip.force": ["-3*t", 0]}))
      for f in ("vm+md", "cfr")),
    Case("static of a column whose load follows it", ["static", "scene.yaml", "--steps", "1", "--at", "1", "-o", "out"], 0,
         lines=0, never=("unstable",), check=lambda folder: (files("finished", 2)(folder), not_looked(folder)),
         scene=scene({"loads.tip": {"type": "force", "at": "beam.end", "axes": "body", "force": ["-15*t", 0]}})),
    *(Case(f"campbell, {name}", ["campbell", "scene.yaml", "--speeds", *words, "-o", "out"], 2, (says,), lines=1)
      for name, words, says in (("no speeds", ["0:1"], "expected FROM:TO:STEP"),
                                ("no axis", ["0,1"], "is not that of one driven or revolute joint to the ground"),
                                ("a clamp", ["0,1", "--through", "0,0"], "joint clamp does not rotate with the scene"),
                                ("no point", ["0,1", "--through", "here"], "--through: \"here\" is not a point"),
                                ("cfr", ["0,1", "--formulation", "cfr"], "expected nlffr, lffr, vm or vm+md"))),
    Case("campbell of corotational shells on several ranks", ["campbell", "scene.yaml", "--formulation", "cfr", "--speeds", "40",
                                                              "--modes", "2", "-o", "out"], 0, shows=("45.9766", "123.576"),
         scene=ROTATING_STRIP),
    Case("campbell of a scene that spins up", ["campbell", "scene.yaml", "--speeds", "1,2", "-o", "out"], 1,
         ("no steady rotation at 1 rad/s: a residual moment about the axis",), lines=1,
         scene=scene({"joints.clamp.type": "revolute",
                      "loads": {"motor": {"type": "moment", "at": "beam.end", "moment": 1e-3}}})),
    Case("mesh finer than numbers", ["modes", "scene.yaml"], 1,
         ("the mesh of 400000 elements is finer than double precision resolves", "take fewer elements"), lines=1,
         scene=scene({"bodies.beam.mesh.line.elements": 400000, "bodies.beam.reduction.modes": 1}), ranks=(1,)),
    Case("memory of the factor", ["modes", "scene.yaml", "-derivatives_mat_mumps_icntl_23", "1"], 1,
         ("INFOG(1) = -19: the memory allowed", "-derivatives_mat_mumps_icntl_22 1"), lines=1, scene=PLATE),
    *(Case(f"memory of the {what}", words, 1, ("INFOG(1) = -19: the memory allowed", f"-{prefix}mat_mumps_icntl_22 1"),
           never=("redundant constraints", "PETSc error"), lines=1, scene=big)
      for what, prefix, words, big in (
          ("modes", "modes_st_", ["modes", "scene.yaml", "-modes_st_mat_mumps_icntl_23", "1"], PLATE),
          ("start", "motion_start_", run("nlffr", "-motion_start_mat_mumps_icntl_23", "1"), MANY),
          ("equilibrium", "static_", ["static", "scene.yaml", "--formulation", "nlffr", "-static_mat_mumps_icntl_23", "1",
                                      "-o", "out"], MANY))),
    *(Case(f"work space of the {what}", words, 0, never=("INFOG",), lines=0, scene=big)
      for what, words, big in (
          ("statics", ["modes", "scene.yaml", "-derivatives_mat_mumps_icntl_14", "-50"], PLATE),
          ("modes", ["modes", "scene.yaml", "-modes_st_mat_mumps_icntl_14", "-50"], PLATE),
          ("start", run("nlffr", "-motion_start_mat_mumps_icntl_14", "-50"), MANY),
          ("motion", run("nlffr", "-motion_mat_mumps_icntl_14", "-50", "-motion_pc_factor_mat_solver_type", "mumps"), MANY),
          ("equilibrium", ["static", "scene.yaml", "--formulation", "nlffr", "--steps", "1", "--at", "0.01",
                           "-static_mat_mumps_icntl_14", "-50", "-o", "out"], MANY))),
    Case("modes by another transformation", ["modes", "scene.yaml", "-modes_st_type", "shift"], (1, 2),
         ("-modes_st_type shift", "expected sinvert"), never=("PETSc error",), lines=1, scene=PLATE),
    Case("LU of one half of a matrix", ["modes", "scene.yaml", "-derivatives_pc_type", "lu"], 2,
         ("option -derivatives_pc_type lu: the matrix is symmetric", "expected cholesky"), lines=1, scene=PLATE),
    Case("a preconditioner alone", ["modes", "scene.yaml", "-derivatives_pc_type", "jacobi"], 2,
         ("option -derivatives_pc_type jacobi: is only a preconditioner",), never=("finer",), lines=1, scene=PLATE),
    *(Case(f"modes by {name}", ["modes", "scene.yaml", "-options_file", str(BLADE / name)], 0, shows=("rad/s",), lines=0,
           scene=text)
      for name, text in (("iterative.opts", PLATE_MOTION), ("out_of_core.opts", PLATE_MOTION),
                         ("iterative_free.opts", PLATE_MOTION[:PLATE_MOTION.index("joints:")]))),
    Case("full derivatives by multigrid", run("vm+md", "-options_file", str(BLADE / "iterative.opts")), 2,
         ("derivatives with inertia", "expected a factorisation"), lines=1,
         scene=PLATE_MOTION.replace("modes: ", "derivative_type: full, modes: ")),
    Case("factor on disk", ["modes", "scene.yaml", "-derivatives_mat_mumps_icntl_22", "1"], 0, shows=("rad/s",), lines=0,
         scene=PLATE),
    Case("one formulation of several stops", ["compare", "scene.yaml", "--formulations", "nlffr,vm", "-o", "out",
                                              "--no-reference-error"], 1,
         ("nlffr: ", "vm: ", "no formulation reached the end"), scene=scene({"loads.tip.force": [0, GAP]}),
         check=files("failed", 21, out="out/vm")),
    Case("one formulation of several fails",
         ["compare", "scene.yaml", "--formulations", "nlffr,vm+md,lffr", "-o", "out",
          "-derivatives_pc_factor_mat_solver_type", "superlu"], 1,
         ("vm+md: PETSc error", "1 of 3 formulations failed: vm+md"), lines=2,
         shows=("vm+md        failed", "Failed (vm+md): "),
         check=lambda folder: (files("finished", 51, out="out/lffr")(folder), stands("out/compare.csv")(folder),
                               absent("out/vm+md")(folder))),
    Case("error against round-off", ["compare", "scene.yaml", "--formulations", "nlffr,vm", "-o", "out",
                                     "--no-reference-error"], 0, lines=0, scene=scene({"loads.tip.force": [1, 0]}),
         check=no_error_of("tip.y", "tip.x")),
    Case("compare", ["compare", "scene.yaml", "--formulations", "nlffr,vm", "-o", "out"], 0, lines=0,
         check=lambda folder: (files("finished", 51, out="out/vm")(folder), stands("out/compare.csv")(folder))),
]

REDUCED = [
    Case("equilibria of a reduced body", ["static", "scene.yaml", "-o", "out"], scene=reduced.from_file(),
         prepare=reduced.made(), shows=("No estimate of the error: no flexible body has a mesh",), check=files("finished", 11)),
    Case("reduced body", run(), scene=reduced.from_file(), prepare=reduced.made(), check=files("finished", 51)),
    Case("reduced body, compared", ["compare", "scene.yaml", "-o", "out"], scene=reduced.from_file(),
         prepare=reduced.made(), check=stands("out/compare.csv"), shows=("lffr", "vm+md"), lines=0),
    *(Case(f"reduced body, {word}", [word, "scene.yaml"], scene=reduced.from_file(), prepare=reduced.made(),
           shows=(shown,), lines=0) for word, shown in (("check", "from beam.h5"), ("modes", "rad/s"))),
    *(Case(f"reduced body, {formulation}", run(formulation), 2, scene=reduced.from_file(), prepare=reduced.made(),
           says=("bodies.beam.reduced: has no mesh",), lines=1, check=no_results)
      for formulation in ("nlffr", "cfr")),
    *(Case(f"reduced body: {name}", run(), 2, scene=reduced.from_file(), prepare=prepare, lines=1, check=no_results,
           says=("scene.yaml:", "bodies.beam.reduced: ", says))
      for name, prepare, says in (
          ("missing", None, "there is no file"), ("cut off", reduced.cut, "expected a complete HDF5 file"),
          ("of another version", reduced.attribute("version", 6), "found version 6"),
          ("of a killed writer", reduced.attribute("complete", 0), "whose writing was broken off"),
          ("damaged", reduced.made(reduced.damage), "the file is damaged"),
          ("a folder", lambda folder: (folder / "beam.h5").mkdir(), "is not a file"))),
    Case("reduced body, unknown place", run(), 2, ('has no place "ende"', 'did you mean "end"?'), lines=1,
         scene=reduced.from_file({"probes.tip.at": "beam.ende"}), prepare=reduced.made(), check=no_results),
]

SPACE = [
    *(Case(f"space: static drive by {angle}", ["static", "scene.yaml", "--steps", "1", "--at", "1", "-o", "out"], 0, lines=0,
           scene=space.body(space.RIGID % "", space.hinge(f"{angle}*t"), motion=""), check=space.turned(angle))
      for angle in (2, 3.141592653589793, 20)),
    Case("space: half a turn in a step", run(), 1, ("joint d is satisfied on the flipped branch", "expected a smaller motion.step"),
         lines=1, scene=space.body(space.RIGID % "", space.hinge("1.55*(1 + tanh(20*(t - 0.75)))"),
                                                         motion="{end: 2, step: 0.5}")),
    Case("space: a late drive that is left out", run(), 2, ("joint d is redundant with other joints and inconsistent with them", "at t = "), lines=1,
         scene=space.body(space.BEAM % ", frame: {type: clamped, at: start}, reduction: {attachment: none}", space.CLAMP,
                          space.MOVED.replace('"0.01*t"', space.LATE), motion="{end: 1, step: 1e-2}"), check=nothing),
    Case("space: a late drive", run(), 0, lines=0, check=space.near("end.z", 0.01 * 0.9**3, 1e-9),
         scene=space.body(space.BEAM % "", space.CLAMP, space.MOVED.replace('"0.01*t"', space.LATE),
                          motion="{end: 1, step: 1e-2}")),
    Case("space: a late weld", run(), 2, ("is redundant with other joints and inconsistent with them", "at t = 0.1"), lines=1,
         scene=space.TWO_ARMS, check=nothing),
    *(Case(f"space: bearings, {name}", ["campbell", "scene.yaml", "--speeds", "10", "--about", "0,0,1", "--through", "0,0,0",
                                        "-o", "out"], code, says, lines=len(says[:1]), scene=space.bearings(*stiffness))
      for name, code, says, stiffness in (
          ("stiffer one way", 2, ("the stiffness acting on body a (to the ground: bushing l, bushing r)",), (1000, 3000)),
          ("as stiff all around", 0, (), (1000, 1000)))),
    Case("space: the mean of an edge of corotational elements", run("cfr"), 0, lines=0,
         check=space.near("edge.z", 0, 1e-12),
         scene=space.body(space.PLATE, "c: {type: fixed, between: [ground, a.left]}",
                          probes="{edge: {at: a.right, quantity: displacement}}")),
    *(Case(f"space: the mean of an edge of corotational elements, {what}", run("cfr"), 0, lines=0, check=files("finished", 21),
           scene=space.body(space.PLATE, "c: {type: fixed, between: [ground, a.left]}", probes=probes))
      for what, probes in (("rotated", "{edge: {at: a.right, quantity: rotation}}"),
                           ("in a formula", '{edge: {at: a.right, quantity: velocity}, f: {formula: "2*edge.z"}}'))),
    Case("space: a load in axes of its place", run(), 0, lines=0, check=space.near("end.y", 0, 1e-12),
         scene=space.body(space.TILTED % ", frame: pinned, reduction: {modes: 3, derivatives: none, attachment: none}",
                          more="loads: {f: {type: force, at: a.middle, force: [0.1, 0, 0], axes: place}}\n",
                          probes="{end: {at: a.middle}}")),
    Case("space: a clamp far away", run(), 2, ("the two places of joint c are", "expected the same point"), lines=1,
         scene=space.body(space.PLATE, "c: {type: fixed, between: [{body: ground, node: [0, 0, 50]}, a.left]}", probes=""),
         check=nothing),
    Case("space: joints of the same places", run(), 2,
         ("connects a place with itself", "connects the same two places as joint c (line 2)"), lines=2,
         scene=space.body(space.PLATE, "c: {type: fixed, between: [ground, a.left]}",
                          "d: {type: revolute, between: [ground, a.left]}", "e: {type: fixed, between: [a.right, a.right]}",
                          probes=""), check=nothing),
    Case("space: a fast drive", run(), 0, lines=0, check=space.near("end.y", -0.01 * 0.5365729180004349, 1e-5),
         scene=space.body(space.RIGID % ", initial: {angular_velocity: [0, 0, 1e4]}", space.hinge("0.01*sin(1e6*t)"),
                          motion="{end: 1.2e-5, step: 6e-8}")),
    Case("space: a drive by a power", run(), 0, lines=0, check=space.turned(1),
         scene=space.body(space.RIGID % "", space.hinge("t^2.5"), motion="{end: 1, step: 1e-2}")),
    Case("space: a spring of length zero", ["static", "scene.yaml", "--steps", "1", "--at", "1", "-o", "out"], 0, lines=0,
         scene=space.body(space.RIGID % "", "s: {type: spring, between: [ground, a.start], stiffness: 100, length: 0}",
                          "t: {type: spring, between: [ground, a.end], stiffness: 100, length: 0}",
                          "u: {type: bushing, between: [ground, a.start], rotation: [1, 0, 0]}",
                          more='loads: {f: {type: force, at: a.middle, force: [0, 0, "2*t"]}}\n', motion=""),
         check=space.near("end.z", 0.01, 1e-9)),
    Case("space: a spring with a length where its places coincide", run(), 2,
         ("the places of spring s coincide at the start", "expected length: 0"), lines=1,
         scene=space.body(space.RIGID % "", "s: {type: spring, between: [ground, a.start], stiffness: 100, length: 0.1}")),
    Case("space: a bushing turned round", run(), 1, ("bushing s is rotated by ", "limit 1.6 pi"), lines=1,
         scene=space.body(space.RIGID % ", initial: {angular_velocity: [0, 0, 10]}",
                          "h: {type: revolute, between: [ground, a.start], axis: [0, 0, 1]}",
                          "s: {type: bushing, between: [ground, a.start], rotation: [0, 0, 1]}", motion="{end: 6, step: 5e-3}")),
    *(Case(f"space: a torque, attachment {attachment}", ["static", "scene.yaml", "--steps", "1", "--at", "1", "-o", "out"], 0,
           lines=0, check=check,
           scene=space.body(space.BEAM % f", reduction: {{attachment: {attachment}, derivatives: none}}", space.CLAMP, motion="",
                            more='loads: {m: {type: moment, at: a.end, moment: ["5*t", 0, 0]}}\n'))
      for attachment, check in (("joints", space.warns("of the work of load m")), ("all", space.silent))),
    *(Case(f"space: two supports, {f}", ["static", "scene.yaml", "--formulation", f, "--steps", "1", "--at", "1", "-o", "out"],
           0, lines=0, scene=space.SAGGING, check=space.near("end.z", -1.478073e-4, 3e-7)) for f in ("vm+md", "nlffr")),
    Case("space: a straight edge with two nodes at one point", run(), 2, lines=1,
         says=("joints.c.straight: two nodes of its place coincide at (1, 1, 0)",), scene=space.SEAM, files={"seam.inp": space.SEAM_DECK}),
    Case("space: a hinge line across its axis", run(), 2, lines=1,
         says=("joints.h.edges: is line, but a.left is a straight edge, and the joint's axis is not along it",),
         scene=space.body(space.PLATE, "h: {type: revolute, between: [ground, a.left], axis: [1, 0, 0], edges: line}", probes="")),
    Case("space: hinge lines on the ground that meet the line of a body", run(), 2, lines=1,
         says=("joints.i.edges: is line, but its edge meets edges of other bodies or rigid regions; expected mean",),
         scene=space.MEETING_LINES),
    Case("space: a hinge line at a clamp", run(), 2, lines=1, says=("joints.h.edges: is line at a joint of type fixed",),
         scene=space.body(space.PLATE, "h: {type: fixed, between: [ground, a.left], edges: line}", probes="")),
    Case("space: three hinge lines in a row", run(), 2, lines=1,
         says=("joints.i: its edge has nodes in common with two others of joints or links",),
         scene=space.THREE_LINES),
    Case("space: more frames than planes of nodes", run(), 2, lines=1,
         says=("bodies.a.frames: is 50, but the mesh of body a has only", "planes of nodes across its longest extent"),
         scene=space.body(space.PLATE.replace("{mesh", "{frames: 50, mesh"), probes="")),
    Case("space: a joint along an edge that frames cut", run(), 2, lines=1,
         says=("joints.h", "lies in several of the 2 floating frames of body a; expected a place that one frame contains"),
         scene=space.body(space.PLATE.replace("{mesh", "{frames: 2, mesh"),
                          "h: {type: fixed, between: [ground, a.bottom]}, i: {type: fixed, between: [ground, a.left]}",
                          probes="")),
    Case("space: a pinned frame for the frames of a plate", run(), 2, lines=1,
         says=("bodies.a.frame", "is given for 2 frames of a mesh that is not a single line; expected mean-axis"),
         scene=space.body(space.PLATE.replace("{mesh", "{frames: 2, frame: {type: pinned, from: p1, to: p2}, mesh"), probes="")),
    Case("space: a frame clamped at a free end", run("nlffr"), lines=0,
         shows=("Note: total energy: grows by", "take frame: mean-axis where no joint constrains the clamped place of a"),
         scene=space.FLYING),
    Case("space: a deformation of two components", run(), 2, lines=1,
         says=("initial.deformation: has length 2; expected three formulas of x, y and z [u, v, w]",),
         scene=space.body(space.BEAM % ', initial: {deformation: [0, "x^2"]}')),
    Case("space: a deformation where the ground clamps", run(), 2, lines=1,
         says=("initial.deformation: displaces or rotates body a where the ground clamps it",),
         scene=space.body(space.BEAM % ', frame: {type: clamped, at: start}, initial: {deformation: [0, "0.01 + x^2/100", 0]}',
                          space.CLAMP)),
    Case("space: motion on two supports", run(), 0, lines=0, scene=space.SAGGING + "motion: {end: 4e-3, step: 2e-4}\n",
         check=files("finished", 21)),
    Case("space: a support that moves", ["static", "scene.yaml", "--steps", "1", "--at", "1", "-o", "out"], 0, lines=0,
         check=space.near("end.z", 0.01, 1e-12), scene=space.body(space.BEAM % "", space.CLAMP, space.MOVED, motion="")),
    Case("space: a bushing between distant places", run(), 0, lines=0, check=space.near("end.z", 0, 1e-12),
         scene=space.body(space.RIGID % "", "s: {type: bushing, between: [{body: ground, node: [0, 0, 1]}, a.middle], "
                                            "translation: [10, 10, 10]}")),
    Case("space: a joint at an arm of a hundred million lengths", run(), 0, lines=0, check=space.near("end.x", 1, 1e-6),
         scene=space.body(space.RIGID % "", "h: {type: revolute, between: [ground, {body: a, node: [1.0e+8, 0, 0]}], "
                                            "axis: [0, 0, 1]}")),
    Case("space: compare", ["compare", "scene.yaml", "-o", "out", "--no-reference-error"], 0, lines=0, shows=("nlffr", "vm+md"),
         never=("cfr",), scene=space.body(space.BEAM % "", "c: {type: revolute, between: [ground, a.start], axis: [0, 1, 0]}",
                                          motion="{end: 2e-3, step: 1e-3}")),
    Case("space: without mass", run(), 2, ("no part of body a has mass",), lines=1, check=nothing,
         scene=space.body((space.BEAM % "").replace("rho: 2700", "rho: 0"), space.CLAMP)),
    Case("space: a body of a micrometre", run(), 0, lines=0, check=space.near("end.x", 1e-6, 1e-15),
         scene=space.body((space.RIGID % "").replace("[1, 0, 0]", "[1e-6, 0, 0]").replace("0.05", "5e-8"))),
    Case("space: a deflection relative to a place", run(), 2, ("probes.end.relative_to", "does not apply to a deflection"),
         lines=1, check=nothing,
         scene=space.body(space.BEAM % "", space.CLAMP,
                          probes="{end: {at: a.end, quantity: deflection, relative_to: a.start}}")),
]

# A body in space that nothing holds; a beam that bends more than four frames can follow.
FREE = "bodies: {a: %s}\n" % (space.BEAM % "")
WORDS = [
    Case("modes of a free body", ["modes", "scene.yaml"], 0, lines=0, scene=FREE,
         check=lambda folder: rows_of(folder, "rigid", 6)),
    Case("modes of a hinged body", ["modes", "scene.yaml"], 0, lines=0,
         scene=FREE + "joints: {h: {type: revolute, between: [ground, a.start], axis: [0, 0, 1]}}\n",
         check=lambda folder: rows_of(folder, "rigid", 1)),
    Case("modes of a clamped body", ["modes", "scene.yaml"], 0, lines=0, never=("rigid",)),
    Case("check of modal damping", ["check", "scene.yaml"], 0, lines=0, shows=("multipliers of the full-order model",),
         scene=scene(MODAL)),
    Case("check in a formulation", ["check", "scene.yaml", "--formulation", "vm"], 0, lines=0, shows=("multipliers as vm\n",)),
    Case("check in a formulation that the scene does not have", ["check", "scene.yaml", "--formulation", "cfr"], 2, lines=1,
         says=("is steady_rotation",), scene=scene(ROTATION)),
    Case("compare with modal damping", ["compare", "scene.yaml", "-o", "out"], 0, lines=0,
         shows=("cfr", "nlffr"), scene=scene(MODAL)),
    Case("more frames than there are", ["static", "scene.yaml", "--steps", "20", "--at", "1", "-o", "out"], 0, lines=0,
         shows=("take more than 4 (frames: 8)",), never=("frames: 2",),
         scene=scene({"bodies.beam.frames": 4, "bodies.beam.frame": {"type": "clamped", "at": "start"},
                      "loads.tip": {"type": "moment", "at": "beam.end", "moment": "3.5*t"}})),
    Case("elements of a plate", ["check", "scene.yaml"], 2, lines=1, scene=PLATE.replace("[60, 30]", "1"),
         says=('plate.elements: is "1"; expected two integers [i, j]',)),
    *(Case(f"body's file that is {what}", ["check", "scene.yaml"], 2, lines=1, files={"junk.h5": "junk"}, says=(says,),
           scene=f"bodies: {{f: {{reduced: {name}, initial: {{position: [0, 0, 1]}}}}}}\ngravity: [0, 0, -9.81]\njoints: {{r: {{type: "
                 "fixed, between: [ground, f.root]}}\nloads: {t: {type: force, at: f.tip, force: [0, 0, 1]}}\n")
      for what, name, says in (("not there", "none.h5", 'there is no file "none.h5"'), ("none", "junk.h5", "expected a complete HDF5 file"))),
]

CASES = list(decks.cases(Case)) + WORDS + SPACE + runtime.cases(Case, run, case, nothing, kept) + REDUCED + IN_SPACE + COMMANDS + SCENES + FOLDERS + FAULTS + OPTIONS + UNUSUAL
