#include "floe/reduction/projection.h"

#include <algorithm>

#include "floe/fem/element_stiffness.h"

namespace floe::reduction {

using petsc::check;

namespace {

/// Local rows (foreign nodes included) of the basis.
Eigen::MatrixXd local_rows(const fem::Structure& structure, const Basis& basis) {
  Eigen::MatrixXd V(structure.local_dofs(), basis.columns);
  for (int j = 0; j < basis.columns; ++j) {
    Vec column = nullptr;
    check(BVGetColumn(basis.V, j, &column));
    V.col(j) = structure.exchange.gather(column);
    check(BVRestoreColumn(basis.V, j, &column));
  }
  return V;
}

/// Columns that have slope anywhere: their slopes' root mean square is not round-off against that of the steepest.
std::vector<int> sloped_columns(const fem::Structure& structure, const Eigen::MatrixXd& V) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(V.cols());
  for (const auto& cell : structure.mesh.cells) {
    const Eigen::MatrixXd Ve = V(structure.cell_dofs(cell), Eigen::all);
    for (const auto& g : structure.maps(cell).membrane)
      squares += g.weight * (g.G * Ve).colwise().squaredNorm().transpose();
  }
  MPI_Allreduce(MPI_IN_PLACE, squares.data(), static_cast<int>(squares.size()), MPI_DOUBLE, MPI_SUM,
                structure.mesh.comm);
  std::vector<int> sloped;
  const double greatest = squares.size() > 0 ? squares.maxCoeff() : 0;
  for (int j = 0; j < squares.size(); ++j)
    if (squares[j] > 1e-22 * greatest) sloped.push_back(j);
  return sloped;
}

/// R of a QR of the rows, at most as many rows as columns.
Eigen::MatrixXd triangle(const Eigen::MatrixXd& rows) {
  if (rows.rows() <= rows.cols()) return rows;
  Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
  return qr.matrixQR().topRows(rows.cols()).template triangularView<Eigen::Upper>();
}

/// Stacks blocks of rows and shrinks them whenever they have grown to twice the number of columns.
class TallSkinnyQr {
 public:
  explicit TallSkinnyQr(Eigen::Index columns) : buffer_(2 * columns + 512, columns) {}
  void add(const Eigen::MatrixXd& block) {
    if (filled_ + block.rows() > buffer_.rows()) shrink(block.rows());
    buffer_.middleRows(filled_, block.rows()) = block;
    filled_ += block.rows();
  }
  Eigen::MatrixXd factor() { return triangle(buffer_.topRows(filled_)); }

 private:
  void shrink(Eigen::Index room) {
    const Eigen::MatrixXd R = triangle(buffer_.topRows(filled_));
    if (R.rows() + room > buffer_.rows()) buffer_.conservativeResize(R.rows() + room, Eigen::NoChange);
    buffer_.topRows(R.rows()) = R;
    filled_ = R.rows();
  }
  Eigen::MatrixXd buffer_;
  Eigen::Index filled_ = 0;
};

/// One triangle from those of all ranks, in rank order, the same on all.
Eigen::MatrixXd combine(MPI_Comm comm, const Eigen::MatrixXd& mine) {
  int size = 1, rank = 0;
  MPI_Comm_size(comm, &size);
  MPI_Comm_rank(comm, &rank);
  const Eigen::Index columns = mine.cols();
  const int count = static_cast<int>(mine.rows());
  std::vector<int> rows(size), sizes(size), first(size, 0);
  MPI_Allgather(&count, 1, MPI_INT, rows.data(), 1, MPI_INT, comm);
  int total = 0;
  for (int r = 0; r < size; ++r) {
    sizes[r] = rows[r] * static_cast<int>(columns);
    first[r] = total * static_cast<int>(columns);
    total += rows[r];
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const RowMajor send = mine;
  RowMajor all(total, columns);
  MPI_Gatherv(send.data(), sizes[rank], MPI_DOUBLE, all.data(), sizes.data(), first.data(), MPI_DOUBLE, 0, comm);
  Eigen::MatrixXd factor = rank == 0 ? triangle(all) : Eigen::MatrixXd();
  int final_rows = static_cast<int>(factor.rows());
  MPI_Bcast(&final_rows, 1, MPI_INT, 0, comm);
  factor.resize(final_rows, columns);
  MPI_Bcast(factor.data(), static_cast<int>(factor.size()), MPI_DOUBLE, 0, comm);
  return factor;
}

void sum_over_ranks(MPI_Comm comm, double* values, Eigen::Index count) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  MPI_Reduce(rank == 0 ? MPI_IN_PLACE : values, rank == 0 ? values : nullptr, static_cast<int>(count), MPI_DOUBLE,
             MPI_SUM, 0, comm);
  MPI_Bcast(values, static_cast<int>(count), MPI_DOUBLE, 0, comm);
}

void sum_over_ranks(MPI_Comm comm, body::Inertia& inertia) {
  sum_over_ranks(comm, &inertia.m, 1);
  sum_over_ranks(comm, inertia.s0.data(), inertia.s0.size());
  sum_over_ranks(comm, inertia.C0.data(), inertia.C0.size());
  sum_over_ranks(comm, inertia.S.data(), inertia.S.size());
  for (auto& row : inertia.h)
    for (auto& h : row) sum_over_ranks(comm, h.data(), h.size());
  for (auto& row : inertia.M)
    for (auto& M : row) sum_over_ranks(comm, M.data(), M.size());
}

}  // namespace

body::FlexibleBody project(const fem::Structure& structure, const Basis& basis) {
  const MPI_Comm comm = structure.mesh.comm;
  const int k = basis.columns;
  const Eigen::MatrixXd V = local_rows(structure, basis);
  body::FlexibleBody body;
  body.inertia = body.line = body::Inertia(structure.mesh.dimension, k);
  body.elasticity.bending = Eigen::MatrixXd::Zero(k, k);
  body.elasticity.pairs = fem::pairs_of(sloped_columns(structure, V));
  TallSkinnyQr qr(k + static_cast<Eigen::Index>(body.elasticity.pairs.size()));
  for (const auto& cell : structure.mesh.cells) {
    const fem::ElementMaps maps = structure.maps(cell);
    const Eigen::MatrixXd Ve = V(structure.cell_dofs(cell), Eigen::all);
    for (const body::MassPoint& point : maps.mass) body.inertia.add({point.mass, point.x, point.N * Ve});
    for (const body::MassPoint& point : structure.line(cell)) body.line.add({point.mass, point.x, point.N * Ve});
    Eigen::MatrixXd strained = Ve;
    fem::take_rigid_motion(strained, fem::arms(structure.mesh, cell));
    body.elasticity.bending.noalias() += strained.transpose() * maps.bending * strained;
    if (k > 0) qr.add(fem::strain_rows(maps, Ve, strained, body.elasticity.pairs));
  }
  sum_over_ranks(comm, body.inertia);
  sum_over_ranks(comm, body.line);
  sum_over_ranks(comm, body.elasticity.bending.data(), body.elasticity.bending.size());
  body.elasticity.F = combine(comm, qr.factor());
  return body;
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
