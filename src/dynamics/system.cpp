#include "floe/dynamics/system.h"

#include <algorithm>
#include <cmath>

namespace floe::dynamics {
namespace {

void pick_from(const std::vector<int>& indices, const Eigen::VectorXd& from, Eigen::VectorXd& to) {
  to.resize(static_cast<Eigen::Index>(indices.size()));
  for (std::size_t i = 0; i < indices.size(); ++i) to[i] = from[indices[i]];
}

}  // namespace

System::System(Coordinates coordinates, std::vector<std::unique_ptr<Term>> terms, Attitudes attitudes)
    : coordinates_(std::move(coordinates)), terms_(std::move(terms)), attitudes_(std::move(attitudes)) {
  const auto& global = coordinates_.global();
  identity_ = coordinates_.owned_size() == coordinates_.local_size();
  for (std::size_t i = 0; identity_ && i < global.size(); ++i) identity_ = global[i] == static_cast<PetscInt>(i);
  int all = 0;
  const int mine = identity_;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_LAND, comm());
  identity_ = all;
  const int rotations = !attitudes_.empty();
  MPI_Allreduce(&rotations, &all, 1, MPI_INT, MPI_LOR, comm());
  has_attitudes_ = all;
  int ranks = 1;
  MPI_Comm_size(comm(), &ranks);
  whole_ = ranks == 1;

  std::size_t largest = 0;
  double filled = 0;
  for (const auto& term : terms_) {
    const std::size_t size = term->coordinates().size();
    largest = std::max(largest, size);
    constrains_.push_back(std::any_of(term->coordinates().begin(), term->coordinates().end(),
                                      [&](int index) { return coordinates_.multiplier()[index]; }));
    filled += static_cast<double>(size) * static_cast<double>(size);
  }
  const double unknowns = static_cast<double>(coordinates_.global_size());
  dense_ = whole_ && identity_ && filled >= 0.5 * unknowns * unknowns;
  work_.resize(largest + 1);
  sum_.resize(coordinates_.local_size());
  if (!identity_ && !whole_) set_up_scatter();
  set_up_corotated();
}

void System::set_up_scatter() {
  using petsc::check;
  check(VecCreateSeq(PETSC_COMM_SELF, coordinates_.local_size(), staging_.out()));
  petsc::IsHandle from;
  check(
      ISCreateGeneral(comm(), coordinates_.local_size(), coordinates_.global().data(), PETSC_COPY_VALUES, from.out()));
  const petsc::VecHandle vector = create_vector();
  check(VecScatterCreate(vector, from, staging_, nullptr, scatter_.out()));
}

System::TermWork& System::pick(const Term& term) const {
  const auto& indices = term.coordinates();
  TermWork& work = work_[indices.size()];
  pick_from(indices, local_.q, work.q);
  pick_from(indices, local_.v, work.v);
  pick_from(indices, local_.a, work.a);
  return work;
}

petsc::VecHandle System::create_vector() const {
  petsc::VecHandle vector;
  if (whole_)
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
  check(MatSetOption(J, MAT_ROW_ORIENTED, PETSC_FALSE));  // as Eigen stores what tangent() adds
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
  const bool permuted = whole_ && !identity_;
  if (!whole_ && !identity_) {
    check(VecScatterBegin(scatter_, global, staging_, INSERT_VALUES, SCATTER_FORWARD));
    check(VecScatterEnd(scatter_, global, staging_, INSERT_VALUES, SCATTER_FORWARD));
    global = staging_;
  }
  check(VecGetArrayRead(global, &values));
  local.resize(coordinates_.local_size());
  const auto& where = coordinates_.global();
  for (Eigen::Index i = 0; i < local.size(); ++i) local[i] = values[permuted ? where[i] : i];
  check(VecRestoreArrayRead(global, &values));
}

void System::give(const Eigen::VectorXd& local, Vec global) const {
  using petsc::check;
  double* values = nullptr;
  const bool permuted = whole_ && !identity_, scattered = !whole_ && !identity_;
  const Vec target = scattered ? static_cast<Vec>(staging_) : global;
  check(VecGetArrayWrite(target, &values));
  const auto& where = coordinates_.global();
  for (Eigen::Index i = 0; i < local.size(); ++i) values[permuted ? where[i] : i] = local[i];
  check(VecRestoreArrayWrite(target, &values));
  if (!scattered) return;
  check(VecSet(global, 0));
  check(VecScatterBegin(scatter_, staging_, global, ADD_VALUES, SCATTER_REVERSE));
  check(VecScatterEnd(scatter_, staging_, global, ADD_VALUES, SCATTER_REVERSE));
}

void System::add_rows(double t, ConstraintLevel level, Which which) const {
  sum_.setZero();
  petsc::agree_if_parallel(comm(), whole_, [&] {
    for (std::size_t term = 0; term < terms_.size(); ++term) {
      if (which == Which::constraining && !constrains_[term]) continue;
      const auto& indices = terms_[term]->coordinates();
      TermWork& w = pick(*terms_[term]);
      w.r.setZero(w.q.size());
      terms_[term]->residual({t, w.q, w.v, w.a, level}, w.r);
      for (std::size_t i = 0; i < indices.size(); ++i) sum_[indices[i]] += w.r[i];
    }
  });
}

void System::residual(double t, Vec U, Vec V, Vec A, ConstraintLevel level, Vec F) const {
  gather(U, local_.q), gather(V, local_.v), gather(A, local_.a);
  add_rows(t, level, Which::all);
  give(sum_, F);
}

double System::constraint_violation(double t, Vec U, Vec V, ConstraintLevel level) const {
  using petsc::check;
  gather(U, local_.q), gather(V, local_.v);
  local_.a.setZero(local_.q.size());
  add_rows(t, level, Which::constraining);
  const auto& is_multiplier = coordinates_.multiplier();
  double greatest = 0;
  if (whole_) {
    for (Eigen::Index i = 0; i < sum_.size(); ++i)
      if (is_multiplier[i]) greatest = std::max(greatest, std::abs(sum_[i]));
    return greatest;
  }
  const petsc::VecHandle rows = create_vector();  // a row may have its parts on several ranks
  give(sum_, rows);
  const double* values = nullptr;
  PetscInt first = 0;
  check(VecGetOwnershipRange(rows, &first, nullptr));
  check(VecGetArrayRead(rows, &values));
  for (PetscInt row : coordinates_.owned_multipliers()) greatest = std::max(greatest, std::abs(values[row - first]));
  check(VecRestoreArrayRead(rows, &values));
  MPI_Allreduce(MPI_IN_PLACE, &greatest, 1, MPI_DOUBLE, MPI_MAX, comm());
  return greatest;
}

System::FailedConstraint System::failed_constraint(double t, Vec U) const {
  gather(U, local_.q);
  local_.v.setZero(local_.q.size()), local_.a.setZero(local_.q.size());
  const auto& is_multiplier = coordinates_.multiplier();
  int code = -1;  // of owner, whose number all ranks know, whether it is the joint's body, and constraint status
  for (std::size_t term = 0; term < terms_.size() && code < 0; ++term) {
    if (!constrains_[term] && !terms_[term]->has_left_out_rows()) continue;
    const TermWork& w = pick(*terms_[term]);
    const ConstraintStatus constraint_status = terms_[term]->constraint_status({t, w.q, w.v, w.a});
    if (constraint_status == ConstraintStatus::satisfied) continue;
    const auto& indices = terms_[term]->coordinates();
    const auto own = std::find_if(indices.begin(), indices.end(), [&](int index) { return is_multiplier[index]; });
    const bool of_body = own == indices.end();  // it has no multiplier left
    const int owner = coordinates_.owner_of_local()[of_body ? indices.front() : *own];
    code = 6 * owner + 3 * of_body + static_cast<int>(constraint_status);
  }
  if (!whole_) MPI_Allreduce(MPI_IN_PLACE, &code, 1, MPI_INT, MPI_MAX, comm());
  if (code < 0) return {};
  const std::string& owner = coordinates_.owners()[code / 6];
  return {code % 6 >= 3 ? "a joint of " + owner : owner, static_cast<ConstraintStatus>(code % 3)};
}

std::string System::FailedConstraint::text() const {
  if (constraint_status == ConstraintStatus::flipped_branch)
    return joint + " is satisfied on the flipped branch (rotated by 180 deg)";
  return joint +
         " is violated: some of its constraints were eliminated as redundant with other joints, and these "
         "no longer imply them";
}

void System::tangent(double t, Vec U, Vec V, Vec A, Weights weights, Mat J) const {
  gather(U, local_.q), gather(V, local_.v), gather(A, local_.a);
  assemble(
      t, [&](const Term&) { return weights; }, J);
}

void System::damped_mass(double t, Vec U, double h, Mat J, bool lasting) const {
  gather(U, local_.q);
  local_.v.setZero(local_.q.size()), local_.a.setZero(local_.q.size());
  assemble(
      t,
      [h, lasting](const Term& term) {
        const double beta = term.strain_damping();
        if (!(beta > 0)) return Weights{0, 0, 1};
        return Weights{0, lasting ? h / (1 + std::pow(h / (12 * beta), 6)) : h, 1};
      },
      J);
}

bool System::damps_strains() const {
  int any = std::any_of(terms_.begin(), terms_.end(), [](const auto& term) { return term->strain_damping() > 0; });
  if (!whole_) petsc::check(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, comm()));
  return any != 0;
}

void System::assemble(double t, const std::function<Weights(const Term&)>& weights, Mat J) const {
  using petsc::check;
  double* dense = nullptr;
  const PetscInt n = coordinates_.owned_size();
  if (dense_) {
    check(MatDenseGetArrayWrite(J, &dense));
    std::fill(dense, dense + std::ptrdiff_t(n) * n, 0.0);
  } else {
    check(MatZeroEntries(J));
  }
  const auto& global = coordinates_.global();
  petsc::agree_if_parallel(comm(), whole_, [&] {
    for (const auto& term : terms_) {
      const auto& indices = term->coordinates();
      const PetscInt size = static_cast<PetscInt>(indices.size());
      TermWork& w = pick(*term);
      w.J.setZero(size, size);
      term->tangent({t, w.q, w.v, w.a, ConstraintLevel::position}, weights(*term), w.J);
      rows_.resize(size);
      for (PetscInt i = 0; i < size; ++i) rows_[i] = global[indices[i]];
      if (dense) {
        for (PetscInt j = 0; j < size; ++j) {
          double* column = dense + std::ptrdiff_t(rows_[j]) * n;
          for (PetscInt i = 0; i < size; ++i) column[rows_[i]] += w.J(i, j);
        }
        continue;
      }
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
    const TermWork& w = pick(*term);
    energy += term->energy({t, w.q, w.v, w.a, ConstraintLevel::position});
  }
  double sums[3] = {energy.kinetic, energy.elastic, energy.potential};
  if (!whole_) MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_DOUBLE, MPI_SUM, comm());
  return {sums[0], sums[1], sums[2]};
}

}  // namespace floe::dynamics
