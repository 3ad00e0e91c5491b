#pragma once
#include <cmath>

#include "floe/dynamics/floating_body.h"
#include "floe/dynamics/joints.h"
#include "floe/dynamics/system.h"
#include "floe/petsc/values.h"

namespace floe::testing {

using Terms = std::vector<std::unique_ptr<dynamics::Term>>;

/// A uniform rigid rod of mass m and length l, its frame at one end, x along it.
inline std::unique_ptr<dynamics::FloatingBody> rigid_rod(double m, double l) {
  body::PlanarInertia in = body::planar(body::Inertia(2, 0));
  in.m = m, in.s0 << m * l / 2, 0, in.C0 = m * l * l / 3;
  return std::make_unique<dynamics::FloatingBody>(std::vector<int>{0, 1, 2}, in,
                                                  body::Elasticity{Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 0), {}});
}

/// A place on the rod, `along` from its frame.
inline dynamics::Marker on_rod(double along) {
  dynamics::Marker marker;
  marker.framed = true;
  marker.coordinates = {0, 1, 2};
  marker.x << along, 0;
  marker.S.resize(2, 0);
  marker.psi.resize(0);
  return marker;
}

inline std::unique_ptr<dynamics::Force> weight(double m, double l, double g) {
  dynamics::Marker whole = on_rod(m * l / 2);
  whole.mass = m;
  auto force = std::make_unique<dynamics::Force>(
      whole, [g](double) { return Eigen::Vector3d(0, -g, 0); }, dynamics::Force::Axes::world);
  force->conservative = true;
  return force;
}

inline std::unique_ptr<dynamics::Joint> to_ground(const dynamics::Marker& place, const dynamics::Constraint& constraint,
                                                  int multipliers = 3) {
  return std::make_unique<dynamics::Joint>(dynamics::Marker::ground({0, 0}), place, constraint, multipliers);
}

/// The rod on a hinge at the origin, under gravity: unknowns (R_x, R_y, theta, lambda_x, lambda_y).
inline dynamics::System pendulum(double m, double l, double g, Terms more = {}) {
  dynamics::Coordinates coordinates(PETSC_COMM_SELF);
  coordinates.add_shared(3);
  coordinates.add_shared(2, true);
  coordinates.number();
  Terms terms = std::move(more);
  terms.push_back(rigid_rod(m, l));
  terms.push_back(weight(m, l, g));
  terms.push_back(to_ground(on_rod(0), dynamics::Revolute{}));
  return {std::move(coordinates), std::move(terms)};
}

inline petsc::VecHandle vector_of(const dynamics::System& system, const std::vector<double>& values) {
  petsc::VecHandle vector = system.create_vector();
  petsc::Values own(vector);
  for (PetscInt i = own.first; i < own.end; ++i) own[i] = values[i];
  return vector;
}

inline Eigen::VectorXd numbers_of(Vec vector) {
  petsc::Values values(vector);
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), values.end);
}

}  // namespace floe::testing
