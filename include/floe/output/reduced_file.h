#pragma once
#include <mpi.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "floe/body/flexible_body.h"
#include "floe/body/pressure.h"

namespace floe::output {

/// What a candidate column of the basis came from, and whether it stayed.
struct ReducedColumn {
  std::string kind;  ///< `mode`, `derivative` or `attachment`
  std::string label;
  double omega = 0;     ///< modes [rad/s]
  double new_part = 1;  ///< share of the scaled column that the columns before it lack
  bool kept = true;
  double interaction = 0;    ///< derivatives chosen by count: modal interaction relative to the maximum
  std::string dropped = {};  ///< attachment modes: why they were no candidates, `repeats tip.fx`
};

/// A named place of the body; of a set of nodes, the mean. psi has one row in the plane, three in space.
struct ReducedPlace {
  std::string name;
  body::PlaceMap map;
};

/// A unit pressure on the shells of a part of the mesh, for k coordinates.
struct ReducedPressure {
  std::string part;
  body::Pressure unit;
};

/// Where the floating frame lies in the mesh: x_mesh = origin + axes x.
struct ReducedFrame {
  std::string kind;
  Eigen::VectorXd origin;  ///< [m]
  Eigen::MatrixXd axes;    ///< orthonormal columns, d x d
};

/// How, when and by what a file was made.
struct MadeBy {
  std::string version, commit, date, command, options;  ///< floe's, UTC in ISO 8601, of the shell, of PETSc
  std::string scene;                                    ///< its whole text
  std::int64_t ranks = 1;
  std::map<std::string, double> seconds;  ///< of each phase
};
/// From provenance(). Rank-local; the same on every rank but for the date's second.
MadeBy made_here(MPI_Comm comm, std::string scene);

/// All that the motion of a reduced body needs, and how it was made. d = 2 or 3, k coordinates of an M-orthonormal
/// basis (q in m kg^1/2).
struct ReducedBodyFile {
  std::string name;
  int dimension = 2;
  std::int64_t dofs = 0, nodes = 0, cells = 0;  ///< of the mesh
  body::FlexibleBody body;
  std::int64_t omitted_products = 0;            ///< of coordinates in the elastic force, beside its pairs
  Eigen::MatrixXd damping;                      ///< of small motions, k x k, or empty for none [1/s]
  double strain_rate_damping = 0;               ///< beta of Kelvin-Voigt [s]; `damping` includes beta K
  std::vector<ReducedPlace> places;             ///< names differ
  std::vector<ReducedPressure> pressures = {};  ///< of the parts with shells; names differ
  std::vector<ReducedColumn> columns;           ///< candidates in order; k are kept
  std::vector<double> omega;                    ///< natural frequencies found [rad/s]
  std::vector<double> residual;                 ///< relative, of each omega
  ReducedFrame frame;
  /// What constrained the modes besides the frame, `fixed at left`; none: of the frame alone, or not in the file.
  std::optional<std::vector<std::string>> held = {};
  MadeBy made;
  bool has_shapes = false;  ///< set by reading
  int version = 5;  ///< of the format: 1 has no Inertia::W, 2 no strain_rate_damping, 3 no Inertia::Q, 4 no PlaceMap::H
};

/// The basis at every node, and the mesh, for pictures and for places that are thought of later: this rank's share.
struct ReducedShapes {
  enum class Kind { vertex = 1, line = 3, triangle = 5, quadrilateral = 9 };  ///< VTK's cell types
  /// An element of the mesh, for pictures.
  struct Cell {
    Kind kind;
    std::int64_t part;                  ///< index of `parts`
    std::array<std::int64_t, 4> nodes;  ///< original numbers; -1 where unused
  };
  std::vector<std::int64_t> nodes;         ///< original numbers; each of 0 ... n-1 on exactly one rank, in any order
  std::vector<Eigen::Vector3d> positions;  ///< of these nodes, in the axes of the floating frame [m]
  std::vector<Cell> cells;                 ///< each on one rank
  std::vector<std::string> parts;          ///< the same on every rank
  std::map<std::string, std::vector<std::int64_t>> sets;  ///< same names on every rank; a set is the union over ranks
  int dofs_per_node = 3;
  /// Fills column j of the basis at these nodes, dofs_per_node numbers each. Called for j = 0 ... k-1 on all ranks
  /// together.
  std::function<void(int j, std::span<double> values)> column;
};

/// Refuses a path that write_reduced_body could not use, before the work is done that fills it: tries by writing.
///
/// @throws InputError  exists and not `overwrite`, is no regular file, cannot be written; one line on every rank
/// Collective; rank 0 alone touches the file system.
void check_reduced_path(MPI_Comm comm, const std::filesystem::path& path, bool overwrite);

/// Writes a reduced body as HDF5, in a draft that gets the name `path` once it is whole, so that no moment and no kill
/// leaves half a file there. `file` the same on every rank; rank 0 writes all but the shapes, which all ranks write
/// together, rows in original order: the file does not depend on the number of ranks.
///
/// Attributes of the file: `format` = "floe reduced body", `version` = 5 (4: without places/H; 3: nor
/// inertia/Q; 2: nor strain_rate_damping; 1: nor inertia/W), `shapes`, `checksum` (FNV-1a of all but the shapes),
/// `complete` = 1. Each dataset has the attributes `unit` and `description` (left out where empty). Arrays are
/// row-major, [a][b] as in body::Inertia; pairs count from 0; shapes/basis is k x nodes x dofs. In NumPy, energy and a
/// place's displacement of coordinates q:
///
///     f = h5py.File("arm.h5"); F = f["elasticity/F"][:]; pairs = f["elasticity/pairs"][:]
///     s = np.array([q[a] * q[b] * (0.5 if a == b else 1) for a, b in pairs])
///     U = 0.5 * q @ f["elasticity/bending"][:] @ q + 0.5 * np.sum((F @ np.r_[q, s])**2)
///     place = list(f["places/names"].asstr()).index("tip")
///     u = f["places/S"][place] @ q
///     if "places/Q" in f: u += 0.5 * q @ f["places/Q"][place] @ q     # places at arms
///     b = f["places/psi"][place] @ q                                  # its rotation vector
///     if "places/H" in f: b = b + 0.5 * b @ f["places/H"][place] @ b  # places that rotate by displacements
///
/// @throws InputError  `path` exists and not `overwrite`, or is no regular file
/// @throws RunError    path and reason; a number that is not finite, sizes that do not fit. Nothing is left, and
///                     what was there is as it was
/// Collective. With shapes one column more in memory than the caller has.
void write_reduced_body(MPI_Comm comm, const std::filesystem::path& path, const ReducedBodyFile& file, bool overwrite,
                        const ReducedShapes* shapes = nullptr);

/// Reads what write_reduced_body wrote, to the bit; the same on every rank. Shapes stay in the file.
///
/// @throws InputError  one line on every rank: the file, and the dataset with what was expected of it; also of files of
///                     another kind or version, cut off, incomplete or damaged
/// Collective; rank 0 reads.
ReducedBodyFile read_reduced_body(MPI_Comm comm, const std::filesystem::path& path);

/// A node of the shapes in a file.
struct ReducedNode {
  std::int64_t number = 0;  ///< original
  double distance = 0;      ///< from the point asked for [m]
  double extent = 0;        ///< diagonal of the box around all nodes [m]
  body::PlaceMap map;
};
/// The node nearest to a point, of equally near ones the first, with its rows of the basis.
///
/// @param file  what read_reduced_body gave of `path`, with shapes
/// @param x     d, in the axes of the floating frame
/// @throws InputError  as read_reduced_body. Collective; rank 0 reads all positions and one node's rows.
ReducedNode nearest_node(MPI_Comm comm, const std::filesystem::path& path, const ReducedBodyFile& file,
                         const Eigen::VectorXd& x);

/// Bytes that the motion needs of the body: its constants, without work space.
std::int64_t online_bytes(const ReducedBodyFile& file);

/// What the file holds, for a terminal: sizes, frame, frequencies in Hz, columns, places, how it was made.
std::string describe(const ReducedBodyFile& file);

}  // namespace floe::output
