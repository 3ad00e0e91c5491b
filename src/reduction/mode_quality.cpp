#include "mode_quality.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "floe/fem/field_rows.h"
#include "floe/petsc/values.h"
#include "floe/reduction/reduce.h"

namespace floe::reduction {

using petsc::check;

namespace {

/// A phi of each, zero at the conditions.
Columns multiplied(Mat A, const Columns& phi, const fem::Conditions& constrained) {
  Columns products;
  for (const auto& field : phi) {
    products.push_back(copy(field));
    check(MatMult(A, field, products.back()));
    fem::hold(products.back(), constrained);
  }
  return products;
}

}  // namespace

Transformation::Transformation(EPS eps, const Statics& statics, const fem::Conditions& constrained) {
  ST st = nullptr;
  PetscBool inverts = PETSC_FALSE;
  check(EPSGetST(eps, &st));
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(st), &inverts, STSINVERT, STCAYLEY, ""));
  if (inverts) {
    check(STGetKSP(st, &ksp));
    check(STGetShift(st, &shift));
  } else if (constrained == statics.conditions()) {
    ksp = statics.solver();
  }
}

std::vector<double> purify(const Transformation& inverse, Mat M, const fem::Conditions& constrained, Found& found) {
  const Columns products = multiplied(M, found.raw, constrained);
  Columns pure = block_solve(inverse.ksp, products);
  std::vector<double> errors;
  for (std::size_t i = 0; i < pure.size(); ++i) {
    const double lambda = found.lambda[i], factor = lambda - inverse.shift;
    check(VecAXPY(found.raw[i], -factor, pure[i]));  // what goes
    errors.push_back(std::abs(factor / lambda) * mass_norm(M, found.raw[i]));
    check(VecScale(pure[i], 1 / mass_norm(M, pure[i])));
  }
  found.raw = std::move(pure);
  return errors;
}

std::vector<double> residuals(const Transformation& inverse, Mat exact, Mat M, const fem::Conditions& constrained,
                              const Columns& phi, const std::vector<double>& lambda) {
  const Columns loads = multiplied(exact, phi, constrained), inertia = multiplied(M, phi, constrained);
  for (std::size_t i = 0; i < phi.size(); ++i) check(VecAXPY(loads[i], -lambda[i], inertia[i]));
  const Columns errors = block_solve(inverse.ksp, loads);
  std::vector<double> found;
  for (std::size_t i = 0; i < phi.size(); ++i)
    found.push_back(std::abs(lambda[i] - inverse.shift) / lambda[i] * mass_norm(M, errors[i]));
  return found;
}

std::vector<double> exact_values(const fem::ElementStiffness& K, Mat M, bool mix, const Columns& phi) {
  const fem::Structure& structure = K.structure();
  const Eigen::Index count = static_cast<Eigen::Index>(phi.size());
  const fem::FieldRows rows = fem::gather(structure, phi);
  const Eigen::MatrixXd stiffness = K.gram(rows);
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(count, count);
  const petsc::VecHandle product = fem::field(structure);
  for (Eigen::Index i = 0; i < count; ++i) {
    check(MatMult(M, phi[i], product));
    for (Eigen::Index j = mix ? 0 : i; j <= i; ++j) check(VecDot(phi[j], product, &mass(i, j)));
  }
  std::vector<double> lambda;
  if (!mix) {
    for (Eigen::Index i = 0; i < count; ++i) lambda.push_back(stiffness(i, i) / mass(i, i));
    return lambda;
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(stiffness, mass);
  const fem::FieldRows mixed = rows * ritz.eigenvectors();
  fem::for_each_field(structure, mixed, [&](Eigen::Index j, const double* local) {
    std::copy(local, local + structure.owned_dofs(), petsc::Values(phi[j]).begin());
    lambda.push_back(ritz.eigenvalues()[j]);
  });
  return lambda;
}

}  // namespace floe::reduction
