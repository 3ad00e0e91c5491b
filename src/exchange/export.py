#!/usr/bin/env python3
"""`floe export`: a reduced body for other programs. The program starts it with its arguments."""
import argparse
import contextlib
import os
import sys

sys.dont_write_bytecode = True
from reduced_body import Fault, damage, open_file, read  # noqa: E402

ENDINGS = {".npz": "npz", ".sid": "sid", ".sid_fem": "sid", ".xml": "mbsim", ".h5mbs": "mbsim-hdf5", ".mtx": "mtx"}
FORMATS = ["npz", "sid", "mbsim", "mbsim-hdf5", "mtx", "exudyn"]


def format_of(options):
    ending = os.path.splitext(options.out)[1].lower()
    chosen = options.format or ENDINGS.get(ending)
    if chosen is None:
        raise Fault(f"--out {options.out}: expected a name that ends in {' '.join(ENDINGS)}, or --format")
    if chosen not in FORMATS:
        raise Fault(f"--format {chosen}: expected one of {', '.join(FORMATS)}")
    for given, name, needs in ((options.shapes, "--shapes", ["npz"]),
                               (options.columns is not None, "--columns", ["sid", "exudyn"]),
                               (options.gyroscopic_columns is not None, "--gyroscopic-columns", ["sid"]),
                               (options.no_geometric_stiffness, "--no-geometric-stiffness", ["sid"])):
        if given and chosen not in needs:
            raise Fault(f"{name}: is of the format {' and '.join(needs)}, not of {chosen}")
    if options.gyroscopic_columns not in (None, "axis", "coordinate"):
        raise Fault(f"--gyroscopic-columns {options.gyroscopic_columns}: expected axis or coordinate")
    if options.columns not in (None, "all", "modes"):
        raise Fault(f"--columns {options.columns}: expected modes or all")
    return chosen


def check_target(path, options):
    if os.path.isdir(path):
        raise Fault(f"--out {path}: is a folder")
    if os.path.exists(path) and not os.path.isfile(path):
        raise Fault(f"--out {path}: is not a regular file")
    if os.path.exists(path) and os.path.samefile(path, options.body):
        raise Fault(f"--out {path}: is the reduced body itself")
    if os.path.exists(path) and not options.force:
        raise Fault(f"--out {path}: exists; --force replaces it")
    folder = os.path.dirname(path) or "."
    if not os.path.isdir(folder):
        raise Fault(f"--out {path}: there is no folder {folder}")


@contextlib.contextmanager
def drafts(paths):
    """Files beside the targets that get their names when all are whole; nothing is left of them after a fault."""
    names = {path: os.path.join(os.path.dirname(path), f".{os.path.basename(path)}.partial") for path in paths}
    try:
        yield names
        for path, draft in names.items():
            os.replace(draft, path)
    except OSError as error:
        for path, draft in names.items():
            if error.errno is not None and error.filename in (None, draft):
                raise OSError(error.errno, os.strerror(error.errno), path) from error
        raise
    finally:
        for draft in names.values():
            with contextlib.suppress(OSError):
                os.remove(draft)


def export(options):
    chosen = format_of(options)
    body = read(options.body)
    targets = [options.out]
    if chosen == "mtx":
        import matrix_market
        stem = options.out[:-4] if options.out.lower().endswith(".mtx") else options.out
        targets = [f"{stem}-{letter}.mtx" for letter in matrix_market.matrices(body)]
    for path in targets:
        check_target(path, options)
    with drafts(targets) as draft, damage(options.body):
        write(chosen, [draft[path] for path in targets], body, options)
    for path in targets:
        print(f"Written: {path}")


def note_rotary(body):
    from inertia_terms import second_order_share
    from reduced_body import in_space
    share = second_order_share(in_space(body))
    if share > 0:
        print("Note: MBSim's format cannot store inertia of second order (Q, W): it is omitted, and W changes 5 % of the "
              f"stiffness at a spin of {(0.05 / share) ** 0.5:.3g} rad/s")
    elif body.Q.any():
        print("Note: MBSim's format cannot store inertia of masses at arms of second order (Q): it is omitted")


def write(chosen, paths, body, options):
    if chosen == "npz":
        import numpy_file
        with open_file(options.body) as source:
            if options.shapes and not source.attrs["shapes"]:
                raise Fault(f"--shapes: {options.body} has none")
            numpy_file.write(paths[0], source, options.shapes)
    elif chosen == "sid":
        import sid
        geometric = not options.no_geometric_stiffness
        if geometric and not len(body.pairs):
            print("Note: the body's elastic force is linear, so its geometric stiffness is zero")
        sid.write(paths[0], body, geometric, options.columns == "all", options.gyroscopic_columns != "coordinate")
    elif chosen == "exudyn":
        import exudyn_file
        with open_file(options.body) as source:
            exudyn_file.write(paths[0], source, body, options.columns == "all")
        if len(body.pairs):
            print("Note: ObjectFFRFreducedOrder has a linear stiffness: the linear body is written")
    elif chosen == "mbsim":
        import mbsim
        mbsim.write_xml(paths[0], body)
        note_rotary(body)
    elif chosen == "mbsim-hdf5":
        import mbsim
        mbsim.write_hdf5(paths[0], body)
        note_rotary(body)
        if len(body.pairs):
            print("Note: MBSim's HDF5 format cannot store nonlinear stiffness: the linear body is written; "
                  "use .xml for the nonlinear one")
    else:
        import matrix_market
        for path, (matrix, what) in zip(paths, matrix_market.matrices(body).values()):
            matrix_market.write(path, matrix, matrix_market.comments(body, what))


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Fault(message)


def read_options():
    parser = Parser(prog="floe export", description=__doc__)
    parser.add_argument("body")
    parser.add_argument("-o", "--out", required=True)
    for name in ("--format", "--columns", "--gyroscopic-columns"):
        parser.add_argument(name)
    for name in ("--shapes", "--no-geometric-stiffness", "--force"):
        parser.add_argument(name, action="store_true")
    return parser.parse_args()


def main():
    """@return  floe's exit codes: 0, 1 the run failed, 2 the input is bad; what went wrong in one line"""
    try:
        export(read_options())
        sys.stdout.flush()
        return 0
    except Fault as fault:
        print(f"floe: export: {fault}", file=sys.stderr)
        return 2
    except ImportError as error:
        print(f"floe: export: {error}; install python3-numpy and python3-h5py", file=sys.stderr)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    except OSError as error:
        print(f"floe: export: cannot read or write {error.filename or 'standard output'}: {error.strerror or error}",
              file=sys.stderr)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what waits for it would be tried again
    return 1


if __name__ == "__main__":
    sys.exit(main())
