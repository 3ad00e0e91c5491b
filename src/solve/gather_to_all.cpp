#include "gather_to_all.h"

#include <algorithm>
#include <vector>

#include "floe/petsc/all_ranks.h"
#include "floe/petsc/values.h"

namespace floe::solve {

using petsc::check;

namespace {

struct Entry {
  PetscInt row, column;
  double value;
};

}  // namespace

Sparse gather_to_all(const System& system, Mat J) {
  PetscInt first = 0, end = 0;
  check(MatGetOwnershipRange(J, &first, &end));
  std::vector<Entry> mine;
  for (PetscInt row = first; row < end; ++row) {
    PetscInt count = 0;
    const PetscInt* columns = nullptr;
    const double* values = nullptr;
    check(MatGetRow(J, row, &count, &columns, &values));
    for (PetscInt k = 0; k < count; ++k)
      if (values[k] != 0) mine.push_back({row, columns[k], values[k]});
    check(MatRestoreRow(J, row, &count, &columns, &values));
  }
  std::vector<Eigen::Triplet<double, PetscInt>> all;
  for (const Entry& entry : petsc::of_all_ranks(system.comm(), mine))
    all.emplace_back(entry.row, entry.column, entry.value);
  const PetscInt n = system.coordinates().global_size();
  Sparse gathered(n, n);
  gathered.setFromTriplets(all.begin(), all.end());
  return gathered;
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
