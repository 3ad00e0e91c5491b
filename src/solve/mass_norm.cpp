#include "mass_norm.h"

#include <cmath>

#include "floe/petsc/values.h"

namespace floe::solve {

using petsc::check;

petsc::VecHandle root_masses(const System& system, double t, Vec U, Vec V) {
  const petsc::VecHandle A = system.create_vector();
  petsc::VecHandle root = system.create_vector();
  const petsc::MatHandle M = system.create_tangent(), rest = system.create_tangent();
  const petsc::VecHandle other = system.create_vector();
  system.tangent(t, U, V, A, {0, 0, 1}, M);
  system.tangent(t, U, V, A, {0, 0, 0}, rest);  // what no weight scales
  check(MatGetDiagonal(M, root));
  check(MatGetDiagonal(rest, other));
  check(VecAXPY(root, -1, other));
  petsc::Values values(root);
  for (PetscInt i = values.first; i < values.end; ++i) values[i] = values[i] > 0 ? std::sqrt(values[i]) : 0;
  return root;
}

double weighted_product(Vec a, Vec b, Vec weights) {
  petsc::VecHandle p, q;
  double product = 0;
  check(VecDuplicate(a, p.out()));
  check(VecDuplicate(b, q.out()));
  check(VecPointwiseMult(p, a, weights));
  check(VecPointwiseMult(q, b, weights));
  check(VecDot(p, q, &product));
  return product;
}

double weighted_size(Vec change, Vec weights) { return std::sqrt(weighted_product(change, change, weights)); }

}  // namespace floe::solve
