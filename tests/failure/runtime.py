"""Bad checkpoints, events and sweeps. (Runs that are killed and taken up again: restart.py.)"""
import csv

from scenes import scene

# The basis of the copy has the vector of the copy's own spring.
COPIED_COLUMNS = """
bodies:
  arm:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1e4, EI: 10, rhoA: 1, rhoI: 0}
    frame: clamped
    reduction: {modes: 2, columns: [mode 1, attachment tip.fy, "derivative 1,tip.fy"]}
joints:
  root: {type: fixed, between: [ground, arm.start]}
  tip: {type: spring, between: [{body: ground, node: [1, 1]}, arm.end], stiffness: 100}
loads: {push: {type: force, at: arm.end, force: [0, "10*t"]}}
motion: {end: 0.1, step: 0.01}
probes: {e: {at: arm.end}}
copies: {two: {like: [arm], angle: pi/2}}
"""


def same_but_rotated(folder):
    """(x, y) -> (-y, x)"""
    with open(folder / "out/probes.csv", newline="") as file:
        rows = list(csv.reader(file))
    last = dict(zip((name.split(" [")[0] for name in rows[0]), map(float, rows[-1])))
    assert last["e.y"] > 1e-3 and abs(last["two_e.x"] + last["e.y"]) < 1e-10 and abs(last["two_e.y"] - last["e.x"]) < 1e-10, last


def cases(Case, run, case, nothing, kept):
    sweep = ["sweep", "scene.yaml", "-o", "out"]
    kept_none = {"bodies.beam.reduction": {"modes": 3, "columns": ["mode 1", "mod 2"]}}
    return [
        *(Case(f"accuracy of {word}", ["run", "scene.yaml", "-o", "out", "--accuracy", word], 2,
               (f'--accuracy: is "{word}"; expected a fraction, as 0.01',), lines=1, check=nothing)
          for word in ("0", "1", "-1%", "nan", "abc", "200 %", "1%%", "1 % %", "reduction:", "reduction:0", "mesh:1%")),
        *case("accuracy of nothing", codes=2, lines=1, check=nothing, changes={"accuracy": "0 %"},
              says=('accuracy: is "0 %"', "0 < value < 1")),
        *case("accuracy of an unknown part", codes=2, lines=2, check=nothing, changes={"accuracy": {"reductoin": "1 %"}},
              says=("reductoin: unknown key", "accuracy.reduction: is missing")),
        *case("accuracy of no reduction", codes=2, lines=1, check=nothing, changes={"accuracy": {"reduction": 0}},
              says=("accuracy.reduction: is 0", "0 < value < 1")),
        *case("accuracy and tolerance", codes=2, lines=1, check=nothing,
              changes={"accuracy": 0.01, "motion.tolerance": 1e-4}, says=("cannot be combined with motion.tolerance",)),
        *case("accuracy without probes", codes=2, lines=1, check=nothing, changes={"accuracy": 0.01, "probes": None},
              says=("accuracy: applies to the probes, and there are none",)),
        Case("accuracy with checkpoints", ["run", "scene.yaml", "-o", "out", "--accuracy", "1%", "--checkpoint", "10"],
             2, ("--checkpoint: cannot be combined with an accuracy",), lines=1, check=nothing),
        Case("scene of no choice", ["run", "scene.yaml", "-o", "out", "--write-scene", "chosen.yaml"], 2,
             ("--write-scene: needs an accuracy",), lines=1, check=nothing),
        Case("scene that exists",
             ["run", "scene.yaml", "-o", "out", "--accuracy", "1%", "--write-scene", "there.yaml"], 2,
             ("there.yaml: exists",), lines=1, check=nothing, files={"there.yaml": "{}"}),
        Case("scene in place of the scene",
             ["run", "scene.yaml", "-o", "out", "--accuracy", "1%", "--force", "--write-scene", "./scene.yaml"], 2,
             ("scene.yaml: is the scene itself",), lines=1, check=nothing),
        Case("scene into no folder",
             ["run", "scene.yaml", "-o", "out", "--accuracy", "1%", "--write-scene", "nowhere/chosen.yaml"], 2,
             ("nowhere/chosen.yaml: cannot be written there",), lines=1, check=nothing),
        Case("accuracy without the estimate",
             ["run", "scene.yaml", "-o", "out", "--accuracy", "1%", "--no-estimate"], 2,
             ("--no-estimate: cannot be combined with an accuracy",), lines=1, check=nothing),
        *case("angle that jumps", codes=2, lines=1, check=nothing,
              changes={"joints.clamp": {"type": "driven", "between": ["ground", "beam.start"],
                                        "angle": "t < 0.0205 ? 0 : 0.3"}},
              says=('joints.clamp.angle: "t < 0.0205 ? 0 : 0.3" jumps from 0 to 0.3 rad at t = 0.0205; expected a continuous '
                    'angle',)),
        *case("angle of infinite speed", codes=2, lines=1, check=nothing,
              changes={"joints.clamp": {"type": "driven", "between": ["ground", "beam.start"], "angle": "sqrt(t)"}},
              says=('the rate of "sqrt(t)" is infinite at t = 0',)),
        *case("speed that jumps", lines=0, shows=("event clamp at t = 0.0205 s: speed of the drive jumps from 0 to 3 rad/s",
                                                  "J gained"),
              formulations=("vm+md", "nlffr", "cfr"),
              changes={"joints.clamp": {"type": "driven", "between": ["ground", "beam.start"],
                                        "angle": "max(0, 3*(t - 0.0205))"}}),
        *case("middle of one element", codes=2, lines=1, check=nothing,
              changes={"bodies.beam.mesh.line.elements": 1, "bodies.beam.reduction.modes": 1, "probes.tip.at": "beam.middle"},
              says=("beam has no node between its start and half of its length",)),
        *case("middle beside a node", lines=0,
              shows=("Note: place beam.middle: no node at half of the length; the nearest node before it is used, at a distance of 0.1 m, 10 %",),
              changes={"bodies.beam.mesh.line.elements": 5, "probes.tip.at": "beam.middle"}),
        *case("deflection of a rigid body", lines=0, formulations=("vm+md", "nlffr"),
              shows=("Note: probe b: its deflection is 0 throughout, because body link is rigid",),
              changes={"bodies.link": {"mesh": {"line": {"from": [1, 0], "to": [2, 0], "elements": 1}}, "section": {"rhoA": 1},
                                       "rigid": True},
                       "joints.a": {"type": "fixed", "between": ["beam.end", "link.start"]},
                       "probes.b": {"at": "link.middle", "quantity": "deflection"}}),
        *case("output finer than steps", codes=2, lines=1, check=nothing, changes={"motion.output": 1e-9},
              says=("motion.output: is 1e-09", "at least 1/100 of step")),
        *case("column that is not there", codes=2, lines=1, check=nothing, changes=kept_none,
              says=('has no basis vector "mod 2"', 'did you mean "mode 2"?')),
        *case("column that is not there, copied", codes=2, lines=1, check=nothing,
              changes={**kept_none, "copies": {"two": {"like": ["beam"], "angle": 1}}},
              says=('bodies.beam.reduction.columns: body beam has no basis vector "mod 2"',)),
        *case("columns of joints, copied", lines=0, scene=COPIED_COLUMNS, options=("--no-estimate",), check=same_but_rotated),
        *case("column twice", codes=2, lines=1, check=nothing,
              changes={"bodies.beam.reduction": {"columns": ["mode 1", "mode 1"]}}, says=('"mode 1" is given twice',)),
        *case("columns and derivatives", codes=2, lines=1, check=nothing,
              changes={"bodies.beam.reduction": {"columns": ["mode 1"], "derivatives": "all"}},
              says=("cannot be combined with columns",)),
        *case("elastic force of a wrong name", codes=2, lines=1, check=nothing,
              changes={"bodies.beam.reduction": {"elastic_force": "liner"}}, says=('did you mean "linear"?',)),
        *(Case(f"checkpoint each {word}", run("vm+md", "--checkpoint", word), 2,
               (f"--checkpoint: is {word}; expected a number of steps",), lines=1, check=nothing)
          for word in ("0", "1.5", "10m", "nan", "abc")),
        Case("restart of nothing", ["run", "--restart", "nowhere"], 2, ("nowhere': does not exist",), lines=1),
        Case("restart without a checkpoint", ["run", "--restart", "out"], 2,
             ("checkpoint.h5: does not exist: the run was made without --checkpoint",), lines=1,
             files={"out/summary.json": "{}"}, check=kept("out/summary.json", "{}")),
        Case("restart from another file", ["run", "--restart", "out"], 2,
             ("checkpoint.h5: is not a checkpoint of floe",), lines=1, files={"out/checkpoint.h5": "mine"},
             check=kept("out/checkpoint.h5", "mine")),
        Case("restart into another folder", ["run", "--restart", "out", "-o", "other"], 2, ("--restart",), lines=1),
        Case("until without restart", run("vm+md", "--until", "1"), 2, ("--until",), lines=1, check=nothing),
        *case("event of no joint", codes=2, lines=1, check=nothing,
              changes={"events": {"off": {"unlock": "clmp", "at": 0.01}}},
              says=('events.off.unlock: is "clmp"', 'did you mean "clamp"?')),
        *case("event that locks a clamp", codes=2, lines=1, check=nothing,
              changes={"events": {"off": {"lock": "clamp", "at": 0.01}}},
              says=("which leaves no motion free",)),
        *case("event without a time", codes=2, lines=1, check=nothing,
              changes={"events": {"off": {"unlock": "clamp"}}}, says=("has none of at, when, probe",)),
        *case("event of no column", codes=2, lines=1, check=nothing,
              changes={"events": {"off": {"stop": True, "probe": "tip.w", "crosses": 1}}},
              says=('is "tip.w"', "one of tip.x, tip.y")),
        *case("event of a formula that is no number", codes=2, lines=1,
              changes={"events": {"off": {"stop": True, "when": "sqrt(0.02 - t) + 1"}}},
              says=("events.off.when: ", "is not a number at t = 0.02")),
        *case("number whose products are none", codes=2, lines=1, check=nothing,
              changes={"bodies.beam.section.EI": 1e-310}, says=("section.EI: is ", "the range of double precision")),
        *case("deformation that is no number", codes=2, lines=1, check=nothing,
              changes={"bodies.beam.initial": {"deformation": [0, "sqrt(abs(x - 0.4) - 0.2)"]}},
              says=("initial.deformation: ", "is not a number at x = 0.25")),
        Case("sweep of nothing", sweep, 2, ("--vary is required",), lines=1, check=nothing),
        Case("sweep of no path", [*sweep, "--vary", "loads.tp.force[2]=1,2"], 2,
             ("has no loads.tp", 'did you mean "tip"?'), lines=1, check=nothing),
        Case("sweep of a mapping", [*sweep, "--vary", "loads.tip=1,2"], 2, ("loads.tip is a mapping",), lines=1,
             check=nothing),
        Case("sweep without values", [*sweep, "--vary", "motion.step"], 2, ("has no path or no values",), lines=1,
             check=nothing),
        Case("sweep that never reaches its end", [*sweep, "--vary", "motion.step=1:2:-1"], 2, ("never reaches its end",), lines=1,
             check=nothing),
        Case("sweep in steps of nothing", [*sweep, "--vary", "motion.step=1:2:0"], 2, ("never reaches its end",), lines=1,
             check=nothing),
        Case("sweep of one path twice", [*sweep, "--vary", "motion.step=1e-3,2e-3", "--vary", "motion.step=1e-3"], 2,
             ("motion.step is varied twice",), lines=1, check=nothing),
        Case("sweep at full order", [*sweep, "--formulation", "nlffr", "--vary", "motion.step=1e-3,2e-3"], 2,
             ("a sweep simulates reduced models",), lines=1, check=nothing),
        Case("sweep without probes", [*sweep, "--vary", "motion.step=1e-3,2e-3"], 2, ("probes: is missing",), lines=1,
             scene=scene({"probes": None}), check=nothing),
    ]
