"""Denormal numbers, infinities and what is no number, in scenes and in formulas, at the start and in the middle."""
from floe import Floe, changed
from scenes import cantilever, pendulum, plate, tip_force
from study import Answer, Point, Refusal, Study


def with_value(floe: Floe, path, value):
    scene = changed(cantilever(4, loads=tip_force(0, 1)), {path: value})
    floe.run(scene, "vm+md")
    return float("nan")


def denormal(floe: Floe, scale, formulation):
    """All stiffness, mass and load times a number: the same motion, or a refusal."""
    scene = cantilever(4, EA=1e4 * scale, loads=tip_force(0, f"{scale!r}*sin(3*t)"))
    scene["bodies"]["beam"]["section"] = {"EA": 1e4 * scale, "EI": scale, "rhoA": scale}
    known = cantilever(4, EA=1e4, loads=tip_force(0, "sin(3*t)"))
    moved = floe.run(scene, formulation).vector("tip")
    exact = floe.run(known, formulation).vector("tip")
    return float(abs(moved - exact).max() / abs(exact).max())


def stops(floe: Floe, scene, at, formulation="vm+md"):
    """Ends at `at` with exit code 1, and keeps what was computed until then; the same as a run that ends before."""
    kept = []
    try:
        floe.run(scene, formulation, keep=kept)
    except Refusal as refusal:
        assert refusal.code == 1, f"exit code {refusal.code}: {refusal.text}"
        stopped = kept[0]
        assert stopped.summary["status"] == "failed" and stopped.summary["reason"] in refusal.text, stopped.summary["reason"]
        step = scene["motion"]["step"]
        last = stopped.t[-1]
        assert at - 1.01 * step <= last <= at, f"ended at {last}, not at the last step before {at}"
        assert f"t = {last:.6g}" in refusal.text or "t = " in refusal.text, refusal.text
        before = changed(scene, {"motion.end": float(last)})
        whole = floe.run(before, formulation)
        n = min(len(stopped.t), len(whole.t)) - 1
        size = max(abs(v).max() for v in whole.probes.values())
        error = max(abs(stopped.probes[c][:n] - whole.probes[c][:n]).max() for c in whole.probes) / size
        return Answer(float(error), refusal.text)
    raise AssertionError("it was not stopped")


def short(**more):
    return cantilever(4, EA=1e4, modes=2, **{"motion": {"end": 0.1, "step": 1e-3}, "loads": tip_force(0, "sin(9*t)"), **more})


def gap(at):
    """Not a number between at - 2e-4 and at + 2e-4: between the times that reading a scene looks at."""
    return f"sqrt((t - {at})^2 - 4e-8)"


BLOWN = {
    "force": short(loads=tip_force(0, f"sin(9*t) + {gap(0.037)}")),
    "force, infinite": short(loads=tip_force(0, "sin(9*t) + (t < 0.0365 ? 0 : 1/(t >= 0.0374 ? 1 : 0))")),
    "gravity": short(gravity=[0, f"-9.81 + {gap(0.037)}"]),
    "ground": short(ground={"acceleration": [0, f"sin(9*t) + {gap(0.037)}"]}),
    "moment": short(loads={"m": {"type": "moment", "at": "beam.end", "moment": f"sin(9*t) + {gap(0.037)}"}}),
    "distributed": short(loads={"q": {"type": "distributed", "body": "beam", "force": [0, f"sin(9*t) + {gap(0.037)}"]}}),
}
DRIVEN = short(joints={"clamp": {"type": "driven", "between": ["ground", "beam.start"],
                                 "angle": f"0.1*sin(9*t) + 0.01*({gap(0.037)} - sqrt(0.037^2 - 4e-8))"}})
SPEED = short(joints={"clamp": {"type": "driven", "between": ["ground", "beam.start"], "speed": f"sin(9*t) + {gap(0.037)}"}})
PRESSED = plate(1, 0.5, (4, 2), 5e-3, E=7e10, rho=2700, modes=2, motion={"end": 0.1, "step": 1e-3}, loads={
    "p": {"type": "pressure", "body": "plate", "pressure": f"sin(9*t) + {gap(0.037)}"}})
GROWING = short(loads=tip_force(0, "exp(20000*t) - 1"))  # overflows at t = 0.0355


def blows_up(scene, formulation):
    return lambda floe: stops(floe, scene, 0.037, formulation)


def too_large(floe: Floe):
    """A load that overflows: refused when the scene is read, because it is looked at there."""
    floe.run(GROWING, "vm+md")
    return float("nan")


def bad_shape(floe: Floe, formula):
    scene = short()
    scene["bodies"]["beam"]["initial"] = {"deformation": [0, formula]}
    floe.run(scene, "vm+md")
    return float("nan")


def bad_event(floe: Floe):
    floe.run(short(events={"off": {"stop": True, "when": f"{gap(0.037)} - 1"}}), "vm+md")
    return float("nan")


NOT_NUMBERS = [".nan", ".inf", "-.inf", "1e400", "1/0", "sqrt(-1)", "0/0", "exp(1000)"]
KEYS = {"bodies.beam.section.EI": "EI", "bodies.beam.section.EA": "EA", "bodies.beam.section.rhoA": "rhoA",
        "motion.end": "motion.end", "motion.step": "motion.step", "bodies.beam.mesh.line.to": "to",
        "loads.tip.force": "force", "gravity": "gravity", "bodies.beam.damping": "damping"}


def faulty(key, word):
    value = {"bodies.beam.mesh.line.to": [word, 0], "loads.tip.force": [0, word], "gravity": [0, word],
             "bodies.beam.damping": {"mass": word}}.get(key, word)
    return lambda floe: with_value(floe, key, value)


STUDIES = [
    Study("non-finite numbers in a scene", ", ".join(NOT_NUMBERS) + " in nine keys", "a refusal that names the key",
          [Point(f"{name}: {word}", faulty(key, word), None, name, quick=(name, word) in (("EI", ".nan"), ("force", "1/0")))
           for key, name in KEYS.items() for word in NOT_NUMBERS]),
    Study("smallest and largest numbers", "stiffness, mass and load of 1e-310 to 1e300", "the scaled copy",
          [Point(f"{s:g}, {f}", lambda floe, s=s, f=f: denormal(floe, s, f), 1e-8 if 1e-120 <= s <= 1e110 else None,
                 "double precision", quick=(s, f) == (1e-310, "vm+md"))
           for f in ("vm+md", "nlffr") for s in (1e-310, 1e-200, 1e-120, 1e-50, 1e50, 1e110, 1e200, 1e300)]),
    Study("formulas that fail in the middle", "not a number at t = 0.037 of 0.1", "the run that ends before, and the time in the message",
          [Point(f"{name}, {f}", blows_up(scene, f), 1e-12, quick=(name, f) == ("force", "vm+md"))
           for name, scene in BLOWN.items() for f in ("vm+md", "nlffr")] +
          [Point(f"{name}, {f}", blows_up(scene, f), 1e-12, quick=(name, f) == ("speed", "vm+md"))
           for name, scene in (("angle", DRIVEN), ("speed", SPEED), ("pressure", PRESSED)) for f in ("vm+md", "nlffr")]),
    Study("formulas that overflow", "exp(20000 t)", "a refusal when the scene is read",
          [Point("force", too_large, None, "infinite", quick=True)]),
    Study("shapes that are not finite", "initial deformation within the beam", "a refusal that names the key",
          [Point(f, lambda floe, f=f: bad_shape(floe, f), None, "deformation", quick=True)
           for f in ("sqrt(abs(x - 0.4) - 0.2)", "1/(x - 0.5)", "log(x)")]),
    Study("events that are not finite", "a formula of t", "a refusal", [Point("when", bad_event, None, "not a number", quick=True)]),
]
