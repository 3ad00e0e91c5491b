#pragma once
#include "floe/petsc/handle.h"

namespace floe::petsc {

/// This rank's entries of a Vec, indexed globally, for as long as the view lives.
class Values {
 public:
  explicit Values(Vec vec) : vec_(vec) {
    check(VecGetOwnershipRange(vec, &first, &end));
    check(VecGetArray(vec, &data_));
  }
  Values(const Values&) = delete;
  Values& operator=(const Values&) = delete;
  ~Values() { VecRestoreArray(vec_, &data_); }
  double& operator[](PetscInt global) { return data_[global - first]; }
  double* begin() { return data_; }

  PetscInt first = 0, end = 0;

 private:
  Vec vec_;
  double* data_ = nullptr;
};

/// The same to read only.
class ConstValues {
 public:
  explicit ConstValues(Vec vec) : vec_(vec) {
    PetscInt end = 0;
    check(VecGetOwnershipRange(vec, &first_, &end));
    check(VecGetArrayRead(vec, &data_));
  }
  ConstValues(const ConstValues&) = delete;
  ConstValues& operator=(const ConstValues&) = delete;
  ~ConstValues() { VecRestoreArrayRead(vec_, &data_); }
  double operator[](PetscInt global) const { return data_[global - first_]; }

 private:
  Vec vec_;
  PetscInt first_ = 0;
  const double* data_ = nullptr;
};

}  // namespace floe::petsc
