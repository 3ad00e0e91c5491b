#!/usr/bin/env python3
"""PETSc's options by floe's prefixes: each gives the same answer, is refused by name (exit code 2), or fails with an error
that names the option or its prefix (exit code 1). None crashes, hangs, prints PETSc's own traceback or changes the answer.

petsc_options.py FLOE [all] [WORD...]: the sets of SOME; or `all` that `floe ... -help` lists, with values made from what it
says of each (some two thousand runs, an hour); only those that contain a WORD.
"""
import concurrent.futures
import csv
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from scenes import scene

TIME_LIMIT = 60  # s
SCENE = scene({"motion": {"end": 0.01, "step": 0.001}, "bodies.beam.mesh.line.elements": 4})
ROTOR = scene({"motion": None, "loads": None, "probes": None, "bodies.beam.mesh.line.elements": 4,
               "joints.clamp": {"type": "driven", "between": ["ground", "beam.start"], "angle": "t"}})

# Solver options that floe names in its help: they must work.
ACCEPTED = {"campbell_pep_nev", "campbell_pep_type qarnoldi", "campbell_st_type shift", "campbell_pep_tol"}
COMMANDS = {
    "run": (SCENE, ["run", "scene.yaml", "-o", "out"]),
    "nlffr": (SCENE, ["run", "scene.yaml", "--formulation", "nlffr", "-o", "out"]),
    "static": (SCENE, ["static", "scene.yaml", "--steps", "2", "--at", "0.1", "-o", "out"]),
    "modes": (SCENE, ["modes", "scene.yaml"]),
    "campbell": (ROTOR, ["campbell", "scene.yaml", "--speeds", "0,3", "--modes", "2", "-o", "out"]),
}
PREFIXES = ("modes", "derivatives", "estimate", "motion", "static", "campbell", "ranking")
# Options of how finely is computed: the answer is that of the last row, within 5 %.
FINENESS = re.compile(r"_ts_(type|rtol|atol|adapt_\w+)$|_(rtol|atol|stol|tol|max_it)$|_snes_divergence_tolerance$|_ksp_ew")
# Options of what is computed, as motion.step, motion.end and motion.spectral_radius of a scene: an answer of finite numbers.
OTHERWISE = re.compile(r"_ts_(dt|max_time|generalized_alpha_radius)$")

# command: options that make check tries; what is refused, and what is not
SOME = {
    "run": """
        motion_ts_exact_final_time interpolate | motion_ts_exact_final_time stepover | motion_ts_exact_final_time matchstep
        motion_ts_init_time 1 | motion_ts_init_time nan | motion_ts_monitor_cancel | motion_ts_rhs_jacobian_test_mult
        motion_ts_dmswarm_monitor_moments | motion_ts_convergence_estimate | motion_snes_convergence_estimate
        motion_ts_monitor_lg_solution | motion_ts_monitor draw | motion_ts_monitor_python foo | motion_ts_time_span 0,1
        motion_ts_adapt_type basic | motion_ts_adapt_type cfl | motion_ts_dt 0.0005 | motion_ts_type alpha2 | motion_ts_type bdf
        motion_snes_type ksponly | motion_snes_type ksptransposeonly | motion_snes_type newtontrdc | motion_snes_type newtonls
        motion_snes_type ngmres | motion_snes_convergence_test skip | motion_snes_grid_sequence -1 | motion_snes_monitor_fields
        motion_snes_lag_jacobian 1 | motion_snes_lag_jacobian -2 | motion_snes_max_it 1 | motion_snes_mf | motion_snes_fd
        motion_pc_type mg | motion_pc_type jacobi | motion_pc_type kaczmarz | motion_pc_type lmvm | motion_pc_type svd
        motion_pc_type cholesky | motion_pc_type pfmg | motion_pc_factor_in_place | motion_pc_factor_mat_solver_type foo
        motion_ksp_type gmres | motion_ksp_type symmlq | motion_ksp_type pipelcg | motion_ksp_type lsqr | motion_ksp_view_diagonal_scale
        motion_start_pc_type none | motion_start_ksp_type pipelcg | motion_start_ksp_type gmres
        derivatives_pc_type jacobi | derivatives_ksp_type cg | derivatives_ksp_type pipelcg | derivatives_pc_factor_in_place
        derivatives_pc_factor_mat_ordering_type wbm | derivatives_mat_mumps_icntl_7 1 | derivatives_ksp_diagonal_scale
        estimate_pc_type none | estimate_ksp_type pipelcg | estimate_ksp_type gmres
        motion_ts_view_pre | motion_snes_view_pre ::ascii_info | mesh_mat_partitioning_type foo | mesh_mat_partitioning_nparts 3
        motion_ts_foo 1 | motion_ksp_gmres_restart 5 | campbell_pep_nev 3 | motion_ksp_rtol abc | ranking_ts_dt 0.001""",
    "nlffr": "motion_pc_type mg | motion_pc_type ilu | motion_pc_type gamg | motion_snes_type ksponly | modes_eps_tol 1e-9",
    "static": """
        static_snes_type vinewtonrsls | static_snes_type newtontr | static_snes_type qn | static_pc_type mg | static_pc_type hypre
        static_ksp_type pipelcg | static_snes_max_it -1 | static_snes_monitor_fields | static_snes_linesearch_type shell
        static_snes_linesearch_type bt | static_ksp_type gmres""",
    "modes": """
        modes_eps_hermitian | modes_eps_non_hermitian | modes_eps_gen_hermitian | modes_eps_type lanczos | modes_eps_type arpack
        modes_eps_type lapack | modes_eps_type block-lanczos | modes_eps_largest_real | modes_eps_target nan | modes_eps_mpd 1
        modes_eps_ncv 1 | modes_eps_conv_user | modes_bv_orthog_refine never | modes_rg_complement | modes_st_type shift
        modes_st_type cayley | modes_st_shift nan | modes_st_pc_type redistribute | modes_st_pc_type jacobi
        modes_st_ksp_type pipelcg | modes_st_ksp_type cg | modes_st_matmode shell | motion_ts_dt 0.1 | modes_eps_nve 3""",
    "campbell": """
        campbell_pep_nev 4 | campbell_pep_type qarnoldi | campbell_pep_type jd | campbell_st_type shift | campbell_pep_tol 1e-9
        campbell_pep_foo 1 | campbell_pep_largest_real | campbell_st_pc_type lu""",
}


def execute(floe, command, options):
    """Exit code, or None for a run without an end; the answer, a list of rows; and both outputs."""
    text, words = COMMANDS[command]
    environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = pathlib.Path(name)
        (folder / "scene.yaml").write_text(text)
        try:
            done = subprocess.run([str(floe), *words, *options], cwd=folder, capture_output=True, errors="replace", text=True,
                                  timeout=TIME_LIMIT, env=environment, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            return None, [], ""
        return done.returncode, answer(folder, command, done.stdout), done.stdout + done.stderr


def answer(folder, command, stdout):
    if command == "modes":
        return [[float(word) for word in line.split()[2:4]] for line in stdout.splitlines() if line.startswith("beam")]
    table = folder / "out" / ("campbell.csv" if command == "campbell" else "probes.csv")
    if not table.exists():
        return []
    rows = list(csv.reader(table.read_text().splitlines()))[1:]
    return [[float(word) for word in row if re.fullmatch(r"[-+.\deE]+|-?nan|-?inf", word)] for row in rows]


def off(rows, reference):
    """The greatest difference in a column over its greatest value; infinite where one is no number, or rows are missing."""
    if not rows or [len(row) for row in rows] != [len(row) for row in reference]:
        return math.inf
    sizes = [max(map(abs, column)) or 1 for column in zip(*reference)]
    found = [abs(a - b) / size for row, other in zip(rows, reference) for a, b, size in zip(row, other, sizes)]
    return max(found) if all(map(math.isfinite, found)) else math.inf


def judge(command, option, code, rows, text, reference):
    """Empty, or what is wrong."""
    name = option.split()[0]
    prefix = name[:name.index("_") + 1]
    for phrase in ("PETSC ERROR", "Traceback", "Segmentation", "terminate called", "Sanitizer"):
        if phrase in text:
            return f"{phrase!r} in the output"
    if code is None:
        return f"no end within {TIME_LIMIT} s"
    if code in (1, 2) and command == "campbell" and ACCEPTED & {name, option}:
        return "a documented option is rejected"
    if code in (1, 2):
        return "" if f"-{prefix}" in text else "the message names neither the option nor its prefix"
    if code:
        return f"exit code {code}"
    if OTHERWISE.search(name):
        return "" if rows and all(math.isfinite(x) for row in rows for x in row) else "no rows of finite numbers"
    if FINENESS.search(name):
        rows, reference, allowed = rows[-1:], reference[-1:], 0.05
    else:
        allowed = 1e-5
    wrong = off(rows, reference)
    return "" if wrong <= allowed else f"the answer is off by {wrong:.2g} (limit {allowed})"


def values_of(rest):
    """What an option may be, by what help says of it."""
    for words in ("(choose one of)", "(one of)"):
        if words in rest:
            return rest.split(words)[1].rsplit("(", 1)[0].split()
    if "ascii[" in rest:
        return [""]
    if re.match(r" (binary|draw|socket|saws)\[", rest):
        return []
    if "TRUE" in rest or "FALSE" in rest:
        return ["true", "false"]
    if re.match(r" ?<now -?\d+ :", rest):
        return ["-2", "-1", "0", "1", "3"]
    if re.match(r" ?<now \(null\)", rest):
        return ["foo"]
    return ["-1", "0", "1", "nan", "1e-3"] if re.match(r" ?<-?[\d.e+-]+", rest) else [""]


def listed(floe, command):
    """All that help of the command's solvers lists, with values."""
    sets = {}
    for line in execute(floe, command, ["-help"])[2].splitlines():
        found = re.match(r"\s*-([a-z]\w*)(.*)", line)
        if found and found.group(1).split("_")[0] in PREFIXES:
            for value in values_of(found.group(2)):
                sets[f"{found.group(1)} {value}".strip()] = None
    return list(sets)


def main():
    floe, words = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    everything = words[:1] == ["all"]
    wanted = words[1:] if everything else words
    failed = count = 0
    for command, some in SOME.items():
        code, reference, text = execute(floe, command, [])
        assert code == 0 and reference, f"{command}: {text}"
        sets = listed(floe, command) if everything else [one.strip() for line in some.splitlines() for one in line.split("|")]
        sets = [one for one in sets if one and (not wanted or any(word in one for word in wanted))]
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            runs = pool.map(lambda one, c=command: execute(floe, c, ("-" + one).split()), sets)
            for option, (code, rows, text) in zip(sets, runs):
                count += 1
                fault = judge(command, option, code, rows, text, reference)
                failed += bool(fault)
                if fault:
                    print(f"FAIL {command} -{option}: {fault}\n{text[-1500:] if code else ''}", flush=True)
    print(f"{count} sets of options, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
