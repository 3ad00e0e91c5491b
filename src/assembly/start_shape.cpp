#include "start_shape.h"

#include <algorithm>
#include <cmath>

#include "floe/petsc/values.h"

namespace floe::assembly {

using Eigen::Vector3d;
using petsc::check;

namespace {

/// Of the mean of the place's nodes. Collective.
Vector3d displacement_at(const PlannedBody& body, const Anchor& place, Vec shape) {
  const int n = body.structure.dofs_per_node, d = body.structure.dimension();
  Vector3d u = Vector3d::Zero();
  {
    petsc::Values own(shape);
    for (const AveragingWeight& weight : place.moved_by()) {
      const PetscInt first = n * weight.node;
      if (first < own.first || first >= own.end) continue;
      for (int i = 0; i < d; ++i) u[i] += weight.share * own[first + i];
      if (d == 3) u += weight.arm * Vector3d(own[first + 3], own[first + 4], own[first + 5]);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, u.data(), 3, MPI_DOUBLE, MPI_SUM, body.structure.mesh.comm);
  return u;
}

/// Both of a joint, or those of all interface vectors.
std::vector<Anchor> places_of(const Plan& plan, std::size_t j) {
  std::vector<Anchor> all{plan.joints[j][0], plan.joints[j][1]};
  if (plan.interfaces.empty() || plan.interfaces[j].empty()) return all;
  for (Eigen::Index vector = 1; vector < plan.interfaces[j].whole(); ++vector)
    for (int side : {0, 1}) all.push_back(plan.interfaces[j].sum(side, vector));
  return all;
}

}  // namespace

Eigen::VectorXd start_shape(const Plan& plan, int b, const ReducedBody& reduced, Vec shape) {
  const PlannedBody& body = plan.bodies[b];
  const Eigen::Index k = reduced.body.coordinates(), d = body.structure.dimension();
  Eigen::VectorXd eta = Eigen::VectorXd::Zero(k);
  if (k == 0 || !shape) return eta;
  check(BVDotVec(reduced.basis->V, shape, eta.data()));
  Eigen::MatrixXd S(0, k);
  Eigen::VectorXd wanted(0);
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const Joint::Kind kind = plan.scene.joints[j].kind;
    if (kind == Joint::Kind::spring || kind == Joint::Kind::bushing) continue;
    for (const Anchor& place : places_of(plan, j)) {
      if (place.body != b) continue;
      S.conservativeResize(S.rows() + d, k), wanted.conservativeResize(wanted.size() + d);
      S.bottomRows(d) = place_map(plan, reduced, place).S.topRows(d);
      wanted.tail(d) = displacement_at(body, place, shape).head(d);
    }
  }
  const double small = 1e-9 / std::sqrt(reduced.body.inertia.m);  // columns are normalised to unit mass
  S = (S.array().abs() > small).select(S, 0.0);
  if (S.rows() == 0 || S.isZero(0)) return eta;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> least;
  least.setThreshold(1e-6);
  return eta + least.compute(S).solve(wanted - S * eta);
}

std::string expected_to_meet(const Plan& plan, Formulation formulation, std::size_t joint) {
  const auto shaped = [&](const Anchor& place) { return place.body >= 0 && plan.bodies[place.body].deformation; };
  const auto& places = plan.joints[joint];
  if (!is_reduced(formulation) || std::none_of(places.begin(), places.end(), shaped)) return "the same point";
  return "the same point; the initial deformation is projected onto the basis, which may be too small (attachment: "
         "joints, or more modes or derivatives)";
}

}  // namespace floe::assembly
