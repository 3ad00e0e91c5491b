#pragma once
#include <algorithm>
#include <array>
#include <functional>

#include "floe/fem/flat_body.h"
#include "floe/fem/piece_rows.h"

namespace floe::fem {

/// Columns [begin, end), the others being zero.
struct ColumnRange {
  int begin = 0, end = 0;
  bool empty() const { return begin >= end; }
  void include(const ColumnRange& other) {
    if (other.empty()) return;
    *this = empty() ? other : ColumnRange{std::min(begin, other.begin), std::max(end, other.end)};
  }
};

/// For each dof of a node the columns that are not zero there at any node: bending modes and in-plane columns of a flat
/// shell have little in common.
using DofRanges = std::array<ColumnRange, 6>;

/// Rank-local copy of fields, in the plane's axes where the body is flat (flat_body), in body axes else. Collective.
FieldRows gather(const Structure& structure, const std::vector<petsc::VecHandle>& fields);
/// The same where `local(j, values)` writes the local values of field j, in body axes.
FieldRows gather(const Structure& structure, Eigen::Index count,
                 const std::function<void(Eigen::Index, double*)>& local);
/// Calls with (j, values of field j at the local dofs, in body axes), in order.
void for_each_field(const Structure& structure, const FieldRows& fields,
                    const std::function<void(Eigen::Index, const double*)>& use);
/// column j of `sums` += contributions of all ranks. @param sums  MATDENSE, dofs x columns. Collective.
void add(const Structure& structure, const FieldRows& local, Mat sums);
/// The same on all ranks. Collective.
DofRanges dof_ranges(const Structure& structure, const FieldRows& fields);

/// out (rows x fields.cols(), by rows) = rows * fields at the dofs of the piece, zero outside the range that is
/// returned. Zero entries of rows and columns outside the ranges cost nothing.
ColumnRange multiply(const Structure& structure, const PieceRows& piece, const Eigen::Ref<const SmallRows>& rows,
                     const FieldRows& fields, const DofRanges& ranges, double* out);

/// Fields at the dofs of a piece, less the rigid motion of its first node that has all dofs (take_rigid_motion), for
/// rows that do not see rigid motions but for round-off.
struct Strained {
  FieldRows rows;     ///< dofs x columns
  int reference = 0;  ///< that node
  DofRanges ranges;   ///< of each dof of a node
};
/// Fills `strained`; its memory is used again.
void take_strained(const Structure& structure, const PieceRows& piece, const FieldRows& fields, const DofRanges& ranges,
                   Strained& strained);
/// out = rows * strained, as above.
ColumnRange multiply(const Eigen::Ref<const SmallRows>& rows, const Strained& strained, int dofs_per_node, double* out);

/// fields at the dofs of the piece += rows' * in, in = rows x fields.cols() by rows.
void add_transposed(const Structure& structure, const PieceRows& piece, const SmallRows& rows, const double* in,
                    FieldRows& fields);

/// out += c in, n numbers; several at a time where the processor can.
void add_multiple(double c, const double* in, double* out, int n);

/// -(dK/deta_j) phi_i for many pairs (i, j) of fields in one pass over the elements: a column of a dense matrix each.
/// Collective. Memory: fields and results once more on every rank, with foreign nodes.
petsc::MatHandle derivative_loads(const Structure& structure, const FieldRows& fields,
                                  const std::vector<std::array<int, 2>>& pairs);

/// Integrals of the squares of the strains' gradients G q over the body, for each field, and the body's length or area.
/// Collective.
struct Slopes {
  Eigen::VectorXd across, in_plane;  ///< in_plane: those of displacements in the plane of a flat body
  double measure = 0;
  Eigen::VectorXd squares() const { return across + in_plane; }
};
Slopes slopes(const Structure& structure, const FieldRows& fields);  ///< of all ranks

/// How far each field bends shells within single elements, of how far it moves them:
///
///   s / (s + max |u|),   s = max |n.((theta_i - theta_j) x d)| / 8  over the edges i j of elements,  d = x_j - x_i
///
/// s is what the cubic of an edge deflects within the element below its chord, u the displacement of nodes; zero where
/// nothing moves. A wave of m cells has s / max |u| = pi^2 / (2 m^2). The deflection of one edge within its element
/// does not bend its neighbours with it (DKT's slopes across an edge are linear), so where edges deflect within an
/// element freely, as those that are wider than their plate is long, they are far too soft. Elements of second order
/// count as none: their edges have a node there. Collective.
Eigen::VectorXd intra_deflections(const Structure& structure, const FieldRows& fields);

}  // namespace floe::fem
