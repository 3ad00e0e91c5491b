"""Scenes that several studies begin with. In the plane and in space: L = EI = rhoA = 1 where nothing else is said."""


def cantilever(elements=16, EA=1e6, modes=5, frame="clamped", attachment="joints", **more):
    """Clamped at x = 0. Its first frequency is 3.516 rad/s."""
    return {
        "bodies": {"beam": {
            "mesh": {"line": {"from": [0, 0], "to": [1, 0], "elements": elements}},
            "section": {"EA": EA, "EI": 1, "rhoA": 1},
            "frame": {"type": "clamped", "at": "start"} if frame == "clamped" else "pinned",
            "reduction": {"modes": modes, "derivatives": "all", "attachment": attachment}}},
        "joints": {"clamp": {"type": "fixed", "between": ["ground", "beam.start"]}},
        "motion": {"end": 1, "step": 1e-3},
        "probes": {"tip": {"at": "beam.end"}},
        **more}


def tip_force(*components):
    return {"tip": {"type": "force", "at": "beam.end", "force": list(components)}}


def spatial_cantilever(width, height, elements=16, modes=5, E=1.0, rho=1.0, attachment="joints", **more):
    """Along x; width is along y, height along z."""
    return {
        "bodies": {"beam": {
            "mesh": {"line": {"from": [0, 0, 0], "to": [1, 0, 0], "elements": elements}},
            "section": {"shape": "rectangle", "width": width, "height": height, "orientation": [0, 1, 0]},
            "material": {"E": E, "nu": 0.3, "rho": rho},
            "frame": {"type": "clamped", "at": "start"},  # whose closed forms are known
            "reduction": {"modes": modes, "derivatives": "all", "attachment": attachment}}},
        "joints": {"clamp": {"type": "fixed", "between": ["ground", "beam.start"]}},
        "motion": {"end": 1, "step": 1e-3},
        "probes": {"tip": {"at": "beam.end"}},
        **more}


def plate(along, across, elements, thickness, cells="triangles", nu=0.3, E=1.0, rho=1.0, modes=5, **more):
    """In the x-y plane, clamped at x = 0."""
    return {
        "bodies": {"plate": {
            "mesh": {"plate": {"along": [along, 0, 0], "across": [0, across, 0], "elements": list(elements),
                               "cells": cells}},
            "section": {"thickness": thickness},
            "material": {"E": E, "nu": nu, "rho": rho},
            "reduction": {"modes": modes, "derivatives": "all"}}},
        "joints": {"root": {"type": "fixed", "between": ["ground", "plate.left"]}},
        "motion": {"end": 1, "step": 1e-3},
        "probes": {"tip": {"at": "plate.p3"}},
        **more}


def pendulum(elements=12, EA=1.2e4, modes=3, **more):
    """Released horizontally; its first bending frequency is 15.4 rad/s."""
    return {
        "gravity": [0, -9.81],
        "bodies": {"rod": {
            "mesh": {"line": {"from": [0, 0], "to": [1, 0], "elements": elements}},
            "section": {"EA": EA, "EI": 1, "rhoA": 1},
            "frame": "pinned",
            "reduction": {"modes": modes, "derivatives": "all"}}},
        "joints": {"hinge": {"type": "revolute", "between": ["ground", "rod.start"]}},
        "motion": {"end": 1, "step": 1e-3},
        "probes": {"tip": {"at": "rod.end", "quantity": "position"}},
        **more}
