#include "floe/assembly/start_vectors.h"

#include <cmath>
#include <functional>

#include "floe/assembly/combination.h"
#include "floe/assembly/enrichment.h"
#include "floe/fem/assembly.h"
#include "floe/fem/element_stiffness.h"

namespace floe::assembly {

using petsc::check;

namespace {

constexpr double limit = 0.01;  // in the norm of the energy

using Norm = std::function<double(Vec)>;

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

void join(const PlannedBody& body, Vec field, const Norm& norm, const char* label, ReducedBody& reduced) {
  if (!field) return;
  const double whole = norm(field);
  reduction::Columns rest;
  rest.push_back(remainder(*reduced.basis, field));
  const double part = norm(rest.front());
  if (!(part > limit * whole)) return;
  ReducedBody more = with_columns(body, reduced, rest);
  if (more.body.coordinates() == reduced.body.coordinates()) return;  // round-off of the basis
  if (body.spec.reduction.linear) more.body.elasticity = body::linearised(more.body.elasticity);
  more.statics = reduced.statics;
  more.report.origins.push_back({reduction::ColumnOrigin::Kind::attachment, label});
  more.report.origins.back().new_part = part / whole;
  reduced = std::move(more);
}

}  // namespace

void join_start(const PlannedBody& body, ReducedBody& reduced) {
  if (!starts_deformed(body)) return;
  const fem::ElementStiffness K(body.structure);
  const petsc::MatHandle M = fem::mass(body.structure, {});
  join(
      body, body.deformation, [&](Vec field) { return std::sqrt(2 * std::abs(K.strain_energy(field))); }, "start shape",
      reduced);
  join(
      body, body.deformation_rate, [&](Vec field) { return reduction::mass_norm(M, field); }, "start rate", reduced);
}

bool starts_deformed(const PlannedBody& body) {
  if (body.spec.rigid || body.spec.reduced) return false;
  double size = 0, rate = 0;
  if (body.deformation) check(VecNorm(body.deformation, NORM_INFINITY, &size));
  if (body.deformation_rate) check(VecNorm(body.deformation_rate, NORM_INFINITY, &rate));
  return size > 0 || rate > 0;
}

}  // namespace floe::assembly
