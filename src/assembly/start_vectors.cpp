#include "floe/assembly/start_vectors.h"

#include <cmath>
#include <functional>

#include "floe/assembly/body_stage.h"
#include "floe/assembly/combination.h"
#include "floe/assembly/enrichment.h"
#include "floe/body/elasticity.h"
#include "floe/fem/assembly.h"
#include "floe/fem/element_stiffness.h"

namespace floe::assembly {

using petsc::check;

namespace {

constexpr double limit = 0.01;  // in the norm of the energy

using Norm = std::function<double(Vec)>;

/// sqrt(2 U) of a shape, at most its |u|_K: what a deflection foreshortens a body by takes no energy together with it,
/// and much alone.
double size_of_shape(const PlannedBody& body, Vec shape, double linear) {
  if (body.spec.reduction.linear || !(linear > 0)) return linear;
  reduction::Columns alone;
  alone.push_back(reduction::copy(shape));
  const reduction::Basis basis = reduction::orthonormal_basis(body.structure, alone, {{}}, 0);
  if (basis.columns == 0) return linear;
  const Eigen::VectorXd eta = Eigen::VectorXd::Constant(1, basis.norms[0]);
  return std::min(linear, std::sqrt(2 * body::energy(reduction::project(body.structure, basis).elasticity, eta)));
}

/// field - V V'M field.
petsc::VecHandle remainder(const reduction::Basis& basis, Vec field) {
  petsc::VecHandle rest = reduction::copy(field);
  if (basis.columns == 0) return rest;
  Eigen::VectorXd coordinates(basis.columns);
  check(BVDotVec(basis.V, field, coordinates.data()));
  const petsc::VecHandle part = reduction::copy(field);
  combine(basis, coordinates, part);
  check(VecAXPY(rest, -1, part));
  return rest;
}

void join(const PlannedBody& body, Vec field, double whole, const Norm& norm, const char* label, ReducedBody& reduced) {
  reduction::Columns rest;
  rest.push_back(remainder(*reduced.basis, field));
  const double part = norm(rest.front());
  if (!(part > limit * whole)) return;
  ReducedBody more = with_columns(body, reduced, rest);
  if (more.body.coordinates() == reduced.body.coordinates()) return;  // round-off of the basis
  more.statics = reduced.statics;
  finish_elasticity(body, more);
  more.report.origins.push_back({reduction::ColumnOrigin::Kind::attachment, label});
  more.report.origins.back().new_part = part / whole;
  reduced = std::move(more);
}

}  // namespace

void join_start(const PlannedBody& body, ReducedBody& reduced) {
  if (!starts_deformed(body)) return;
  const fem::ElementStiffness K(body.structure);
  const petsc::MatHandle M = fem::mass(body.structure, {});
  const Norm elastic = [&](Vec field) { return std::sqrt(2 * std::abs(K.strain_energy(field))); };
  const Norm kinetic = [&](Vec field) { return reduction::mass_norm(M, field); };
  if (Vec shape = body.deformation)
    join(body, shape, size_of_shape(body, shape, elastic(shape)), elastic, "start shape", reduced);
  if (Vec rate = body.deformation_rate) join(body, rate, kinetic(rate), kinetic, "start rate", reduced);
}

bool starts_deformed(const PlannedBody& body) {
  if (body.spec.rigid || body.spec.reduced) return false;
  double size = 0, rate = 0;
  if (body.deformation) check(VecNorm(body.deformation, NORM_INFINITY, &size));
  if (body.deformation_rate) check(VecNorm(body.deformation_rate, NORM_INFINITY, &rate));
  return size > 0 || rate > 0;
}

}  // namespace floe::assembly
