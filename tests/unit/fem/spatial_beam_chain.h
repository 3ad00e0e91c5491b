#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "eigenvalues.h"
#include "floe/fem/spatial_beam.h"
#include "floe/fem/transform.h"

namespace floe::testing {

/// A straight chain of equal beam elements of total length `length` along Q e_x, its sections' y along Q e_y, assembled
/// densely; dof i of node n is 6 n + i. Loads and displacements are spoken of in the axes Q.
struct BeamChain {
  Eigen::Matrix3d Q;
  std::vector<fem::BeamPlace> places;
  std::vector<fem::ElementMaps> elements;
  std::vector<int> free;
  int nodes() const { return static_cast<int>(elements.size()) + 1; }
  int dofs() const { return 6 * nodes(); }
};

inline Eigen::Matrix3d some_rotation() {
  return Eigen::AngleAxisd(0.9, Eigen::Vector3d(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
}

/// diag(Q, Q, ...): dofs in the axes Q -> in body axes.
inline Eigen::MatrixXd rotation_dofs(const Eigen::Matrix3d& Q, int nodes) {
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(6 * nodes, 6 * nodes);
  for (int i = 0; i < 2 * nodes; ++i) T.block<3, 3>(3 * i, 3 * i) = Q;
  return T;
}

/// Elements are rotated into the axes Q, so that a support may hold a direction of these.
inline BeamChain beam_chain(int n, double length, const fem::SpatialBeamSection& section,
                            const std::vector<int>& constrained, const fem::SpatialBeamStrain& strain = {},
                            const Eigen::Matrix3d& Q = Eigen::Matrix3d::Identity()) {
  BeamChain chain;
  chain.Q = Q;
  for (int e = 0; e < n; ++e) {
    const Eigen::Vector3d x = Q.col(0);
    chain.places.push_back({length * e / n * x, length * (e + 1) / n * x, Q.col(1)});
    chain.elements.push_back(
        fem::transformed(fem::spatial_beam(chain.places.back(), section, strain), rotation_dofs(Q, 2)));
  }
  for (int i = 0; i < chain.dofs(); ++i)
    if (std::find(constrained.begin(), constrained.end(), i) == constrained.end()) chain.free.push_back(i);
  return chain;
}

inline const std::vector<int> clamped_root{0, 1, 2, 3, 4, 5};

template <class OfElement>
Eigen::MatrixXd assembled(const BeamChain& chain, const OfElement& matrix) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(chain.dofs(), chain.dofs());
  for (std::size_t e = 0; e < chain.elements.size(); ++e) sum.block<12, 12>(6 * e, 6 * e) += matrix(chain.elements[e]);
  return sum(chain.free, chain.free);
}
inline Eigen::MatrixXd chain_stiffness(const BeamChain& chain) {
  return assembled(chain, [](const fem::ElementMaps& maps) { return maps.stiffness(); });
}
inline Eigen::MatrixXd chain_mass(const BeamChain& chain) {
  return assembled(chain, [](const fem::ElementMaps& maps) { return maps.mass_matrix(); });
}

inline Eigen::VectorXd spread(const BeamChain& chain, const Eigen::VectorXd& of_free) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(chain.dofs());
  q(chain.free) = of_free;
  return q;
}

/// A load on the last node.
inline Eigen::VectorXd tip_load(const BeamChain& chain, const Eigen::Matrix<double, 6, 1>& load) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(chain.dofs());
  f.tail<6>() = load;
  return f;
}

inline Eigen::VectorXd linear_deflection(const BeamChain& chain, const Eigen::VectorXd& load) {
  const Eigen::VectorXd f = load(chain.free);
  return spread(chain, chain_stiffness(chain).ldlt().solve(f));
}

/// Newton's method; gives the displacements where the residual falls below 1e-11 of the load.
inline Eigen::VectorXd nonlinear_deflection(const BeamChain& chain, const Eigen::VectorXd& load,
                                            Eigen::VectorXd q = {}) {
  std::vector<body::Elasticity> elasticity;
  for (const auto& maps : chain.elements)
    elasticity.push_back(fem::elasticity(maps, Eigen::MatrixXd::Identity(12, 12)));
  body::ElasticityWork work;
  if (q.size() == 0) q = Eigen::VectorXd::Zero(chain.dofs());
  for (int iteration = 0; iteration < 60; ++iteration) {
    Eigen::VectorXd r = -load;
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(chain.dofs(), chain.dofs());
    for (std::size_t e = 0; e < elasticity.size(); ++e) {
      const Eigen::VectorXd qe = q.segment<12>(6 * e);
      Eigen::VectorXd fe = Eigen::VectorXd::Zero(12);
      Eigen::MatrixXd Ke = Eigen::MatrixXd::Zero(12, 12);
      body::add_force(elasticity[e], qe, work, fe);
      body::add_tangent(elasticity[e], qe, 1, work, Ke);
      r.segment<12>(6 * e) += fe;
      K.block<12, 12>(6 * e, 6 * e) += Ke;
    }
    const Eigen::VectorXd rf = r(chain.free);
    const Eigen::MatrixXd Kf = K(chain.free, chain.free);
    const Eigen::VectorXd step = Kf.ldlt().solve(rf);
    q -= spread(chain, step);
    if (step.norm() < 1e-11 * q.norm()) return q;
  }
  return Eigen::VectorXd::Constant(chain.dofs(), std::nan(""));
}

/// Lowest natural frequencies [rad/s], ascending. K is definite, M may be only semi-definite: 1/omega^2 of (M, K).
inline Eigen::VectorXd chain_frequencies(const BeamChain& chain) {
  const Eigen::VectorXd lambda = eigenvalues(chain_mass(chain), chain_stiffness(chain));
  return lambda.reverse().cwiseMax(1e-300).cwiseInverse().cwiseSqrt();
}

}  // namespace floe::testing
