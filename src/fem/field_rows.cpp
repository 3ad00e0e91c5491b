#include "floe/fem/field_rows.h"

#include <algorithm>
#include <span>

#include "floe/math/clones.h"

namespace floe::fem {

using petsc::check;

FLOE_CLONES void add_multiple(double c, const double* __restrict in, double* __restrict out, int n) {
  for (int j = 0; j < n; ++j) out[j] += c * in[j];
}

namespace {

constexpr Eigen::Index together = 8;  // columns that are rotated from columns into rows at once

/// v <- R v of all displacements and rotations.
void rotate(const Eigen::Matrix3d& R, Eigen::Ref<Eigen::VectorXd> field) {
  if (R.isIdentity(0)) return;
  for (Eigen::Index i = 0; i < field.size(); i += 3) field.segment<3>(i) = R * Eigen::Vector3d(field.segment<3>(i));
}

}  // namespace

FieldRows gather(const Structure& structure, const std::vector<petsc::VecHandle>& fields) {
  return gather(structure, static_cast<Eigen::Index>(fields.size()),
                [&](Eigen::Index j, double* local) { structure.exchange.gather(fields[j], local); });
}

FieldRows gather(const Structure& structure, Eigen::Index count,
                 const std::function<void(Eigen::Index, double*)>& local) {
  const Eigen::Index n = structure.local_dofs();
  FieldRows rows(n, count);
  Eigen::MatrixXd some(n, std::min(together, count));
  for (Eigen::Index first = 0; first < count; first += together) {
    const Eigen::Index last = std::min(count, first + together);
    for (Eigen::Index j = first; j < last; ++j) {
      local(j, some.col(j - first).data());
      if (const FlatBody* flat = flat_body(structure)) rotate(flat->axes.transpose(), some.col(j - first));
    }
    rows.middleCols(first, last - first) = some.leftCols(last - first);
  }
  return rows;
}

void for_each_field(const Structure& structure, const FieldRows& fields,
                    const std::function<void(Eigen::Index, const double*)>& use) {
  Eigen::MatrixXd some(fields.rows(), std::min(together, fields.cols()));
  for (Eigen::Index first = 0; first < fields.cols(); first += together) {
    const Eigen::Index last = std::min(fields.cols(), first + together);
    some.leftCols(last - first) = fields.middleCols(first, last - first);
    for (Eigen::Index j = first; j < last; ++j) {
      if (const FlatBody* flat = flat_body(structure)) rotate(flat->axes, some.col(j - first));
      use(j, some.col(j - first).data());
    }
  }
}

void add(const Structure& structure, const FieldRows& local, Mat sums) {
  for_each_field(structure, local, [&](Eigen::Index j, const double* values) {
    Vec column = nullptr;
    check(MatDenseGetColumnVec(sums, static_cast<PetscInt>(j), &column));
    structure.exchange.add(values, column);
    check(MatDenseRestoreColumnVec(sums, static_cast<PetscInt>(j), &column));
  });
}

DofRanges dof_ranges(const Structure& structure, const FieldRows& fields) {
  const int per_node = structure.dofs_per_node, columns = static_cast<int>(fields.cols());
  std::array<int, 12> bounds;  // -begin, end of each
  DofRanges ranges;
  for (ColumnRange& range : ranges) range = {columns, 0};
  for (Eigen::Index i = 0; i < fields.rows(); ++i) {
    ColumnRange& range = ranges[i % per_node];
    const double* row = fields.row(i).data();
    for (int j = 0; j < range.begin; ++j)
      if (row[j] != 0) range.begin = j;
    for (int j = columns; j-- > range.end;)
      if (row[j] != 0) range.end = j + 1;
  }
  for (std::size_t d = 0; d < 6; ++d) bounds[2 * d] = -ranges[d].begin, bounds[2 * d + 1] = ranges[d].end;
  MPI_Allreduce(MPI_IN_PLACE, bounds.data(), 12, MPI_INT, MPI_MAX, structure.mesh.comm);
  for (std::size_t d = 0; d < 6; ++d) ranges[d] = {-bounds[2 * d], bounds[2 * d + 1]};
  return ranges;
}

ColumnRange multiply(const Structure& structure, const PieceRows& piece, const Eigen::Ref<const SmallRows>& rows,
                     const FieldRows& fields, const DofRanges& ranges, double* out) {
  const int per_node = structure.dofs_per_node;
  const Eigen::Index columns = fields.cols();
  std::fill(out, out + rows.rows() * columns, 0);
  ColumnRange all;
  for (int a = 0; a < piece.nodes; ++a)
    for (int d = 0; d < per_node; ++d) {
      const ColumnRange& range = ranges[d];
      if (range.empty()) continue;
      const double* in = fields.row(static_cast<Eigen::Index>(per_node) * piece.node[a] + d).data() + range.begin;
      for (Eigen::Index r = 0; r < rows.rows(); ++r) {
        const double c = rows(r, per_node * a + d);
        if (c == 0) continue;
        all.include(range);
        add_multiple(c, in, out + r * columns + range.begin, range.end - range.begin);
      }
    }
  return all;
}

namespace {

/// Turns about the first node's rotation: translation `to` loses `factor` (+-1) times the arm along `along` times the
/// rotation `about`.
struct Rotation {
  int to, about, along;
  double sign;
};
constexpr Rotation planar_rotations[] = {{0, 2, 1, 1}, {1, 2, 0, -1}};
constexpr Rotation spatial_rotations[] = {{0, 4, 2, -1}, {0, 5, 1, 1},  {1, 5, 0, -1},
                                          {1, 3, 2, 1},  {2, 3, 1, -1}, {2, 4, 0, 1}};

/// A node's own rotations less those of the reference about the same axes; rows of their rotations.
void take_rotated(const PieceRows::Spin& spin, const FieldRows& fields, const DofRanges& ranges, Eigen::Index own,
                  Eigen::Index reference, Eigen::Index out, Strained& strained) {
  for (int d = 0; d < 3; ++d) {
    if (spin.own.col(d).isZero(0)) continue;
    double* to = strained.rows.row(out + d).data();
    const auto [begin, end] = ranges[3 + d];
    for (int j = begin; j < end; ++j) to[j] = fields(own + d, j);
    for (int i = 0; i < 3; ++i) {
      const ColumnRange& range = ranges[3 + i];
      if (spin.own(i, d) == 0 || range.empty()) continue;
      strained.ranges[3 + d].include(range);
      add_multiple(-spin.own(i, d), fields.row(reference + i).data() + range.begin, to + range.begin,
                   range.end - range.begin);
    }
  }
}

}  // namespace

void take_strained(const Structure& structure, const PieceRows& piece, const FieldRows& fields, const DofRanges& ranges,
                   Strained& strained) {
  const Eigen::Index per_node = structure.dofs_per_node;
  const std::span<const Rotation> rotations =
      per_node == 3 ? std::span<const Rotation>(planar_rotations) : spatial_rotations;
  const FlatBody* flat = flat_body(structure);
  const auto& at = flat ? flat->positions : structure.mesh.positions;
  strained.rows.setZero(per_node * piece.nodes, fields.cols());
  strained.ranges = ranges;
  const auto row = [&](int a, int d) { return fields.row(per_node * piece.node[a] + d).data(); };
  const auto spins = [&](int a) {
    const auto found = std::find_if(piece.spins.begin(), piece.spins.end(), [&](const auto& s) { return s.at == a; });
    return found == piece.spins.end() ? nullptr : &*found;
  };
  int& reference = strained.reference;
  for (reference = 0; spins(reference);) ++reference;  // a line's independent node, at the latest
  for (int a = 0; a < piece.nodes; ++a) {
    if (a == reference) continue;
    if (const PieceRows::Spin* spin = spins(a)) {
      take_rotated(*spin, fields, ranges, per_node * piece.node[a] + 3, per_node * piece.node[reference] + 3,
                   per_node * a + 3, strained);
      continue;
    }
    const Eigen::Vector3d arm = at[piece.node[a]] - at[piece.node[reference]];
    for (int d = 0; d < per_node; ++d) {
      const auto [begin, end] = ranges[d];
      double* out = strained.rows.row(per_node * a + d).data();
      const double *own = row(a, d), *first = row(reference, d);
      for (int j = begin; j < end; ++j) out[j] = own[j] - first[j];
    }
    for (const Rotation& rotation : rotations) {
      const ColumnRange& range = ranges[rotation.about];
      if (arm[rotation.along] == 0 || range.empty()) continue;
      strained.ranges[rotation.to].include(range);
      add_multiple(rotation.sign * arm[rotation.along], row(reference, rotation.about) + range.begin,
                   strained.rows.row(per_node * a + rotation.to).data() + range.begin, range.end - range.begin);
    }
  }
}

ColumnRange multiply(const Eigen::Ref<const SmallRows>& rows, const Strained& strained, int dofs_per_node,
                     double* out) {
  const Eigen::Index columns = strained.rows.cols();
  std::fill(out, out + rows.rows() * columns, 0);
  ColumnRange all;
  for (Eigen::Index i = 0; i < strained.rows.rows(); ++i) {
    if (i / dofs_per_node == strained.reference) continue;
    const ColumnRange& range = strained.ranges[i % dofs_per_node];
    if (range.empty()) continue;
    const double* in = strained.rows.row(i).data() + range.begin;
    for (Eigen::Index r = 0; r < rows.rows(); ++r) {
      const double c = rows(r, i);
      if (c == 0) continue;
      all.include(range);
      add_multiple(c, in, out + r * columns + range.begin, range.end - range.begin);
    }
  }
  return all;
}

void add_transposed(const Structure& structure, const PieceRows& piece, const SmallRows& rows, const double* in,
                    FieldRows& fields) {
  const int per_node = structure.dofs_per_node, columns = static_cast<int>(fields.cols());
  for (int a = 0; a < piece.nodes; ++a)
    for (int d = 0; d < per_node; ++d) {
      double* out = fields.row(static_cast<Eigen::Index>(per_node) * piece.node[a] + d).data();
      for (Eigen::Index r = 0; r < rows.rows(); ++r)
        if (const double c = rows(r, per_node * a + d); c != 0) add_multiple(c, in + r * columns, out, columns);
    }
}

namespace {

/// How many rows of a strain's G are gradients, and how many of them are those of displacements in a flat body's plane.
struct Gradients {
  Eigen::Index count, in_plane;
};
Gradients gradients_of(const Structure& structure, const Mesh::Cell& cell, const StrainRows& point, bool flat) {
  const Eigen::Index rows = point.G.rows(), all = cell.kind == CellKind::line3       ? 3
                                                  : cell.kind == CellKind::triangle6 ? 27
                                                                                     : 6;
  const auto* shell = std::get_if<ShellSection>(&structure.sections[cell.part]);
  const bool quadratic = mesh::is_quadratic(cell.kind);
  const bool normal_alone = shell && !quadratic && shell->strains == Strains::von_karman;
  const Eigen::Index count = shell || quadratic ? std::min(rows, normal_alone ? 2 : all) : rows;  // others behind them
  return {count, flat && count == all ? 2 * count / 3 : 0};
}

}  // namespace

Slopes slopes(const Structure& structure, const FieldRows& fields) {
  const DofRanges ranges = dof_ranges(structure, fields);
  Slopes sums{Eigen::VectorXd::Zero(fields.cols()), Eigen::VectorXd::Zero(fields.cols()), 0};
  const bool flat = flat_body(structure);
  FieldRows values;
  std::vector<PieceRows> pieces;
  for (const Mesh::Cell& cell : structure.mesh.cells) {
    piece_rows(structure, cell, {.strain = true}, pieces);
    for (const PieceRows& piece : pieces)
      for (const StrainRows& point : piece.strain) {
        if (values.rows() < point.G.rows()) values.resize(point.G.rows(), fields.cols());
        const ColumnRange range = multiply(structure, piece, point.G, fields, ranges, values.data());
        sums.measure += point.weight;
        const Gradients gradients = gradients_of(structure, cell, point, flat);
        for (Eigen::Index g = 0; g < gradients.count; ++g) {
          Eigen::VectorXd& sum = g < gradients.in_plane ? sums.in_plane : sums.across;
          for (int j = range.begin; j < range.end; ++j) sum[j] += point.weight * values(g, j) * values(g, j);
        }
      }
  }
  for (Eigen::VectorXd* sum : {&sums.across, &sums.in_plane})
    MPI_Allreduce(MPI_IN_PLACE, sum->data(), static_cast<int>(sum->size()), MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, &sums.measure, 1, MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  return sums;
}

}  // namespace floe::fem
