"""The same plate, as many nodes and as many modes, by CalculiX (Debian's calculix-ccx) and by `floe modes`: whole processes.

CalculiX's triangles and four-noded shells lock in bending at this thickness (S3: 1.51 Hz for 0.42 Hz at 6 thousand dofs), so
its model is of S8R, quadratic with reduced integration, on a structured grid with the number of nodes of floe's, as near as the
grid allows. Both run on one processor.
"""
import os
import shutil
import subprocess
import tempfile
import threading
import time

LENGTH, WIDTH, THICKNESS, YOUNG, POISSON, DENSITY = 2, 1, 0.002, 7e10, 0.3, 2700


def run(command, folder, limit):
    """Standard output, wall and processor seconds, and greatest memory [GB] of a process; None if it takes too long."""
    environment = dict(os.environ, OMP_NUM_THREADS="1", CCX_NPROC_EQUATION_SOLVER="1", OMPI_MCA_mpi_yield_when_idle="0")
    start = time.time()
    with open(os.path.join(folder, "output"), "w+") as output:
        child = subprocess.Popen(command, cwd=folder, env=environment, stdout=output, stderr=subprocess.STDOUT)
        alarm = threading.Timer(limit, child.kill)
        alarm.start()
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = status
        late = not alarm.is_alive()
        alarm.cancel()
        output.seek(0)
        text = output.read()
    if late:
        print(f"{' '.join(command)}: ended after {limit} s", flush=True)
        return None, None
    if status:
        raise SystemExit(f"{' '.join(command)}\n{text[-2000:]}")
    return text, {"wall": time.time() - start, "cpu": usage.ru_utime + usage.ru_stime, "memory": usage.ru_maxrss / 1048576}


def grid(cells):
    """Elements of S8R along and across whose nodes are about as many as those of cells x cells / 2 cells of triangles."""
    wanted = (cells + 1) * (cells // 2 + 1)
    across = max(1, round((cells / 3**0.5) / 2))
    along = min(range(across, 4 * across), key=lambda p: abs((2 * p + 1) * (2 * across + 1) - p * across - wanted))
    return along, across


def deck(path, cells, modes):
    """Writes the input; returns its number of nodes."""
    along, across = grid(cells)
    number = {}
    for i in range(2 * along + 1):
        for j in range(2 * across + 1):
            if i % 2 == 0 or j % 2 == 0:
                number[i, j] = len(number) + 1
    corners = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    with open(path, "w") as out:
        out.write("*NODE, NSET=ALL\n")
        for (i, j), n in number.items():
            out.write(f"{n}, {LENGTH * i / (2 * along):.12g}, {WIDTH * j / (2 * across):.12g}, 0\n")
        out.write("*ELEMENT, TYPE=S8R, ELSET=PLATE\n")
        for p in range(along):
            for q in range(across):
                nodes = ", ".join(str(number[2 * p + a, 2 * q + b]) for a, b in corners)
                out.write(f"{p * across + q + 1}, {nodes}\n")
        out.write("*NSET, NSET=EDGE\n")
        for j in range(2 * across + 1):
            out.write(f"{number[0, j]}\n")
        out.write(f"*MATERIAL, NAME=M\n*ELASTIC\n{YOUNG}, {POISSON}\n*DENSITY\n{DENSITY}\n"
                  f"*SHELL SECTION, ELSET=PLATE, MATERIAL=M\n{THICKNESS}\n*BOUNDARY\nEDGE, 1, 6\n"
                  f"*STEP\n*FREQUENCY\n{modes}\n*END STEP\n")
    return len(number)


def frequencies_of_calculix(path, modes):
    """[Hz], from its .dat: number, eigenvalue, rad/s, Hz, imaginary part."""
    found = []
    with open(path) as lines:
        for line in lines:
            words = line.split()
            if len(words) == 5 and words[0] == str(len(found) + 1) and len(found) < modes:
                found.append(float(words[3]))
    return found


SCENE = """
title: plate
bodies:
  plate:
    mesh: {{plate: {{along: [{length}, 0, 0], across: [0, {width}, 0], elements: [{along}, {across}]}}}}
    section: {{thickness: {thickness}}}
    material: {{E: {young}, nu: {poisson}, rho: {density}}}
    frame: {{type: clamped, at: left}}
    reduction: {{modes: {modes}, derivatives: none}}
joints:
  clamp: {{type: fixed, between: [ground, plate.left]}}
motion: {{end: 1, step: 0.1}}
"""


def frequencies_of_floe(text, modes):
    """[Hz], from the table of `floe modes`: body, number, Hz, rad/s, residual."""
    found = []
    for line in text.splitlines():
        words = line.split()
        if len(words) == 5 and words[1] == str(len(found) + 1) and len(found) < modes:
            found.append(float(words[2]))
    return found


def compare(floe, cells, modes=10, limit=300):
    """One row: both processes on plates of as many nodes. None without ccx, or where one takes too long."""
    if not shutil.which("ccx"):
        return None
    folder = tempfile.mkdtemp()
    try:
        nodes = deck(os.path.join(folder, "plate.inp"), cells, modes)
        _, theirs = run(["ccx", "-i", "plate"], folder, limit)
        if not theirs:
            return None
        theirs["frequencies"] = frequencies_of_calculix(os.path.join(folder, "plate.dat"), modes)
        with open(os.path.join(folder, "scene.yaml"), "w") as out:
            out.write(SCENE.format(length=LENGTH, width=WIDTH, thickness=THICKNESS, young=YOUNG, poisson=POISSON,
                                   density=DENSITY, along=cells, across=cells // 2, modes=modes))
        text, ours = run([os.path.abspath(floe), "modes", "scene.yaml"], folder, limit)
        if not ours:
            return None
        ours["frequencies"] = frequencies_of_floe(text, modes)
    finally:
        shutil.rmtree(folder)
    if len(theirs["frequencies"]) < modes or len(ours["frequencies"]) < modes:
        raise SystemExit(f"frequencies are missing:\n{theirs}\n{ours}\n{text}")
    apart = max(abs(a / b - 1) for a, b in zip(ours["frequencies"], theirs["frequencies"]))
    return {"nodes": (cells + 1) * (cells // 2 + 1), "their nodes": nodes, "floe": ours, "calculix": theirs, "apart": apart}


def table_of(rows):
    if not rows:
        return "Not measured: `ccx` (package calculix-ccx) was not found, or took too long."
    lines = ["| nodes, floe and CalculiX | floe CPU [s] | CalculiX CPU [s] | ratio | floe wall [s] | CalculiX wall [s] | floe GB | "
             "CalculiX GB | max difference of frequencies |", "|" + "---:|" * 9]
    for row in rows:
        ours, theirs = row["floe"], row["calculix"]
        lines.append(f"| {row['nodes']}, {row['their nodes']} | {ours['cpu']:.2f} | {theirs['cpu']:.2f} | "
                     f"{theirs['cpu'] / ours['cpu']:.1f} | {ours['wall']:.2f} | {theirs['wall']:.2f} | {ours['memory']:.2f} | "
                     f"{theirs['memory']:.2f} | {100 * row['apart']:.2f} % |")
    return "\n".join(lines)
