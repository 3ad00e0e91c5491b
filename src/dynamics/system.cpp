#include "floe/dynamics/system.h"

#include <algorithm>

namespace floe::dynamics {
namespace {

/// Work arrays of one term's evaluation, reused from call to call.
struct TermMotion {
  Eigen::VectorXd q, v, a, r;
  Eigen::MatrixXd J;
};

void pick(const std::vector<int>& indices, const Eigen::VectorXd& from, Eigen::VectorXd& to) {
  to.resize(static_cast<Eigen::Index>(indices.size()));
  for (std::size_t i = 0; i < indices.size(); ++i) to[i] = from[indices[i]];
}

TermMotion& workspace(std::size_t slot) {
  static std::vector<std::unique_ptr<TermMotion>> all;  // one for each term size, so that nothing is resized in a step
  if (slot >= all.size()) all.resize(slot + 1);
  if (!all[slot]) all[slot] = std::make_unique<TermMotion>();
  return *all[slot];
}

}  // namespace

System::System(Coordinates coordinates, std::vector<std::unique_ptr<Term>> terms)
    : coordinates_(std::move(coordinates)), terms_(std::move(terms)) {
  const auto& global = coordinates_.global();
  identity_ = coordinates_.owned_size() == coordinates_.local_size();
  for (std::size_t i = 0; identity_ && i < global.size(); ++i) identity_ = global[i] == static_cast<PetscInt>(i);
  int all = 0;
  const int mine = identity_;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_LAND, comm());
  identity_ = all;
  sum_.resize(coordinates_.local_size());
  dense_ = identity_ && coordinates_.global_size() == coordinates_.local_size();
  if (identity_) return;

  using petsc::check;
  check(VecCreateSeq(PETSC_COMM_SELF, coordinates_.local_size(), staging_.out()));
  petsc::IsHandle from;
  check(ISCreateGeneral(comm(), coordinates_.local_size(), global.data(), PETSC_COPY_VALUES, from.out()));
  const petsc::VecHandle vector = create_vector();
  check(VecScatterCreate(vector, from, staging_, nullptr, scatter_.out()));
  check(ISLocalToGlobalMappingCreate(comm(), 1, coordinates_.local_size(), global.data(), PETSC_COPY_VALUES,
                                     mapping_.out()));
}

petsc::VecHandle System::create_vector() const {
  petsc::VecHandle vector;
  if (dense_)
    petsc::check(VecCreateSeq(comm(), coordinates_.owned_size(), vector.out()));
  else
    petsc::check(VecCreateMPI(comm(), coordinates_.owned_size(), PETSC_DETERMINE, vector.out()));
  petsc::check(VecSet(vector, 0));
  return vector;
}

petsc::MatHandle System::create_tangent() const {
  using petsc::check;
  petsc::MatHandle J;
  const PetscInt owned = coordinates_.owned_size();
  if (dense_) {
    check(MatCreateSeqDense(comm(), owned, owned, nullptr, J.out()));
    return J;
  }
  petsc::MatHandle pattern;
  check(MatCreate(comm(), pattern.out()));
  check(MatSetSizes(pattern, owned, owned, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetType(pattern, MATPREALLOCATOR));
  check(MatSetUp(pattern));
  const auto& global = coordinates_.global();
  std::vector<PetscInt> rows;
  std::vector<double> zeros;
  for (const auto& term : terms_) {
    rows.clear();
    for (int index : term->coordinates()) rows.push_back(global[index]);
    zeros.assign(rows.size() * rows.size(), 0.0);
    const PetscInt n = static_cast<PetscInt>(rows.size());
    check(MatSetValues(pattern, n, rows.data(), n, rows.data(), zeros.data(), ADD_VALUES));
  }
  PetscInt first = 0, end = 0;
  check(MatGetOwnershipRange(pattern, &first, &end));
  const double zero = 0;
  for (PetscInt i = first; i < end; ++i) check(MatSetValues(pattern, 1, &i, 1, &i, &zero, ADD_VALUES));
  check(MatAssemblyBegin(pattern, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(pattern, MAT_FINAL_ASSEMBLY));
  check(MatCreate(comm(), J.out()));
  check(MatSetSizes(J, owned, owned, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetType(J, MATAIJ));
  check(MatPreallocatorPreallocate(pattern, PETSC_TRUE, J));
  check(MatSetOption(J, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_TRUE));
  return J;
}

petsc::IsHandle System::multipliers() const {
  petsc::IsHandle set;
  const auto& mine = coordinates_.owned_multipliers();
  petsc::check(ISCreateGeneral(comm(), static_cast<PetscInt>(mine.size()), mine.data(), PETSC_COPY_VALUES, set.out()));
  return set;
}

void System::gather(Vec global, Eigen::VectorXd& local) const {
  using petsc::check;
  const double* values = nullptr;
  if (!identity_) {
    check(VecScatterBegin(scatter_, global, staging_, INSERT_VALUES, SCATTER_FORWARD));
    check(VecScatterEnd(scatter_, global, staging_, INSERT_VALUES, SCATTER_FORWARD));
    global = staging_;
  }
  check(VecGetArrayRead(global, &values));
  local = Eigen::Map<const Eigen::VectorXd>(values, coordinates_.local_size());
  check(VecRestoreArrayRead(global, &values));
}

void System::residual(double t, Vec U, Vec V, Vec A, ConstraintLevel level, Vec F) const {
  using petsc::check;
  gather(U, local_.q), gather(V, local_.v), gather(A, local_.a);
  sum_.setZero();
  petsc::agree_if_parallel(comm(), dense_, [&] {
    for (const auto& term : terms_) {
      const auto& indices = term->coordinates();
      TermMotion& w = workspace(indices.size());
      pick(indices, local_.q, w.q), pick(indices, local_.v, w.v), pick(indices, local_.a, w.a);
      w.r.setZero(w.q.size());
      term->residual({t, w.q, w.v, w.a, level}, w.r);
      for (std::size_t i = 0; i < indices.size(); ++i) sum_[indices[i]] += w.r[i];
    }
  });
  double* values = nullptr;
  if (identity_) {
    check(VecGetArrayWrite(F, &values));
    Eigen::Map<Eigen::VectorXd>(values, sum_.size()) = sum_;
    check(VecRestoreArrayWrite(F, &values));
    return;
  }
  check(VecGetArrayWrite(staging_, &values));
  Eigen::Map<Eigen::VectorXd>(values, sum_.size()) = sum_;
  check(VecRestoreArrayWrite(staging_, &values));
  check(VecSet(F, 0));
  check(VecScatterBegin(scatter_, staging_, F, ADD_VALUES, SCATTER_REVERSE));
  check(VecScatterEnd(scatter_, staging_, F, ADD_VALUES, SCATTER_REVERSE));
}

void System::tangent(double t, Vec U, Vec V, Vec A, Weights weights, Mat J) const {
  using petsc::check;
  gather(U, local_.q), gather(V, local_.v), gather(A, local_.a);
  double* dense = nullptr;
  const PetscInt n = coordinates_.owned_size();
  if (dense_) {
    check(MatDenseGetArrayWrite(J, &dense));
    std::fill(dense, dense + n * n, 0.0);
  } else {
    check(MatZeroEntries(J));
  }
  const auto& global = coordinates_.global();
  petsc::agree_if_parallel(comm(), dense_, [&] {
    for (const auto& term : terms_) {
      const auto& indices = term->coordinates();
      const PetscInt size = static_cast<PetscInt>(indices.size());
      TermMotion& w = workspace(indices.size());
      pick(indices, local_.q, w.q), pick(indices, local_.v, w.v), pick(indices, local_.a, w.a);
      w.J.setZero(size, size);
      term->tangent({t, w.q, w.v, w.a, ConstraintLevel::position}, weights, w.J);
      if (dense) {
        for (PetscInt j = 0; j < size; ++j)
          for (PetscInt i = 0; i < size; ++i) dense[indices[j] * n + indices[i]] += w.J(i, j);
        continue;
      }
      rows_.resize(size);
      for (PetscInt i = 0; i < size; ++i) rows_[i] = global[indices[i]];
      w.J.transposeInPlace();  // MatSetValues reads rows
      check(MatSetValues(J, size, rows_.data(), size, rows_.data(), w.J.data(), ADD_VALUES));
    }
  });
  if (dense) check(MatDenseRestoreArrayWrite(J, &dense));
  check(MatAssemblyBegin(J, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(J, MAT_FINAL_ASSEMBLY));
}

Energy System::energy(double t, Vec U, Vec V) const {
  gather(U, local_.q), gather(V, local_.v);
  local_.a.setZero(local_.q.size());
  Energy energy;
  for (const auto& term : terms_) {
    const auto& indices = term->coordinates();
    TermMotion& w = workspace(indices.size());
    pick(indices, local_.q, w.q), pick(indices, local_.v, w.v), pick(indices, local_.a, w.a);
    energy += term->energy({t, w.q, w.v, w.a, ConstraintLevel::position});
  }
  double sums[3] = {energy.kinetic, energy.elastic, energy.potential};
  if (!dense_) MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_DOUBLE, MPI_SUM, comm());
  return {sums[0], sums[1], sums[2]};
}

}  // namespace floe::dynamics
