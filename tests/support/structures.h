#pragma once
#include "floe/fem/reference_frame.h"
#include "floe/petsc/values.h"

namespace floe::testing {

/// The section of Wu & Tiso's cantilever (L = 100): EA = 1.12e6, EI = 9.36e6, rhoA = .546, rhoI = 4.563.
inline fem::BeamSection paper_section() { return {1.12e6, 9.36e6, 0.546, 4.563}; }

/// A straight beam along x from the origin.
inline fem::Structure straight(MPI_Comm comm, PetscInt elements, double length, const fem::BeamSection& section,
                               fem::MembraneStrain strain = fem::MembraneStrain::averaged) {
  const fem::Segments line{{{0, 0, 0}, {length, 0, 0}}, {{0, 1}}, {elements}};
  return fem::planar_structure(fem::mesh_of(comm, line), {section}, strain);
}

/// Along x from the origin to (a, 0), then up to (a, b).
inline fem::Segments l_shape(double a, double b, PetscInt elements) {
  return {{{0, 0, 0}, {a, 0, 0}, {a, b, 0}}, {{0, 1}, {1, 2}}, {elements, elements}};
}

/// All entries on every rank. Collective.
inline Eigen::VectorXd everywhere(Vec field) {
  petsc::VecHandle all;
  petsc::ScatterHandle scatter;
  petsc::check(VecScatterCreateToAll(field, scatter.out(), all.out()));
  petsc::check(VecScatterBegin(scatter, field, all, INSERT_VALUES, SCATTER_FORWARD));
  petsc::check(VecScatterEnd(scatter, field, all, INSERT_VALUES, SCATTER_FORWARD));
  petsc::Values values(all);
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), values.end);
}

/// Each rank takes its own entries of `values`, which all ranks know.
inline void set(Vec field, const Eigen::VectorXd& values) {
  petsc::Values own(field);
  for (PetscInt i = own.first; i < own.end; ++i) own[i] = values[i];
}

inline petsc::VecHandle field_of(const fem::Structure& structure, const Eigen::VectorXd& values) {
  petsc::VecHandle field = fem::field(structure);
  set(field, values);
  return field;
}

/// A x on every rank. Collective.
inline Eigen::VectorXd product(Mat A, Vec x) {
  petsc::VecHandle y;
  petsc::check(VecDuplicate(x, y.out()));
  petsc::check(MatMult(A, x, y));
  return everywhere(y);
}

/// x'A y. Collective.
inline double form(Mat A, Vec x, Vec y) { return everywhere(x).dot(product(A, y)); }

inline int ranks() {
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return size;
}
inline int this_rank() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

}  // namespace floe::testing
