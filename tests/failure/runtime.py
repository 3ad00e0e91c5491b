"""Bad checkpoints, events and sweeps. (Runs that are killed and taken up again: restart.py.)"""
from scenes import scene


def cases(Case, run, case, nothing, kept):
    sweep = ["sweep", "scene.yaml", "-o", "out"]
    return [
        *(Case(f"checkpoint each {word}", run("vm+md", "--checkpoint", word), 2,
               (f"--checkpoint: is {word}; expected a number of steps",), lines=1, check=nothing)
          for word in ("0", "1.5", "10m", "nan", "abc")),
        Case("restart of nothing", ["run", "--restart", "nowhere"], 2, ("nowhere': is not there",), lines=1),
        Case("restart without a checkpoint", ["run", "--restart", "out"], 2,
             ("checkpoint.h5: is not there: the run was made without --checkpoint",), lines=1,
             files={"out/summary.json": "{}"}, check=kept("out/summary.json", "{}")),
        Case("restart from another file", ["run", "--restart", "out"], 2,
             ("checkpoint.h5: is no checkpoint of floe's",), lines=1, files={"out/checkpoint.h5": "mine"},
             check=kept("out/checkpoint.h5", "mine")),
        Case("restart into another folder", ["run", "--restart", "out", "-o", "other"], 2, ("--restart",), lines=1),
        Case("until without restart", run("vm+md", "--until", "1"), 2, ("--until",), lines=1, check=nothing),
        *case("event of no joint", codes=2, lines=1, check=nothing,
              changes={"events": {"off": {"unlock": "clmp", "at": 0.01}}},
              says=('events.off.unlock: is "clmp"', 'did you mean "clamp"?')),
        *case("event that locks a clamp", codes=2, lines=1, check=nothing,
              changes={"events": {"off": {"lock": "clamp", "at": 0.01}}},
              says=("which leaves nothing free",)),
        *case("event without a time", codes=2, lines=1, check=nothing,
              changes={"events": {"off": {"unlock": "clamp"}}}, says=("has none of at, when, probe",)),
        *case("event of no column", codes=2, lines=1,
              changes={"events": {"off": {"stop": True, "probe": "tip.w", "crosses": 1}}},
              says=('is "tip.w"', "a column of the probes")),
        Case("sweep of nothing", sweep, 2, ("--vary is required",), lines=1, check=nothing),
        Case("sweep of no path", [*sweep, "--vary", "loads.tp.force[2]=1,2"], 2,
             ("has no loads.tp", 'did you mean "tip"?'), lines=1, check=nothing),
        Case("sweep of a mapping", [*sweep, "--vary", "loads.tip=1,2"], 2, ("loads.tip is a mapping",), lines=1,
             check=nothing),
        Case("sweep without values", [*sweep, "--vary", "motion.step"], 2, ("names no path and values",), lines=1,
             check=nothing),
        Case("sweep that never arrives", [*sweep, "--vary", "motion.step=1:2:-1"], 2, ("never arrives",), lines=1,
             check=nothing),
        Case("sweep of one path twice", [*sweep, "--vary", "motion.step=1e-3,2e-3", "--vary", "motion.step=1e-3"], 2,
             ("motion.step is varied twice",), lines=1, check=nothing),
        Case("sweep at full order", [*sweep, "--formulation", "nlffr", "--vary", "motion.step=1e-3,2e-3"], 2,
             ("a sweep moves reduced models",), lines=1, check=nothing),
        Case("sweep without probes", [*sweep, "--vary", "motion.step=1e-3,2e-3"], 2, ("probes: is missing",), lines=1,
             scene=scene({"probes": None}), check=nothing),
    ]
