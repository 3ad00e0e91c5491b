#include "gather_to_all.h"

#include <algorithm>
#include <numeric>

#include "floe/petsc/values.h"

namespace floe::solve {

using petsc::check;

Eigen::MatrixXd gather_to_all(const System& system, Mat J) {
  const PetscInt n = system.coordinates().global_size();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows(n, n);
  rows.setZero();
  std::vector<PetscInt> all(n);
  std::iota(all.begin(), all.end(), 0);
  PetscInt first = 0, end = 0;
  check(MatGetOwnershipRange(J, &first, &end));
  check(MatGetValues(J, end - first, all.data() + first, n, all.data(), rows.data() + std::ptrdiff_t(first) * n));
  MPI_Allreduce(MPI_IN_PLACE, rows.data(), static_cast<int>(rows.size()), MPI_DOUBLE, MPI_SUM, system.comm());
  return rows;
}

Eigen::VectorXd gather_to_all(const System& system, Vec x) {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(system.coordinates().global_size());
  {
    petsc::Values mine(x);
    std::copy(mine.begin(), mine.begin() + (mine.end - mine.first), all.data() + mine.first);
  }
  MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, system.comm());
  return all;
}

void set(Vec x, const Eigen::VectorXd& values) {
  petsc::Values mine(x);
  for (PetscInt i = mine.first; i < mine.end; ++i) mine[i] = values[i];
}

}  // namespace floe::solve
