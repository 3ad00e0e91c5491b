"""The stresses of a plate of S8R, by CalculiX at its integration points and by `floe stress`."""
import re
import subprocess

import numpy as np

from fields import Fields, close, recovered

ALONG, ACROSS, THICKNESS, PRESSURE = 18, 12, 0.004, 50.0


def deck(step):
    """A swept plate of side lengths 0.6 and 0.4, clamped at one side; quadrilaterals with eight nodes."""
    number, lines = {}, ["*NODE, NSET=ALL"]
    for i in range(2 * ALONG + 1):
        for j in range(2 * ACROSS + 1):
            if i % 2 == 0 or j % 2 == 0:
                number[i, j] = len(number) + 1
                lines.append(f"{number[i, j]}, {0.6 * i / (2 * ALONG) + 0.1 * j / (2 * ACROSS):.12g}, {0.4 * j / (2 * ACROSS):.12g}, 0")
    lines.append("*ELEMENT, TYPE=S8R, ELSET=PLATE")
    corners = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    for p in range(ALONG):
        for q in range(ACROSS):
            nodes = ", ".join(str(number[2 * p + a, 2 * q + b]) for a, b in corners)
            lines.append(f"{p * ACROSS + q + 1}, {nodes}")
    lines += ["*NSET, NSET=EDGE", *(f"{number[0, j]}" for j in range(2 * ACROSS + 1)), "*MATERIAL, NAME=M", "*ELASTIC", "7e10, 0.3",
              "*DENSITY", "2700", "*SHELL SECTION, ELSET=PLATE, MATERIAL=M", f"{THICKNESS}"]
    if step:
        lines += ["*BOUNDARY", "EDGE, 1, 6", "*STEP", "*STATIC", "*DLOAD", f"PLATE, P, {-PRESSURE}",
                  "*EL PRINT, ELSET=PLATE", "S", "*EL PRINT, ELSET=PLATE", "COORD", "*END STEP"]
    return "\n".join(lines) + "\n"


def numbers_after(text, title):
    block = text[text.index(title):]
    block = block[block.index("\n") + 1:]
    rows = []
    for line in block.splitlines():
        words = line.split()
        if not words and rows:
            break
        if len(words) >= 5 and re.fullmatch(r"\d+", words[0]):
            rows.append([float(word) for word in words if re.fullmatch(r"[-+\d.Ee]+", word)])  # without the name of a set
    return np.array(rows)


def plate_of_second_order(program, folder):
    """Means over the elements of the stress on top: of CalculiX's integration points at z = h / (2 sqrt 3), times sqrt 3."""
    (folder / "ccx.inp").write_text(deck(True))
    subprocess.run(["ccx", "ccx"], cwd=folder, capture_output=True, text=True, timeout=300, check=True)
    text = (folder / "ccx.dat").read_text()
    stress, places = numbers_after(text, "stresses"), numbers_after(text, "coordinates")
    expected = {}
    for element in range(1, ALONG * ACROSS + 1):
        s, x = stress[stress[:, 0] == element], places[places[:, 0] == element]
        top = x[:, 4] > 0
        assert top.sum() == 4, (top.sum(), len(s))
        expected[element] = (x[:, 2:4].mean(0), np.sqrt(3) * s[top][:, [2, 3, 5]].mean(0))
    (folder / "plate.inp").write_text(deck(False))
    path, _ = recovered(program, folder, f"""
bodies:
  plate:
    mesh: {{file: {{path: plate.inp}}}}
joints: {{root: {{type: fixed, between: [ground, plate.EDGE]}}}}
loads: {{p: {{type: pressure, body: plate, pressure: {PRESSURE}}}}}
motion: {{end: 1, step: 0.1}}
""", formulation="lffr")
    found = Fields(path, "plate")
    ours = np.array([found["stress_top"][np.argmin(np.linalg.norm(found.x[:, :2] - x, axis=1))] for x, _ in expected.values()])
    theirs = np.array([s for _, s in expected.values()])
    sign = np.sign(np.sum(ours * theirs))  # which side is the top
    inner = np.array([x[0] - 0.25 * x[1] > 0.1 for x, _ in expected.values()])  # three rows of elements from the clamp
    close(sign * ours[inner], theirs[inner], 0.015, "stress of S8R")
    edge = np.array([x[0] - 0.25 * x[1] > 0.04 for x, _ in expected.values()])
    close(sign * ours[edge], theirs[edge], 0.03, "stress of S8R, to one row from the clamp")
