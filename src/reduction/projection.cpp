#include "floe/reduction/projection.h"

#include <algorithm>

#include "floe/petsc/stage.h"
#include "mass_forms.h"
#include "tall_skinny.h"

namespace floe::reduction {

using petsc::check;

namespace {

/// Columns that have slope anywhere: their slopes' root mean square is not round-off against that of the steepest.
std::vector<int> sloped_columns(const fem::Structure& structure, const fem::FieldRows& V) {
  const Eigen::VectorXd squares = fem::slopes(structure, V).squares();
  const double least = squares.size() > 0 ? 1e-18 * squares.maxCoeff() : 0;  // 1e-11 was seen of a tilted plate
  std::vector<int> sloped;
  for (int j = 0; j < squares.size(); ++j)
    if (squares[j] > least) sloped.push_back(j);
  return sloped;
}

void sum_over_ranks(MPI_Comm comm, double* values, Eigen::Index count) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  MPI_Reduce(rank == 0 ? MPI_IN_PLACE : values, rank == 0 ? values : nullptr, static_cast<int>(count), MPI_DOUBLE,
             MPI_SUM, 0, comm);
  MPI_Bcast(values, static_cast<int>(count), MPI_DOUBLE, 0, comm);
}

void sum_over_ranks(MPI_Comm comm, body::Inertia& inertia) {
  std::array<int, 2> some{!inertia.Q.empty(), !inertia.W.empty()};
  MPI_Allreduce(MPI_IN_PLACE, some.data(), 2, MPI_INT, MPI_MAX, comm);
  if (some[0]) inertia.allocate_first();
  if (some[1]) inertia.allocate_rotary();
  sum_over_ranks(comm, &inertia.m, 1);
  sum_over_ranks(comm, inertia.s0.data(), inertia.s0.size());
  sum_over_ranks(comm, inertia.C0.data(), inertia.C0.size());
  sum_over_ranks(comm, inertia.S.data(), inertia.S.size());
  for (auto& row : inertia.h)
    for (auto& h : row) sum_over_ranks(comm, h.data(), h.size());
  for (auto& row : inertia.M)
    for (auto& M : row) sum_over_ranks(comm, M.data(), M.size());
  for (auto& Q : inertia.Q) sum_over_ranks(comm, Q.data(), Q.size());
  for (auto& row : inertia.W)
    for (auto& W : row) sum_over_ranks(comm, W.data(), W.size());
}

/// Sums V'K_b V of this rank. Rows go to three stacks in groups of three: a shell's are its mean curvature, its edges'
/// bending and its drilling, and columns of a flat one have either of the first two or the last.
class BendingSum {
 public:
  explicit BendingSum(int k) : sum_(Eigen::MatrixXd::Zero(k, k)) { stacks_.fill(RowStack(k, 510)); }
  void add(const fem::PieceRows& piece, const fem::Strained& V, int dofs_per_node) {
    for (Eigen::Index first = 0; first < piece.bending.rows(); first += 3) {
      RowStack& stack = stacks_[std::min<Eigen::Index>(first / 3, 2)];
      const Eigen::Index count = std::min<Eigen::Index>(3, piece.bending.rows() - first);
      if (stack.count + count > stack.room) flush(stack);
      stack.range.include(fem::multiply(piece.bending.middleRows(first, count), V, dofs_per_node, stack.next()));
      stack.count += static_cast<int>(count);
    }
  }
  Eigen::MatrixXd sum() {
    for (RowStack& stack : stacks_) flush(stack);
    mirror(sum_);
    return sum_;
  }

 private:
  void flush(RowStack& stack) {
    add_product(stack, stack, sum_);
    stack.clear();
  }
  std::array<RowStack, 3> stacks_;
  Eigen::MatrixXd sum_;
};

/// Adds the rows [ L V | e(V_a, V_b) | L W ] of strain points to a QR.
class StrainStack {
 public:
  /// @param more  columns of W
  StrainStack(const fem::FieldRows& V, const std::vector<int>& sloped, Eigen::Index pairs, Eigen::Index more = 0)
      : V_(V),
        sloped_(sloped),
        qr_(V.cols() + pairs + more),
        more_(fem::most_strains, more),
        linear_(fem::most_strains, V.cols()),
        bilinear_(fem::most_strains, pairs) {}
  /// @param strained  V for L;  @param others  W likewise, if there is any
  void add(const fem::Structure& structure, const fem::PieceRows& piece, const fem::StrainRows& point,
           const fem::Strained& strained, const fem::DofRanges& ranges, const fem::Strained* others = nullptr) {
    const Eigen::Index s = point.L.rows(), g = point.G.rows(), k = V_.cols();
    fem::multiply(point.L, strained, structure.dofs_per_node, linear_.data());
    bilinear_.topRows(s).setZero();
    if (slope_.rows() < g) slope_.resize(g, k), steep_.resize(g, k);
    if (!fem::multiply(structure, piece, point.G, V_, ranges, slope_.data()).empty() && bilinear_.cols() > 0) {
      for (std::size_t i = 0; i < sloped_.size(); ++i)
        steep_.col(static_cast<Eigen::Index>(i)).head(g) = slope_.col(sloped_[i]).head(g);
      for (const auto& term : point.terms) add_term(term, s);
    }
    auto rows = qr_.rows(s);
    rows.leftCols(k) = linear_.topRows(s);
    rows.middleCols(k, bilinear_.cols()) = bilinear_.topRows(s);
    if (!others) return;
    fem::multiply(point.L, *others, structure.dofs_per_node, more_.data());
    rows.rightCols(more_.cols()) = more_.topRows(s);
  }
  /// The bending of a piece, which is linear.
  void add_bending(const fem::PieceRows& piece, int dofs_per_node, const fem::Strained& strained,
                   const fem::Strained& others) {
    for (Eigen::Index first = 0; first < piece.bending.rows(); first += fem::most_strains) {
      const Eigen::Index s = std::min<Eigen::Index>(fem::most_strains, piece.bending.rows() - first);
      fem::multiply(piece.bending.middleRows(first, s), strained, dofs_per_node, linear_.data());
      fem::multiply(piece.bending.middleRows(first, s), others, dofs_per_node, more_.data());
      auto rows = qr_.rows(s);
      rows.setZero();
      rows.leftCols(V_.cols()) = linear_.topRows(s);
      rows.rightCols(more_.cols()) = more_.topRows(s);
    }
  }
  Eigen::MatrixXd factor() { return qr_.factor(); }

 private:
  void add_term(const fem::StrainRows::Term& term, Eigen::Index strains) {
    const int n = static_cast<int>(sloped_.size());
    const double *p = steep_.row(term.p).data(), *q = steep_.row(term.q).data();
    for (Eigen::Index r = 0; r < strains; ++r) {
      double* out = bilinear_.row(r).data();
      for (int i = 0; i < n; out += n - i, ++i) {  // pairs (i, i), (i, i + 1), ...
        fem::add_multiple(term.C[r] * p[i], q + i, out, n - i);
        if (term.p != term.q) fem::add_multiple(term.C[r] * q[i], p + i, out, n - i);
      }
    }
  }
  const fem::FieldRows& V_;
  const std::vector<int>& sloped_;
  TallSkinnyQr qr_;
  fem::FieldRows more_, linear_, slope_, steep_, bilinear_;
};

/// Local rows (foreign nodes included) of the basis.
fem::FieldRows local_rows(const fem::Structure& structure, const Basis& basis) {
  const petsc::VecHandle column = fem::field(structure);
  return fem::gather(structure, basis.columns, [&](Eigen::Index j, double* local) {
    check(BVCopyVec(basis.V, static_cast<PetscInt>(j), column));
    structure.exchange.gather(column, local);
  });
}

}  // namespace

body::FlexibleBody project(const fem::Structure& structure, const Basis& basis) {
  const petsc::Stage stage("projection");
  const MPI_Comm comm = structure.mesh.comm;
  const int k = basis.columns;
  const fem::FieldRows V = local_rows(structure, basis);
  const fem::DofRanges ranges = fem::dof_ranges(structure, V);
  const std::vector<int> sloped = sloped_columns(structure, V);
  body::FlexibleBody body;
  body.elasticity.pairs = fem::pairs_of(sloped);
  MassForms inertia(structure, V, ranges, true), line(structure, V, ranges, true);
  BendingSum bending(k);
  StrainStack strain(V, sloped, static_cast<Eigen::Index>(body.elasticity.pairs.size()));
  std::vector<fem::PieceRows> pieces;
  fem::Strained strained;
  for (const auto& cell : structure.mesh.cells) {
    fem::piece_rows(structure, cell, {true, true, true, true}, pieces);
    for (const fem::PieceRows& piece : pieces) {
      inertia.add(piece, piece.mass);
      inertia.add(piece, piece.rotary);
      line.add(piece, piece.line);
      if (k == 0) continue;
      fem::take_strained(structure, piece, V, ranges, strained);
      bending.add(piece, strained, structure.dofs_per_node);
      for (const fem::StrainRows& point : piece.strain) strain.add(structure, piece, point, strained, ranges);
    }
  }
  body.inertia = inertia.sums();
  body.line = line.sums();
  body.elasticity.bending = bending.sum();
  sum_over_ranks(comm, body.inertia);
  sum_over_ranks(comm, body.line);
  sum_over_ranks(comm, body.elasticity.bending.data(), body.elasticity.bending.size());
  body.elasticity.F = combine(comm, strain.factor());
  return body;
}

Eigen::MatrixXd strain_factor(const fem::Structure& structure, const Basis& basis,
                              const std::vector<std::pair<int, int>>& pairs, const Columns& W) {
  const fem::FieldRows V = local_rows(structure, basis), more = fem::gather(structure, W);
  const fem::DofRanges ranges = fem::dof_ranges(structure, V), others = fem::dof_ranges(structure, more);
  std::vector<int> sloped;  // in their order, each with itself
  for (const auto& [a, b] : pairs)
    if (a == b) sloped.push_back(a);
  StrainStack strain(V, sloped, static_cast<Eigen::Index>(pairs.size()), more.cols());
  std::vector<fem::PieceRows> pieces;
  fem::Strained of_V, of_W;
  for (const auto& cell : structure.mesh.cells) {
    fem::piece_rows(structure, cell, {true, true, false, false}, pieces);
    for (const fem::PieceRows& piece : pieces) {
      fem::take_strained(structure, piece, V, ranges, of_V), fem::take_strained(structure, piece, more, others, of_W);
      strain.add_bending(piece, structure.dofs_per_node, of_V, of_W);
      for (const fem::StrainRows& point : piece.strain) strain.add(structure, piece, point, of_V, ranges, &of_W);
    }
  }
  return combine(structure.mesh.comm, strain.factor());
}

PartMasses part_masses(const fem::Structure& structure, const Basis& basis, const std::vector<char>& only) {
  const fem::FieldRows V = local_rows(structure, basis);
  const fem::DofRanges ranges = fem::dof_ranges(structure, V);
  MassForms inertia(structure, V, ranges, true), line(structure, V, ranges, true);
  std::vector<fem::PieceRows> pieces;
  for (std::size_t c = 0; c < only.size(); ++c) {
    if (!only[c]) continue;
    fem::piece_rows(structure, structure.mesh.cells[c], {false, false, true, true}, pieces);
    for (const fem::PieceRows& piece : pieces) {
      inertia.add(piece, piece.mass);
      inertia.add(piece, piece.rotary);
      line.add(piece, piece.line);
    }
  }
  PartMasses part{inertia.sums(), line.sums()};
  sum_over_ranks(structure.mesh.comm, part.mass);
  sum_over_ranks(structure.mesh.comm, part.line);
  return part;
}

body::PlaceMap place_map(const fem::Structure& structure, const Basis& basis, PetscInt node) {
  const int d = structure.mesh.dimension, k = basis.columns;
  const int n = structure.dofs_per_node;
  body::PlaceMap place{Eigen::VectorXd::Zero(d), Eigen::MatrixXd::Zero(d, k), Eigen::MatrixXd::Zero(n - d, k)};
  const PetscInt local = node - structure.mesh.first_node;
  const bool mine = local >= 0 && local < structure.mesh.owned_nodes;
  if (mine) place.x = structure.mesh.positions[local].head(d);
  for (int j = 0; j < k; ++j) {
    Vec column = nullptr;
    const double* values = nullptr;
    check(BVGetColumn(basis.V, j, &column));
    check(VecGetArrayRead(column, &values));
    if (mine) {
      for (int i = 0; i < d; ++i) place.S(i, j) = values[n * local + i];
      for (int i = d; i < n; ++i) place.psi(i - d, j) = values[n * local + i];
    }
    check(VecRestoreArrayRead(column, &values));
    check(BVRestoreColumn(basis.V, j, &column));
  }
  const MPI_Comm comm = structure.mesh.comm;
  sum_over_ranks(comm, place.x.data(), place.x.size());
  sum_over_ranks(comm, place.S.data(), place.S.size());
  sum_over_ranks(comm, place.psi.data(), place.psi.size());
  return place;
}

body::FlexibleBody rigid_body(const fem::Structure& structure) { return project(structure, Basis{}); }

}  // namespace floe::reduction
