"""Meshes on paper: lines and faces, in the plane as they are, in space from a direction, true to scale."""
import math

import numpy as np


class View:
    """Maps points to the paper: x to the right, y up; depth towards the eye."""

    def __init__(self, dimension, azimuth=-60.0, elevation=25.0):
        self.dimension = dimension
        if dimension == 2:
            self.axes = np.eye(3)
            return
        a, e = math.radians(azimuth), math.radians(elevation)
        eye = np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)])
        right = np.array([-math.sin(a), math.cos(a), 0])
        self.axes = np.array([right, np.cross(eye, right), eye])

    def paper(self, x):
        return np.asarray(x) @ self.axes.T


def faces_of(mesh):
    return [[int(node) for node in face if node >= 0] for face in mesh.faces]


def draw_mesh(axes, view, mesh, x, values=None, norm=None, colour="0.3", width=1.6, fill="0.85", edge=(0, 0, 0, 0.35), order=2):
    """Lines and faces at x; coloured by a value at the nodes where there is one."""
    from matplotlib import cm
    from matplotlib.collections import LineCollection, PolyCollection

    from style import MAP

    at = view.paper(x)
    chosen = cm.get_cmap(MAP)

    def colours(cells):
        means = np.array([np.mean([values[node] for node in cell]) for cell in cells])
        return chosen(norm(means))

    faces = faces_of(mesh)
    if faces:
        faces.sort(key=lambda face: np.mean(at[face, 2]))  # the farthest first
        axes.add_collection(PolyCollection([at[face, :2] for face in faces], zorder=order,
                                           facecolors=colours(faces) if values is not None else fill,
                                           edgecolors=edge if len(faces) < 3000 else "face",
                                           linewidths=0.25 if len(faces) < 3000 else 0.1))
    if len(mesh.lines):
        lines = [list(line) for line in mesh.lines]
        axes.add_collection(LineCollection([at[line, :2] for line in lines], linewidths=width, zorder=order,
                                           capstyle="round",
                                           colors=colours(lines) if values is not None else colour))


MARKS = {"fixed": "s", "prismatic": "D", "driven_slide": "D", "cylindrical": "D", "planar": "D", "bushing": "h"}


def draw_joints(axes, view, run, row, amplify=1.0, colour="black", size=4.5, order=8):
    """Joints as marks at their places (squares hold, diamonds slide, circles turn), springs and rods as lines between
    theirs, the ground as a triangle below, arms of rigid bodies as lines from their middle."""
    middles = {}
    for joint in run.joints:
        at = [view.paper(x) for x in joint.at(run, row, amplify)]
        if joint.kind in ("spring", "distance") and len(at) == 2:
            axes.plot(*np.array(at)[:, :2].T, color=colour, linewidth=0.9, linestyle=(0, (2, 1)), zorder=order)
        if joint.grounded:
            grounds = [view.paper(x) for (body, *_), x in zip(joint.ends, joint.at(run, row, amplify)) if body is None]
            for x in grounds or at[:1]:
                axes.plot(x[0], x[1], marker=6, markersize=1.9 * size, color="0.55", zorder=order)
        for (body, node, way) in joint.ends:
            if body is not None and getattr(body, "rigid", False):
                if body.name not in middles:
                    middles[body.name] = view.paper(run.moved(body, row, amplify)[0].mean(0))
                x = view.paper(run.place(body, node, way, row, amplify))
                axes.plot([middles[body.name][0], x[0]], [middles[body.name][1], x[1]], color="0.45", linewidth=2.2,
                          solid_capstyle="round", zorder=order - 2)
        moving = [x for (body, *_), x in zip(joint.ends, at) if body is not None] or at
        for x in moving[:1] if joint.kind not in ("spring", "distance") else moving:
            axes.plot(x[0], x[1], marker=MARKS.get(joint.kind, "o"), markersize=size, markerfacecolor="white",
                      markeredgecolor=colour, markeredgewidth=1.0, zorder=order + 1)


class Box:
    """The paper that drawn points need."""

    def __init__(self):
        self.low, self.high = np.full(2, np.inf), np.full(2, -np.inf)

    def add(self, view, x):
        at = view.paper(x)[:, :2]
        self.low, self.high = np.minimum(self.low, at.min(0)), np.maximum(self.high, at.max(0))

    def limits(self, margin=0.06):
        size = self.high - self.low
        least = 0.15 * max(size.max(), 1e-300)  # a straight beam is no line without height
        middle = 0.5 * (self.low + self.high)
        half = 0.5 * np.maximum(size, least) + margin * max(size.max(), 1e-300)
        return middle - half, middle + half


def round_length(length):
    """1, 2 or 5 times a power of ten, at most that long."""
    power = 10.0 ** math.floor(math.log10(length))
    return max(factor * power for factor in (1, 2, 5) if factor * power <= length * (1 + 1e-9))


def set_frame(axes, view, low, high):
    """In the plane axes with numbers; in space a bar that gives the scale, and the directions of the world."""
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    if view.dimension == 2:
        axes.set_xlabel("x [m]")
        axes.set_ylabel("y [m]")
        return
    axes.set_axis_off()


def with_scale(low, high):
    """Lower limits that leave room for draw_scale."""
    return np.array([low[0], low[1] - 0.2 * max(high - low)])


def draw_scale(axes, view, low, high):
    """Below the picture of a mechanism in space: how long a length is, and where x, y and z point."""
    wide = high - low
    length = round_length(0.22 * wide[0])
    y = low[1] + 0.03 * wide[1]
    start = low[0] + 0.03 * wide[0]
    axes.plot([start, start + length], [y, y], color="black", linewidth=2, solid_capstyle="butt", zorder=9)
    axes.annotate(f"{length:g} m", (start + length / 2, y), xytext=(0, 3), textcoords="offset points", ha="center",
                  va="bottom", fontsize=8, zorder=9)
    reach = 0.09 * max(wide)
    origin = np.array([high[0] - 1.5 * reach, low[1] + 0.55 * reach])
    for name, unit in zip("xyz", np.eye(3)):
        way = view.paper(unit)[:2]
        if np.linalg.norm(way) < 0.1:
            continue
        axes.annotate("", origin + reach * way, origin, arrowprops={"arrowstyle": "->", "color": "0.25"}, zorder=9)
        axes.annotate(name, origin + 1.35 * reach * way, ha="center", va="center", fontsize=8, color="0.25", zorder=9)
