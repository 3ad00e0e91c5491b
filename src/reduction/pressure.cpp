#include "floe/reduction/pressure.h"

#include "floe/fem/pressure.h"
#include "floe/petsc/error.h"

namespace floe::reduction {

using petsc::check;

namespace {

Eigen::MatrixXd local_columns(const fem::Structure& structure, const Basis& basis) {
  Eigen::MatrixXd V(structure.local_dofs(), basis.columns);
  for (int j = 0; j < basis.columns; ++j) {
    Vec column = nullptr;
    check(BVGetColumn(basis.V, j, &column));
    structure.exchange.gather(column, V.col(j).data());
    check(BVRestoreColumn(basis.V, j, &column));
  }
  return V;
}

void sum_over_ranks(MPI_Comm comm, body::Pressure& p) {
  const auto sum = [&](double* values, Eigen::Index count) {
    MPI_Allreduce(MPI_IN_PLACE, values, static_cast<int>(count), MPI_DOUBLE, MPI_SUM, comm);
  };
  sum(p.force.data(), 3), sum(p.moment.data(), 3), sum(p.spread.data(), 9);
  sum(p.force_by.data(), p.force_by.size()), sum(p.moment_by.data(), p.moment_by.size());
  sum(p.load.data(), p.load.size()), sum(p.load_by.data(), p.load_by.size());
  for (Eigen::Matrix3d& spread : p.spread_by) sum(spread.data(), 9);
}

}  // namespace

body::Pressure pressure(const fem::Structure& structure, const Basis& basis,
                        const std::function<bool(const fem::Mesh::Cell&)>& on) {
  const Eigen::MatrixXd V = local_columns(structure, basis);
  body::Pressure sum(basis.columns);
  for (const fem::Mesh::Cell& cell : structure.mesh.cells)
    if (fem::is_shell(cell) && on(cell))
      sum += body::projected(fem::pressure(structure, cell), V(structure.cell_dofs(cell), Eigen::all));
  sum_over_ranks(structure.mesh.comm, sum);
  return sum;
}

}  // namespace floe::reduction
