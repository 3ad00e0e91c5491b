"""What the offline stage would cost on many ranks: a projection, from counts of a measured run and a model of the network.

Not a measurement. The model, for n dofs on p ranks:
* The factor's tree is that of nested dissection of a surface: level l has 2^l fronts of order s / 2^(l/2), s the order of the
  greatest front, and the share 2^(-l/2) (1 - 2^(-1/2)) of all operations F. p / 2^l ranks share a front above level log2 p; each
  rank has a subtree of its own below.
* A front on q ranks is factored in panels of `panel` columns, in two dimensions: s/panel log2 q messages, and s^2/sqrt(q) log2 q
  numbers to each rank. A solve with r right-hand sides sends 2 s/panel log2 q messages and 2 s r log2 q numbers in each front.
* Work by elements, nodes and columns is shared evenly; a reduction costs 2 log2 p messages and as many times its length.
* A product with M exchanges the nodes on the border of a square part: four messages.
* Rates are those of one rank that were measured: operations a second of the factorisation, seconds a solve.
"""
from math import log, log2, sqrt

LATENCY = 2e-6    # seconds a message
BANDWIDTH = 5e9   # bytes a second and rank
PANEL = 64        # columns
SINGLE, BLOCK = 32, 121   # solves one by one, of ten modes and to measure the factor; in blocks, to purify, and derivatives twice
PRODUCTS = 100            # with M
PER_ELEMENT = ["structure", "assembly", "basis", "projection"]


def exponent(small, large, of):
    return log(of(large) / of(small)) / log(large["dofs"] / small["dofs"])


def model_of(rows):
    """What is needed of the two largest runs on one rank: counts, exponents of their growth, seconds a piece of work."""
    small, large = sorted((row for row in rows if row["ranks"] == 1), key=lambda row: row["dofs"])[-2:]
    cpu = lambda row, name: row[name][1]
    factor = lambda name: lambda row: row["factor"][name]
    single = cpu(large, "bare single solves") / 26
    many = cpu(large, "bare block solve") / 55
    loads = max(0.0, cpu(large, "derivatives") - 2 * cpu(large, "bare block solve"))
    orthogonal = max(0.0, cpu(large, "modes") - SINGLE * single)
    return {
        "dofs": large["dofs"],
        "operations": (large["factor"]["operations"], exponent(small, large, factor("operations"))),
        "entries": (large["factor"]["entries"], exponent(small, large, factor("entries"))),
        "front": (large["factor"]["front"], exponent(small, large, factor("front"))),
        "rate": large["factor"]["operations"] / cpu(large, "bare factorisation"),
        "single": single, "many": many,
        "even": (sum(cpu(large, name) for name in PER_ELEMENT) + loads + orthogonal) / large["dofs"],
        "columns": large["columns"], "numbers": large["columns"] + large["pairs"],
    }


def grown(model, name, dofs):
    value, power = model[name]
    return value * (dofs / model["dofs"]) ** power


def levels(p):
    """Levels of the tree whose fronts are shared, and by how many ranks each."""
    level = 0
    while 2**level < p:
        yield level, p / 2**level
        level += 1


def seconds(model, dofs, p):
    """Factorisation, solves, everything else [s], and entries of the factor on each rank."""
    operations, front = grown(model, "operations", dofs), grown(model, "front", dofs)
    entries = grown(model, "entries", dofs)
    factorisation = operations / p / model["rate"]
    per_entry = entries / model["entries"][0]
    solves = (SINGLE * model["single"] + BLOCK * model["many"]) * per_entry / p
    for level, q in levels(p):
        s = front / 2 ** (level / 2)
        factorisation += s / PANEL * log2(q) * LATENCY + 8 * s * s / sqrt(q) * log2(q) / BANDWIDTH
        batches = SINGLE + BLOCK / 64
        solves += log2(q) * (batches * 2 * s / PANEL * LATENCY + (SINGLE + BLOCK) * 16 * s / BANDWIDTH)
    other = model["even"] * dofs / p
    if p > 1:
        reduce = lambda numbers: 2 * log2(p) * (LATENCY + 8 * numbers / BANDWIDTH)
        halo = 4 * LATENCY + 4 * 8 * sqrt(6 * dofs / p) * sqrt(6) / BANDWIDTH
        other += PRODUCTS * (reduce(29) + halo) + 5 * reduce(model["columns"] ** 2) + reduce(model["numbers"] ** 2)
    return factorisation, solves, other, entries / p


def messages_of(rows):
    """Messages of PETSc on two ranks, without the bare solves; MUMPS' own messages are not counted by it."""
    lines = [f"At {row['dofs']} dofs on two ranks each sent {row['messages']['count']} messages of {1e-6 * row['messages']['bytes']:.1f} MB "
             f"in all through PETSc (-log_view's counts) and took part in {row['messages']['reductions']} of its reductions."
             for row in rows if row["ranks"] == 2]
    return " ".join(lines) or "PETSc's messages were not counted: this requires two ranks."


RANKS = [1, 64, 256, 1024, 4096]


def table(model, dofs_on):
    lines = ["| ranks | dofs | factorisation [s] | solves [s] | other [s] | total [s] | factor per rank [GB] | efficiency |",
             "|" + "---:|" * 8]
    alone = None
    for p in RANKS:
        parts = seconds(model, dofs_on(p), p)
        total, serial = sum(parts[:3]), sum(seconds(model, dofs_on(p), 1)[:3])
        alone = alone or total
        lines.append(f"| {p} | {dofs_on(p):.3g} | {parts[0]:.3g} | {parts[1]:.3g} | {parts[2]:.3g} | {total:.3g} | "
                     f"{8e-9 * parts[3]:.2g} | {100 * serial / total / p:.0f} % |")
    return "\n".join(lines)


def section(rows, per_rank=60000):
    if len([row for row in rows if row["ranks"] == 1]) < 2:
        return "Two sizes on one rank are needed."
    model = model_of(rows)
    growth = ", ".join(f"{name} n^{model[name][1]:.2f}" for name in ("operations", "entries", "front"))
    lines = [
        "This is the projection of a model (`tests/benchmark/offline_projection.py`), not a measurement. Its parameters, measured on one rank "
        f"at {model['dofs']} dofs: {model['operations'][0]:.3g} operations of the factorisation at {model['rate']:.3g} per second, "
        f"{model['entries'][0]:.3g} entries, a maximum front of {model['front'][0]} (growing as {growth} from the previous size), "
        f"{model['single']:.3g} s per single solve, {model['many']:.3g} s per solve in a block, {1e6 * model['even']:.3g} us per dof for everything "
        f"else. Assumed: {1e6 * LATENCY:.0f} us per message, {BANDWIDTH / 1e9:.0f} GB/s per rank, no competition of ranks for memory "
        "bandwidth, a balanced tree, no cost of the analysis on one rank. Efficiency is relative to one rank with enough memory. "
        + messages_of(rows),
        "", f"Strong scaling, {model['dofs']} dofs:", "", table(model, lambda p: model["dofs"]),
        "", f"Weak scaling, {per_rank} dofs per rank (time grows because the factorisation grows faster than n):", "",
        table(model, lambda p: per_rank * p)]
    return "\n".join(lines)
