"""Slender beams, thin plates, long triangles."""
from floe import Floe, relative
from scenes import cantilever, plate, spatial_cantilever, tip_force
from study import Answer, Miss, Point, Study

LOAD = 0.5  # P L^2 / EI
TIP = [-LOAD**2 / 15, LOAD / 3]  # of von Karman's beam in the frame of its root: no stretch, for the load is across


def bent(floe: Floe, ratio, formulation):
    scene = cantilever(EA=ratio**2, attachment="all", loads=tip_force(0, f"{LOAD}*t"))
    end = floe.static(scene, formulation, "--at", "1", "--steps", "1").vector("tip")[-1]
    return max(abs(end[0] / TIP[0] - 1), abs(end[1] / TIP[1] - 1))


def bent_in_space(floe: Floe, ratio, formulation):
    h = 12**0.5 / ratio
    scene = spatial_cantilever(h, h, E=12 / h**4, attachment="all", loads=tip_force(0, 0, f"{LOAD}*t"))
    end = floe.static(scene, formulation, "--at", "1", "--steps", "1").vector("tip")[-1]
    return max(abs(end[0] / TIP[0] - 1), abs(end[2] / TIP[1] - 1))


def moving(floe: Floe, ratio, formulation):
    """Against the same beam of L/r = 1000: inextensible to a millionth."""
    def history(r, of):
        scene = cantilever(elements=8, EA=r**2, loads=tip_force(0, "1.5*sin(3*t)"))
        return floe.run(scene, of).vector("tip")
    return relative(history(ratio, formulation), history(1000, formulation))


def immovable(floe: Floe, ratio, formulation):
    """Hinged beam between immovable supports, uniform load 1000 EI r / L^4: W/r = 3.34492425434."""
    scene = cantilever(elements=16, EA=ratio**2, frame="pinned", modes=10,
                       loads={"q": {"type": "distributed", "body": "beam", "force": [0, f"{1000 / ratio!r}*t"]}})
    scene["joints"] = {end: {"type": "revolute", "between": ["ground", f"beam.{end}"]} for end in ("start", "end")}
    scene["probes"] = {"middle": {"at": "beam.middle"}}
    end = floe.static(scene, formulation, "--at", "1", "--steps", "4").end("middle.y")
    return abs(end * ratio / 3.34492425434 - 1)


def pressed(floe: Floe, h, formulation, cells="triangles"):
    """Deflection over thickness of a clamped square plate at q a^4 / (E h^4) = 100."""
    scene = plate(1, 1, (8, 8), h, cells, E=1 / h**3, loads={
        "q": {"type": "pressure", "body": "plate", "pressure": f"{100 * h!r}*t", "follower": False}})
    scene["joints"] = {e: {"type": "fixed", "between": ["ground", f"plate.{e}"]}
                       for e in ("left", "right", "bottom", "top")}
    scene["probes"] = {"middle": {"at": {"body": "plate", "node": [0.5, 0.5, 0]}}}
    return floe.static(scene, formulation, "--at", "1", "--steps", "2").end("middle.z") / h


def thin(floe: Floe, h, formulation, cells="triangles"):
    """The von Karman plate's w/h does not know h: against h/a = 1e-3. (Modes do: by the inertia in the plane and of
    sections, of second order in h.)"""
    return abs(pressed(floe, h, formulation, cells) / pressed(floe, 1e-3, formulation, cells) - 1)


def strip(floe: Floe, width, cells, formulation="nlffr"):
    """A narrow strip of long elements under its weight bends as a beam, w = q L^4 / 8 D with nu = 0: compared with square elements."""
    h = 1e-3
    def tip(elements):
        scene = plate(1, width, elements, h, cells, nu=0, E=12 / h**3, rho=1 / h, gravity=[0, 0, "1e-6*t"])
        return floe.static(scene, formulation, "--at", "1", "--steps", "1").end("tip.z")
    return abs(tip((8, 8)) / tip((8, 1)) - 1)


def spread(floe: Floe, width, cells):
    """A strip with nu = 0 under its weight, 16 by 4 elements: w = q L^4 / 8 D at its corner, whatever its width."""
    h = 1e-3
    scene = plate(1, width, (16, 4), h, cells, nu=0, E=12 / h**3, rho=1 / h, gravity=[0, 0, "1e-6*t"])
    rest = floe.static(scene, "nlffr", "--at", "1", "--steps", "1")
    error = abs(rest.end("tip.z") / (1e-6 / 8) - 1)
    return Answer(0, f"{100 * error:.2g} %, warning") if rest.warned("intra-element deflection") else error


def long_frequency(floe: Floe, cells_along, cells):
    """A cantilever plate of so many elements along and four across: its first frequency relative to that with 40 along."""
    def first(n):
        return floe.modes(plate(1, 1, (n, 4), 1e-3, cells, E=12 / 1e-9, rho=1e3, modes=2))[0]
    return abs(first(cells_along) / first(40) - 1)


def ratios(measure, values, formulations, limit, quick=(), misses=None, says=None):
    return [Point(f"L/r = {v:g}, {f}", lambda floe, v=v, f=f: measure(floe, v, f), limit(v) if callable(limit) else limit,
                  quick=(v, f) in quick, misses=(misses or {}).get((v, f)), says=(says or {}).get((v, f), "")) for f in formulations for v in values]


DROPPED = ("drop_tolerance 1e-7 drops a derivative of which 1e-7 is new, and the axis is (L/r)^2 times as stiff as the "
           "bending; 1e-9 keeps it (and keeps noise as a basis vector in other scenes)")


SPREAD = ("DKT elements deflect freely between their edges under distributed loads; the intra-element part of the deflection, which triggers the warning, is below "
          "5 % yet")
# EA/EI = 1e14: the bending is within some eps of the stretching in the tangent of full order
TOO_SLENDER = {(1e7, "nlffr"): "singular tangent stiffness"}
SLENDER = [1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7]
STUDIES = [
    Study("slender cantilever", "L/r from 10 to 1e7, EA/EI = (L/r)^2, bent by PL^2/EI = 0.5",
          "closed form w/L = a/3, u/L = -a^2/15",
          ratios(bent, SLENDER, ("nlffr", "vm+md"), 1e-5, {(1e1, "nlffr"), (1e5, "nlffr"), (1e5, "vm+md"), (1e6, "vm+md")}, says=TOO_SLENDER)),
    Study("slender cantilever in space", "L/r from 10 to 1e7", "the same closed form",
          ratios(bent_in_space, SLENDER, ("nlffr", "vm+md"), 1e-5, {(1e5, "vm+md")},
                 {(1e7, "vm+md"): Miss(DROPPED, 0.01)}, TOO_SLENDER)),
    Study("slender cantilever in motion", "L/r from 1e3 to 1e7, tip force 1.5 EI/L^2",
          "the same motion at L/r = 1000, which stretches by a millionth",
          ratios(moving, SLENDER[3:], ("nlffr", "vm+md"), 1e-4, {(1e5, "vm+md")})),
    Study("immovable beam", "L/r from 10 to 1e6, deflection 3.3 r", "closed form",
          ratios(immovable, SLENDER[:6], ("nlffr", "vm+md"), 2e-5, {(1e5, "vm+md")})),
    Study("thin plate", "thickness over length from 0.1 to 1e-6, deflection 0.94 h",
          "the scaled copy h/a = 1e-3",
          [Point(f"h/a = {h:g}, {f}, {c}", lambda floe, h=h, f=f, c=c: thin(floe, h, f, c),
                 1e-8 if f == "nlffr" else 1e-6 + h * h, quick=q)
           for h, f, c, q in [(1e-1, "nlffr", "triangles", False), (1e-2, "nlffr", "triangles", False),
                              (1e-4, "nlffr", "triangles", False), (1e-5, "nlffr", "triangles", True),
                              (1e-6, "nlffr", "triangles", False), (1e-5, "nlffr", "quadrilaterals", False),
                              (1e-2, "vm+md", "triangles", False), (1e-5, "vm+md", "triangles", True),
                              (1e-6, "vm+md", "triangles", False), (1e-5, "vm+md", "quadrilaterals", False)]]),
    Study("long elements", "strips of 8 by 8 elements 12.5 to 1e4 times as long as wide, as nlffr", "a strip of 8 by 1 elements",
          [Point(f"width {w:g}, {c}", lambda floe, w=w, c=c: strip(floe, w, c), 2e-2 if w > 5e-3 else None, "singular tangent stiffness",
                 quick=(w, c) == (1e-2, "triangles"))
           for c in ("triangles", "quadrilaterals") for w in (1e-1, 3e-2, 1e-2, 3e-3, 1e-4)]),
    Study("wide elements", "elements 10 to 1000 times as wide as long, first frequency", "the plate with 40 by 4 elements",
          [Point(f"{n} by 4, {c}", lambda floe, n=n, c=c: long_frequency(floe, n, c), 1e-2, quick=(n, c) == (400, "triangles"))
           for c in ("triangles", "quadrilaterals") for n in (160, 400, 1000, 4000)]),
    Study("wide elements under distributed loads", "elements 4 to 4000 times as wide as long", "closed form w = q L^4 / 8 D (nu = 0); or a warning",
          [Point(f"width {w:g}, {c}", lambda floe, w=w, c=c: spread(floe, w, c), 2e-3, quick=(w, c) == (100, "triangles"),
                 misses={2: Miss(SPREAD, 0.02), 4: Miss(SPREAD, 0.08)}.get(w))
           for c in ("triangles", "quadrilaterals") for w in (1, 2, 4, 10, 100, 1000)]),
]
