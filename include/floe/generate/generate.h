#pragma once
#include <functional>

#include "floe/mesh/raw_mesh.h"

namespace floe::generate {
using namespace mesh;

// Meshes without a file. Every rank makes its own share only, without communication; what a node or a cell is follows
// from its number, which does not depend on the number of ranks. Arguments are the same on all ranks. Labels are the
// numbers, from 1. All throw InputError, the same on every rank, for arguments that make no mesh (counts below 1,
// lengths of 0, parallel edges, NaN) and for more nodes or elements than PetscInt counts.

/// Straight lines between points in space; several may meet in a point.
struct Polyline {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 2>> segments;  ///< indices of points; empty: each point with the next
  std::vector<PetscInt> elements;            ///< of each segment
  std::vector<std::string> parts;            ///< of each segment; equal names make one part. Empty: all are "line"
};

/// Lines of equal length in each segment. Nodes are numbered along the segments, points where they are first met (as
/// fem::mesh_of(Segments) does). Places: p1, p2, ... (the points), start, end (the first and the last point).
RawMesh polyline(MPI_Comm comm, const Polyline& lines);

enum class ShellCells { triangles, quadrilaterals };

/// The diagonal that cuts a cell into triangles: from its lower right to its upper left corner (left), from its lower
/// left to its upper right one (right), either in turn as on a chessboard, or both with a node where they cross.
enum class Diagonals { left, right, alternating, crossed };

/// A parallelogram x = origin + s a + t b, 0 <= s, t <= 1; normals along a x b.
struct Plate {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), a, b;
  PetscInt na = 0, nb = 0;  ///< elements of the grid along a and b
  ShellCells cells = ShellCells::triangles;
  Diagonals diagonals = Diagonals::right;  ///< of triangles
  double grading_a = 1, grading_b = 1;     ///< length of the last element over that of the first; geometric between
};

/// Nodes row by row along a. Part "plate". Places: left (s = 0), right (s = 1), bottom (t = 0), top (t = 1), corners
/// p1 ... p4 around the plate from the origin along a, and centre where there is a node.
RawMesh plate(MPI_Comm comm, const Plate& plate);

/// A plate that becomes a part of that name.
struct NamedPlate {
  std::string name;
  Plate plate;
};

/// Plates that have edges or corners in common; any number may meet at an edge.
///
/// Corners within 1e-9 of the longest edge are one, edges between the same corners too. Parts: the names. Places:
/// those of plate(), as "name.left". Plates that meet elsewhere than at their edges are not joined.
/// @throws InputError  edges in common with other numbers of elements or another grading, a corner inside the edge of
///   another plate, a plate twice: both names are told
RawMesh folded_plates(MPI_Comm comm, const std::vector<NamedPlate>& plates);

/// A grid that a map carries into space: x = position(u, v), 0 <= u, v <= 1; normals along dx/du x dx/dv.
struct MappedGrid {
  PetscInt nu = 0, nv = 0;
  std::function<Eigen::Vector3d(double u, double v)> position;
  bool closed_u = false;                       ///< position(0, v) = position(1, v): a tube
  bool pole_bottom = false, pole_top = false;  ///< v = 0, v = 1 is one point, with triangles around it
  ShellCells cells = ShellCells::triangles;
  Diagonals diagonals = Diagonals::right;
  std::string part = "shell";
};

/// Nodes row by row along u, at equal steps of u and v. Places: bottom (v = 0), top (v = 1); where u is not closed also
/// left (u = 0), right (u = 1) and, without poles, corners p1 ... p4.
/// @throws InputError  also where the map does not close, has no pole or gives no numbers
/// Collective.
RawMesh shell_of(MPI_Comm comm, const MappedGrid& grid);

enum class LatticeDiagonals { none, faces, all };  ///< all: of the faces of the cells and through the cells

/// Beams along the edges of nx by ny by nz boxes.
struct Lattice {
  PetscInt nx = 0, ny = 0, nz = 0;
  Eigen::Vector3d cell;  ///< size of a box
  LatticeDiagonals diagonals = LatticeDiagonals::none;
};

/// From the origin into positive x, y, z; nodes by x, then y, then z; diagonals cross without a node. Parts "struts"
/// and, with diagonals, "diagonals". Places: faces xmin, xmax, ymin, ...; corners p1 ... p4 around zmin from the origin
/// along x, p5 ... p8 above them.
RawMesh lattice(MPI_Comm comm, const Lattice& lattice);

/// All positions times a factor > 0.
RawMesh scaled(RawMesh mesh, double factor);

/// All parts and places with a prefix to their names.
RawMesh prefixed(RawMesh mesh, const std::string& prefix);

/// Sets of nodes, by the names of places or parts of two meshes, whose nodes are joined where they coincide.
struct Seam {
  std::string of_first, of_second;
};

/// Both meshes in one: a node of the second in a seam becomes the nearest one of the first in it within `tolerance`.
///
/// Nodes and elements of the first come first; labels are anew the numbers from 1. Parts and places of equal names are
/// united. Positions meet in a hashed grid spread over the ranks: no rank holds a whole seam.
/// @throws InputError  names that are unknown, a seam that joins nothing, two nodes that would become one
/// Collective.
RawMesh merged(const RawMesh& first, const RawMesh& second, const std::vector<Seam>& seams, double tolerance);

}  // namespace floe::generate
