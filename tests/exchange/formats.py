"""Each format of `floe export`, read back and held against physics: formats.py FLOE."""
import pathlib
import sys
import tempfile

import h5py
import numpy as np

import readers
from bodies import Truth, close, floe, frequencies, make

FLOE = pathlib.Path(sys.argv[1]).resolve()
rng = np.random.default_rng(20)


def export(folder, body, ending, *words):
    target = folder / f"{body}{ending}"
    floe(FLOE, folder, "export", f"{body}.h5", "-o", target.name, "--force", *words)
    return target


def modes_of(truth):
    return [i for i, kind in enumerate(truth.kinds) if kind != "derivative"]


def small(truth):
    """Coordinates that move the body by a few hundredths of a length."""
    return 0.05 * rng.standard_normal(truth.k) * np.sqrt(truth.m)


def numpy_is_the_file(folder):
    for name in ("cantilever", "plate"):
        truth = Truth(folder / f"{name}.h5")
        with np.load(export(folder, name, ".npz", "--shapes"), allow_pickle=False) as found:
            same = {"C0": "inertia/C0", "s0": "inertia/s0", "S": "inertia/S", "h": "inertia/h", "M": "inertia/M",
                    "m": "inertia/m", "bending": "elasticity/bending", "F": "elasticity/F", "pairs": "elasticity/pairs",
                    "damping": "damping", "strain_rate_damping": "strain_rate_damping", "place_x": "places/x", "place_S": "places/S", "place_psi": "places/psi",
                    "omega": "frequencies/omega", "frame_origin": "frame/origin", "frame_axes": "frame/axes",
                    "line_S": "line/S", "column_kept": "columns/kept", "shape_basis": "shapes/basis",
                    "shape_positions": "shapes/positions", "cell_nodes": "shapes/cells/nodes"}
            for ours, theirs in same.items():
                expected = truth.file[theirs][()]
                assert found[ours].dtype == expected.dtype and np.array_equal(found[ours], expected), ours
            assert list(found["place_names"]) == truth.places and found["name"] == (
                "beam" if name == "cantilever" else name)
            assert list(found["coordinate_kind"]) == truth.kinds
            close(found["stiffness"], truth.stiffness(), 1e-13, "stiffness")
            close(found["mass"], np.eye(truth.k), 1e-10, "mass of an M-orthonormal basis")
        with np.load(export(folder, name, ".npz")) as found:
            assert "shape_basis" not in found and not np.any(found["W"])
    with np.load(export(folder, "blade", ".npz")) as found:
        assert np.array_equal(found["W"], Truth(folder / "blade.h5").file["inertia/W"][()])


def matrices_give_the_frequencies(folder):
    truth = Truth(folder / "cantilever.h5")
    export(folder, "cantilever", ".mtx")
    K, M = (readers.matrix_market(folder / f"cantilever-{letter}.mtx") for letter in "KM")
    assert not (folder / "cantilever-C.mtx").exists()
    count = len(truth.omega)
    close(frequencies(K, M)[:count], truth.omega, 1e-8, "frequencies of a clamped beam in its clamped frame")
    truth = Truth(folder / "plate.h5")
    export(folder, "plate", ".mtx")
    close(readers.matrix_market(folder / "plate-C.mtx"), truth.damping, 1e-15, "damping")


def sid_holds_the_inertia(folder):
    for name in ("blade", "cantilever", "pinned", "plate"):
        truth = Truth(folder / f"{name}.h5")
        assert np.any(truth.W) == (name == "blade")
        sid = readers.Sid(export(folder, name, ".sid", "--columns", "all", "--no-geometric-stiffness"))
        assert abs(sid.mass - truth.m) <= 1e-15 * truth.m
        zero, e = np.zeros(truth.k), rng.standard_normal(truth.k)
        slope = (truth.mass_matrix(e) - truth.mass_matrix(-e)) / 2
        close(sid_mass(sid, zero), truth.mass_matrix(zero), 1e-12, "mass matrix")
        close(sid_mass(sid, e) - sid_mass(sid, zero), slope, 1e-11, "its first order")
        for _ in range(3):
            omega, rate = rng.standard_normal(3), rng.standard_normal(truth.k)
            velocity = truth.quadratic(zero, omega, rate)
            velocity[3:6] -= truth.rotary(rate, rate)  # of second order in the rates: SID has none
            close(sid_quadratic(sid, zero, omega, rate), velocity, 1e-11, "velocity terms")
            spin = (truth.quadratic(e, omega, zero) - truth.quadratic(-e, omega, zero)) / 2
            found = sid_quadratic(sid, e, omega, zero) - sid_quadratic(sid, zero, omega, zero)
            close(found, spin, 1e-11, "centrifugal terms of first order")
        other = readers.Sid(export(folder, name, ".sid", "--columns", "all", "--no-geometric-stiffness",
                                   "--gyroscopic-columns", "coordinate"))
        close(sid_quadratic(other, e, omega, rate, False), sid_quadratic(sid, e, omega, rate), 1e-14, "other columns")
        genuine_files_satisfy(sid)
        close(sid.terms["Ke"].m0, truth.stiffness(), 1e-13, "Ke")
        close(sid.terms["De"].m0, truth.damping if truth.damping.size else np.zeros((truth.k,) * 2), 1e-13, "De")
        assert not np.any(sid.terms["ksigma"].m0)
        for i, node in enumerate(sid.nodes.values()):
            close(node["origin"].at(e)[:, 0], truth.x[i] + truth.S[i] @ e, 1e-13, "origin")
            close(node["phi"].m0, truth.S[i], 1e-13, "phi")
            close(node["psi"].m0, truth.psi[i], 1e-13, "psi")
            v, turn = rng.standard_normal(3), truth.psi[i] @ e
            close(node["AP"].at(e) @ v, v + np.cross(turn, v), 1e-13, "AP")


def genuine_files_satisfy(sid):
    """J1 = sym(Gr) and Ge = 2 Cr1, as files of FEMBS do with the columns of an axis together."""
    k = sid.mode_count
    Gr = sid.terms["Gr"].m0.reshape(3, 3, k)
    J1 = np.stack([six_as_matrix(sid.terms["J"].m1[:, j, 0]) for j in range(k)], axis=2)
    close((Gr + Gr.transpose(1, 0, 2)) / 2, J1, 1e-12, "J1 = sym(Gr)")
    Cr1 = sid.terms["Cr"].m1
    gyroscopic = (Cr1 - Cr1.transpose(1, 0, 2)) / 2  # without rotary inertia of second order, which is symmetric
    close(sid.terms["Ge"].m0.reshape(k, 3, k), 2 * gyroscopic.transpose(0, 2, 1), 1e-12, "Ge = 2 Cr1")


def tilde(v):
    return np.cross(np.eye(3), v)


def six_as_matrix(six):
    xx, yy, zz, xy, xz, yz = six
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def sid_J(sid, q):
    return six_as_matrix(sid.terms["J"].at(q)[:, 0])


def sid_mass(sid, q):
    c, Ct, Cr = sid.terms["mdCM"].at(q)[:, 0], sid.terms["Ct"].at(q), sid.terms["Cr"].at(q)
    return np.block([[sid.mass * np.eye(3), tilde(c).T, Ct.T], [tilde(c), sid_J(sid, q), Cr.T],
                     [Ct, Cr, sid.terms["Me"].at(q)]])


def sid_quadratic(sid, q, omega, rate, axis_first=True):
    k = sid.mode_count
    c, Ct = sid.terms["mdCM"].at(q)[:, 0], sid.terms["Ct"].at(q)
    x, y, z = omega
    Gr, Ge = sid.terms["Gr"].at(q).reshape(3, -1), sid.terms["Ge"].at(q).reshape(k, -1)
    if axis_first:  # all coordinates of an axis together
        Gr, Ge = (np.einsum("abj,j->ab", each.reshape(len(each), 3, k), rate) for each in (Gr, Ge))
    else:
        Gr, Ge = (np.einsum("ajb,j->ab", each.reshape(len(each), k, 3), rate) for each in (Gr, Ge))
    return np.concatenate([
        2 * np.cross(omega, Ct.T @ rate) + np.cross(omega, np.cross(omega, c)),
        Gr @ omega + np.cross(omega, sid_J(sid, q) @ omega),
        Ge @ omega + sid.terms["Oe"].at(q) @ [x * x, y * y, z * z, x * y, y * z, z * x]])


def sid_closed_forms(folder):
    """A uniform cantilever about its root: m = 1, first moment 1/2, J = 1/3 about y and z."""
    sid = readers.Sid(export(folder, "cantilever", ".SID_FEM"))
    assert sid.mode_count == 5
    close(sid.mass, 1, 1e-12, "mass")
    close(sid.terms["mdCM"].m0[:, 0], [0.5, 0, 0], 1e-12, "mdCM")
    close(sid_J(sid, np.zeros(5)), np.diag([0, 1 / 3, 1 / 3]), 1e-6, "J")  # the section's rotary inertia: r^2 = 1e-6
    beta = np.array([3.5160152685, 22.034491565, 61.697214414])
    close(frequencies(sid.terms["Ke"].m0, sid.terms["Me"].m0)[:3], beta, 1e-4, "frequencies of a cantilever")
    close(sid.modes[:3], beta / (2 * np.pi), 1e-4, "frequencies in refmod")


def geometric_stiffness_is_that_of_the_energy(folder):
    """Of a load along a straight beam, on all columns: the change of the Hessian along the static answer to it."""
    truth = Truth(folder / "cantilever.h5")
    sid = readers.Sid(export(folder, "cantilever", ".sid", "--columns", "all"))
    plain = readers.Sid(export(folder, "cantilever", ".sid", "--columns", "all", "--no-geometric-stiffness"))
    added = {name: sid.terms[name].m1 - plain.terms[name].m1 for name in ("Ct", "Cr", "Oe")}

    def expected(load):
        q = np.linalg.solve(truth.stiffness(), load)
        return (truth.stiffness(q) - truth.stiffness(-q)) / 2

    close(added["Ct"][:, :, 0], expected(-sid.terms["Ct"].m0[:, 0]), 1e-9, "Ct1, along x")
    close(added["Oe"][:, :, 2], expected(-sid.terms["Oe"].m0[:, 2]), 1e-9, "Oe1, about z")
    tip = list(sid.nodes)[truth.places.index("end")]
    close(sid.nodes[tip]["phi"].m1[0], expected(-truth.S[truth.places.index("end")][0]), 1e-9, "phi1 of the end")
    # Loads across a straight beam do not stretch it.
    size = np.abs(added["Ct"][:, :, 0]).max()
    for stiffness in (added["Ct"][:, :, 1:], added["Cr"], sid.nodes[tip]["phi"].m1[1:]):
        assert np.abs(stiffness).max() < 1e-9 * size


FLAP = {2: [4.1373196, 22.6149220, 62.2731841], 6: [7.3603730, 26.8090817, 66.6839144],
        12: [13.1701505, 37.6031123, 79.6144785]}  # independent solution of the rotating beam's equation, hub radius 0


def spinning(sid, speed):
    """Relative errors of three frequencies in the plane of rotation without Coriolis terms: flap^2 - speed^2."""
    stiffness = sid.terms["Ke"].m0 + speed**2 * sid.terms["Oe"].m1[:, :, 2]
    found = frequencies((stiffness + stiffness.T) / 2, sid.terms["Me"].m0)[:3]
    return np.abs(found / np.sqrt(np.square(FLAP[speed]) - speed**2) - 1)


def a_spinning_cantilever_stiffens(folder):
    for columns in ("modes", "all"):
        sid = readers.Sid(export(folder, "cantilever", ".sid", "--columns", columns))
        for speed in (2, 6):
            assert np.max(spinning(sid, speed)) < 1e-3, (columns, speed, spinning(sid, speed))
    fine = readers.Sid(export(folder, "fine", ".sid"))
    coarse, finer = spinning(readers.Sid(export(folder, "cantilever", ".sid")), 12), spinning(fine, 12)
    assert np.max(finer) < 1e-3 and np.all(finer < 0.5 * coarse), (coarse, finer)  # few modes cannot follow 12 so well
    bare = readers.Sid(export(folder, "cantilever", ".sid", "--no-geometric-stiffness"))
    soft = bare.terms["Ke"].m0 + 6**2 * bare.terms["Oe"].m1[:, :, 2]
    assert np.linalg.eigvalsh((soft + soft.T) / 2)[0] < 0  # a linear body is unstable beyond its first frequency
    assert np.linalg.eigvalsh(bare.terms["Ke"].m0 + 3.5**2 * bare.terms["Oe"].m1[:, :, 2])[0] > 0  # and not below it


def a_pressed_cantilever_buckles(folder):
    """Euler: P = pi^2/4 at the free end."""
    truth = Truth(folder / "cantilever.h5")
    sid = readers.Sid(export(folder, "cantilever", ".sid"))
    tip = sid.nodes[truth.places.index("end") + 1]["phi"].m1[0]  # a unit force along x adds tip @ q to the forces
    K = sid.terms["Ke"].m0
    loads = 1 / np.linalg.eigvals(np.linalg.solve(K, -tip)).real
    found = min(load for load in loads if load > 0)
    close(found, np.pi**2 / 4, 1e-3, "buckling load")


def exudyn_has_the_inertia(folder):
    """Sums over the point masses of the body, as Exudyn makes them of a mesh, in place of its integrals."""
    for name in ("cantilever", "plate", "blade"):
        truth = Truth(folder / f"{name}.h5")
        with np.load(export(folder, name, ".npz", "--format", "exudyn", "--columns", "all")) as found:
            k, n = truth.k, len(truth.one)
            root = truth.one  # of each point's mass
            Psi = np.concatenate([truth.N[p] for p in range(n)])  # times the root of the mass, 3n x k
            skews = np.concatenate([np.concatenate([tilde(truth.N[p, :, j]) for j in range(k)], axis=1)
                                    for p in range(n)])
            x = np.concatenate([tilde(truth.place[p]) for p in range(n)])
            one = np.concatenate([np.eye(3) * root[p] for p in range(n)])
            for key, expected in (("mPsiTildePsi", skews.T @ Psi), ("mPsiTildePsiTilde", skews.T @ skews),
                                  ("mPhitTPsi", one.T @ Psi), ("mPhitTPsiTilde", one.T @ skews),
                                  ("mXRefTildePsi", x.T @ Psi), ("mXRefTildePsiTilde", x.T @ skews),
                                  ("physicsInertia", x.T @ x)):
                close(found[key], expected, 1e-11, key)
            close(found["physicsCenterOfMass"] * found["physicsMass"], truth.place.T @ root, 1e-12, "centre of mass")
            close(found["stiffnessMatrixReduced"], truth.stiffness(), 1e-13, "stiffness")
            nodes = found["referencePositions"].reshape(-1, 3)
            modes = found["modeBasis"].reshape(len(nodes), 3, k)
            place = "p3" if name == "plate" else "end"
            i = truth.places.index(place)
            node = found["placeNodes"][i]
            close(nodes[node], truth.x[i], 1e-12, f"position of {place}")
            close(modes[node], truth.S[i], 1e-9, f"modes at {place}")


def exudyn_loads_it(folder):
    """The shipped script, against a stand-in for Exudyn's interface that takes what the real one documents."""
    import types
    made = []

    class Matrix:
        def SetWithDenseMatrix(self, matrix, useDenseMatrix):
            self.matrix = np.array(matrix)

    def ffrf(**words):
        assert set(words) == {"nodeNumbers", "massMatrixReduced", "stiffnessMatrixReduced", "dampingMatrixReduced",
                              "modeBasis", "referencePositions", "physicsMass", "physicsInertia", "physicsCenterOfMass",
                              "mPsiTildePsi", "mPsiTildePsiTilde", "mPhitTPsi", "mPhitTPsiTilde", "mXRefTildePsi",
                              "mXRefTildePsiTilde"}, words
        return words

    exudyn = types.ModuleType("exudyn")
    exudyn.MatrixContainer = Matrix
    exudyn.itemInterface = types.ModuleType("exudyn.itemInterface")
    exudyn.itemInterface.NodeRigidBodyEP = exudyn.itemInterface.NodeGenericODE2 = dict
    exudyn.itemInterface.ObjectFFRFreducedOrder = ffrf
    exudyn.rigidBodyUtilities = types.ModuleType("exudyn.rigidBodyUtilities")
    exudyn.rigidBodyUtilities.AngularVelocity2EulerParameters_t = lambda omega, turn: [0, *omega]
    exudyn.rigidBodyUtilities.RotationMatrix2EulerParameters = lambda rotation: [1, 0, 0, 0]
    mbs = types.SimpleNamespace(AddNode=lambda node: made.append(node) or len(made) - 1,
                                AddObject=lambda body: made.append(body) or 0)
    names = ("exudyn", "exudyn.itemInterface", "exudyn.rigidBodyUtilities")
    sys.modules.update(zip(names, (exudyn, exudyn.itemInterface, exudyn.rigidBodyUtilities)))
    scripts = pathlib.Path(__file__).resolve().parents[2] / "src" / "exchange"
    sys.path.insert(0, str(scripts))
    try:
        import load_in_exudyn
        path = export(folder, "plate", ".npz", "--format", "exudyn")
        number, places = load_in_exudyn.add_body(mbs, str(path), position=(1, 2, 3), angular_velocity=(0, 0, 5))
    finally:
        sys.path.remove(str(scripts))
        for name in names:
            del sys.modules[name]
    truth = Truth(folder / "plate.h5")
    assert number == 0 and set(places) == set(truth.places)
    frame, elastic, body = made
    assert frame["referenceCoordinates"] == [1, 2, 3, 1, 0, 0, 0] and frame["initialVelocities"][-1] == 5
    k = len(modes_of(truth))
    assert elastic["numberOfODE2Coordinates"] == k and body["nodeNumbers"] == [0, 1]
    close(body["massMatrixReduced"].matrix, np.eye(k), 1e-10, "mass")


def mbsim_has_the_energy(folder):
    for name in ("cantilever", "pinned", "plate"):
        truth = Truth(folder / f"{name}.h5")
        body = readers.mbsim(export(folder, name, ".xml"))
        K = body["stiffnessMatrix"]
        Knl1, Knl2 = (body[f"nonlinearStiffnessMatrixOf{order}OrderArray"] for order in ("First", "Second"))
        close(K, truth.stiffness(), 1e-13, "stiffness matrix")
        for _ in range(5):
            q = small(truth)
            # MBSim's force: (K + sum q_i (Knl1_i' + 1/2 Knl1_i) + 1/2 sum q_i q_j Knl2_ij) q
            cubic = np.einsum("iba,i,b->a", Knl1, q, q) + 0.5 * np.einsum("iab,i,b->a", Knl1, q, q)
            quartic = 0.5 * np.einsum("ijab,i,j,b->a", Knl2, q, q, q)
            energy = q @ (K @ q / 2 + cubic / 3 + quartic / 4)  # of homogeneous forces
            close(energy, truth.energy(q), 1e-9, "energy")
            force = np.array([directional(truth, q, e) for e in np.eye(truth.k)])
            close(K @ q + cubic + quartic, force, 1e-8, "force")
        inertia_is_that_of_the_points(truth, body)
        assert body["frames"] == {place: i + 1 for i, place in enumerate(truth.places)}
        close(body["nodeNumbers"], np.arange(1, len(truth.places) + 1), 0)
        close(body["nodalRelativePositionArray"], truth.x, 0)
        close(body["nodalShapeMatrixOfTranslationArray"], truth.S, 0)
        close(body["nodalShapeMatrixOfRotationArray"], truth.psi, 0)
        axes = body["stateDependentTranslation"].split("}")[1], body["stateDependentRotation"].split("}")[1]
        assert axes == (("TranslationAlongAxesXY", "RotationAboutZAxis") if truth.d == 2 else
                        ("TranslationAlongAxesXYZ", "RotationAboutAxesXYZ"))


def mbsim_says_what_it_leaves_out(folder):
    for ending in (".xml", ".h5mbs"):
        for name in ("blade", "plate"):
            said = floe(FLOE, folder, "export", f"{name}.h5", "-o", f"said{ending}", "--force")
            assert ("inertia of second order" in said) == (name == "blade"), said


def directional(truth, q, e):
    """dU/dq.e: by two central differences, whose error of fourth order a quartic does not have."""
    size = np.linalg.norm(q)
    near, far = ((truth.energy(q + h * e) - truth.energy(q - h * e)) / (2 * h) for h in (size, 2 * size))
    return (4 * near - far) / 3


def inertia_is_that_of_the_points(truth, body):
    close(body["mass"], truth.one @ truth.one, 1e-12, "mass")
    close(body["positionIntegral"], truth.one @ truth.place, 1e-12, "position integral")
    close(body["positionPositionIntegral"], truth.place.T @ truth.place, 1e-12, "position position integral")
    close(body["shapeFunctionIntegral"], np.einsum("p,pai->ai", truth.one, truth.N), 1e-12, "shape function integral")
    close(body["positionShapeFunctionIntegralArray"], np.einsum("pa,pbi->abi", truth.place, truth.N), 1e-12, "x N")
    close(body["shapeFunctionShapeFunctionIntegralArray"], np.einsum("pai,pbj->abij", truth.N, truth.N), 1e-12, "N N")


def mbsim_hdf5_is_the_linear_body(folder):
    for name in ("pinned", "plate"):
        truth = Truth(folder / f"{name}.h5")
        k, n = truth.k, len(truth.places)
        with h5py.File(export(folder, name, ".h5mbs"), "r") as file:
            found = {name: each[()] for name, each in file.items()}
        order = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]  # of the importer
        pairs = found.pop("shape function shape function integral").reshape(6, k, k)
        M = np.zeros((3, 3, k, k))
        for (a, b), block in zip(order, pairs):
            M[a, b], M[b, a] = block, block.T
        body = {"mass": found.pop("mass"), "shapeFunctionShapeFunctionIntegralArray": M,
                "positionShapeFunctionIntegralArray": found.pop("position shape function integral").reshape(3, 3, k)}
        for name in ("positionIntegral", "positionPositionIntegral", "shapeFunctionIntegral"):
            words = "".join(" " + c.lower() if c.isupper() else c for c in name)
            body[name] = found.pop(words)
        inertia_is_that_of_the_points(truth, body)
        close(found.pop("stiffness matrix"), truth.stiffness(), 1e-13, "stiffness")
        if truth.damping.size:
            close(found.pop("damping matrix"), truth.damping, 0, "damping")
        close(found.pop("node numbers"), np.arange(1, n + 1), 0)
        close(found.pop("nodal relative position").reshape(n, 3), truth.x, 0)
        close(found.pop("nodal shape matrix of translation").reshape(n, 3, k), truth.S, 0)
        close(found.pop("nodal shape matrix of rotation").reshape(n, 3, k), truth.psi, 0)
        assert not found


def mbsim_hdf5_is_read_in_the_order_of_creation(folder):
    """As MBSim's reader does (hdf5serie: H5_INDEX_CRT_ORDER), for links and attributes; without that index HDF5 refuses."""
    path = export(folder, "plate", ".h5mbs")
    with h5py.File(path, "r") as file:
        names, by = [], h5py.h5.INDEX_CRT_ORDER
        file.id.links.iterate(lambda name: names.append(name.decode()), idx_type=by, order=h5py.h5.ITER_INC)
        assert names[:3] == ["mass", "position integral", "position position integral"], names
        assert len(names) == len(file) and sorted(names) != names
        for each in (file["/"], *file.values()):
            h5py.h5a.iterate(each.id, lambda name: None, index_type=by, order=h5py.h5.ITER_INC)
            lists = each.id.get_create_plist()
            assert lists.get_attr_creation_order() == h5py.h5p.CRT_ORDER_TRACKED | h5py.h5p.CRT_ORDER_INDEXED
    with h5py.File(folder / "plain.h5", "w") as file:  # the test's own reader needs it
        file["a"] = 1
        try:
            file.id.links.iterate(lambda name: None, idx_type=by, order=h5py.h5.ITER_INC)
        except RuntimeError as error:
            assert "no creation order index to query" in str(error), error
        else:
            raise AssertionError("read a file without the order of creation")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make(FLOE, folder)
        for test in (numpy_is_the_file, matrices_give_the_frequencies, sid_holds_the_inertia, sid_closed_forms,
                     geometric_stiffness_is_that_of_the_energy, a_spinning_cantilever_stiffens,
                     a_pressed_cantilever_buckles, exudyn_has_the_inertia, exudyn_loads_it, mbsim_has_the_energy, mbsim_says_what_it_leaves_out, mbsim_hdf5_is_the_linear_body,
                     mbsim_hdf5_is_read_in_the_order_of_creation):
            test(folder)
            print(f"passed: {test.__name__}")


if __name__ == "__main__":
    main()
