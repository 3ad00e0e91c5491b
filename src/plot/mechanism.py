"""The mechanism's motion as numbers in a page, for viewer.js: few coordinates where the body is reduced, else samples."""
import base64
import json

import numpy as np

FRAMES = 200
MOST_BYTES = 30_000_000  # of a page


def packed(array, kind):
    return base64.b64encode(np.ascontiguousarray(array, dtype=kind).tobytes()).decode()


def triangles_of(mesh):
    found = []
    for a, b, c, d in mesh.faces:
        found.append((a, b, c))
        if d >= 0:
            found.append((a, c, d))
    return np.array(found, np.uint32).reshape(-1, 3)


def edges_of(mesh):
    found = set()
    for face in mesh.faces:
        nodes = [int(node) for node in face if node >= 0]
        found.update((min(p), max(p)) for p in zip(nodes, nodes[1:] + nodes[:1]))
    return np.array(sorted(found), np.uint32).reshape(-1, 2)


def bytes_of(run, frames):
    total = 0
    for body in run.bodies:
        n = 3 * len(body.mesh.positions)
        total += 4 * (n + n * (len(body.basis) if body.basis is not None else frames if body.dofs is not None else 0))
    return total


def of_body(run, body, rows):
    mesh, frames, etas, us, greatest = body.mesh, [], [], [], 0.0
    reduced = body.basis is not None and body.dofs is None
    for row in rows:
        U = run.U[row]
        R, A = body.frame_at(U, run.attitude_at(row))
        u = body.deformation(U)
        greatest = max(greatest, float(np.linalg.norm(u, axis=1).max(initial=0)))
        frames.append(np.concatenate([R, A.ravel()]))
        if reduced:
            etas.append(U[body.elastic:body.elastic + len(body.basis)])
        elif body.dofs is not None:
            us.append(u)
    data = {"name": body.name, "rigid": body.rigid, "nodes": len(mesh.positions), "k": len(etas[0]) if etas else 0,
            "X": packed(mesh.positions, "<f4"), "frames": packed(frames, "<f4"), "lines": packed(mesh.lines, "<u4"),
            "triangles": packed(triangles_of(mesh), "<u4"), "edges": packed(edges_of(mesh), "<u4")}
    if etas:
        data["eta"], data["basis"] = packed(etas, "<f4"), packed(body.basis[:len(etas[0])], "<f4")
    if us:
        data["u"] = packed(us, "<f4")
    return data, greatest


def joint_data(run):
    """Of each joint one end on a body: its number, the node, the way from there; and places on the ground."""
    numbers, found = {body.name: i for i, body in enumerate(run.bodies)}, []
    for joint in run.joints:
        body, node, way = next(end for end in joint.ends if end[0] is not None)
        found.append({"name": joint.name, "kind": joint.kind, "body": numbers[body.name], "node": node,
                      "way": [float(x) for x in way]})
        if joint.grounded:
            at = [x for (of, *_), x in zip(joint.ends, joint.at(run, 0)) if of is None]
            found[-1]["ground"] = [float(x) for x in at[0]] if at else None
    return found


def script_data(run):
    """JavaScript that gives viewer.js its numbers; or None, and why there is no view."""
    if not run.bodies:
        return None, "no body has a mesh in the results"
    rows = run.spread_rows(FRAMES)
    while len(rows) > 10 and bytes_of(run, len(rows)) > MOST_BYTES:
        rows = rows[::2]
    if bytes_of(run, len(rows)) > MOST_BYTES:
        return None, "the meshes are too large for a page; floe motion writes them for ParaView"
    made = [of_body(run, body, rows) for body in run.bodies]
    labels = [f"t = {run.t[row]:.5g} s" for row in rows]  # of a path of equilibria t also falls
    data = {"dimension": run.dimension, "t": rows if run.is_path else [float(run.t[row]) for row in rows],
            "labels": labels if run.is_path else None,
            "greatest": max(greatest for _, greatest in made) or 1.0, "bodies": [body for body, _ in made],
            "joints": joint_data(run)}
    return "window.floeMotion = " + json.dumps(data).replace("</", "<\\/") + ";", ""
