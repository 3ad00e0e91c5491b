#pragma once
#include "differences.h"
#include "floe/dynamics/marker.h"
#include "random.h"

namespace floe::testing {

/// A term at a state of its own coordinates.
struct State {
  Eigen::VectorXd q, v, a;
  double t = 0.3;

  State(Random& random, Eigen::Index size) : q(random.vector(size)), v(random.vector(size)), a(random.vector(size)) {}
};

inline Eigen::VectorXd rows_of(const dynamics::Term& term, const State& s,
                               dynamics::ConstraintLevel level = dynamics::ConstraintLevel::position) {
  Eigen::VectorXd r = Eigen::VectorXd::Zero(s.q.size());
  term.residual({s.t, s.q, s.v, s.a, level}, r);
  return r;
}

inline Eigen::MatrixXd tangent_of(const dynamics::Term& term, const State& s, dynamics::Weights weights) {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(s.q.size(), s.q.size());
  term.tangent({s.t, s.q, s.v, s.a}, weights, J);
  return J;
}

/// The tangent by differences; rows and columns of the last `multipliers` unknowns have weight 1.
inline Eigen::MatrixXd difference_tangent(const dynamics::Term& term, const State& s, dynamics::Weights weights,
                                          int multipliers = 0) {
  const double h = 1e-3;
  auto along = [&](Eigen::VectorXd State::*rate) {
    return jacobian(
        [&](const Eigen::VectorXd& x) {
          State moved = s;
          moved.*rate = x;
          return rows_of(term, moved);
        },
        s.*rate, h);
  };
  const Eigen::MatrixXd by_q = along(&State::q);
  Eigen::MatrixXd J = weights.q * by_q + weights.v * along(&State::v) + weights.a * along(&State::a);
  J.bottomRows(multipliers) = by_q.bottomRows(multipliers);
  J.rightCols(multipliers) = by_q.rightCols(multipliers);
  return J;
}

/// Greatest error of the tangent over weights in q, v and a alone and together.
inline double tangent_error(const dynamics::Term& term, const State& s, int multipliers = 0) {
  double greatest = 0;
  for (const dynamics::Weights& w : {dynamics::Weights{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 30, 900}})
    greatest = std::max(greatest, relative_error(tangent_of(term, s, w), difference_tangent(term, s, w, multipliers)));
  return greatest;
}

/// A smooth motion through many directions: q_i = b_i sin(w_i t + c_i), with its rates.
struct SmoothMotion {
  Eigen::ArrayXd amplitude, frequency, phase;
  SmoothMotion(Random& random, Eigen::Index size)
      : amplitude(random.vector(size)), frequency(2 * random.vector(size)), phase(3 * random.vector(size)) {}
  Eigen::VectorXd q(double t) const { return amplitude * (frequency * t + phase).sin(); }
  Eigen::VectorXd v(double t) const { return amplitude * frequency * (frequency * t + phase).cos(); }
  Eigen::VectorXd a(double t) const { return -amplitude * frequency.square() * (frequency * t + phase).sin(); }
};

/// A place of a body with frame and two elastic coordinates, the body's coordinates beginning at `first`.
inline dynamics::Marker framed_marker(Random& random, int first) {
  dynamics::Marker marker;
  marker.framed = true;
  for (int i = 0; i < 5; ++i) marker.coordinates.push_back(first + i);
  marker.x = random.vector(2);
  marker.angle0 = random.number();
  marker.S = random.matrix(2, 2);
  marker.psi = random.matrix(1, 2);
  return marker;
}

/// A node of a body in world axes: (u, v, rotation) from `first`.
inline dynamics::Marker node_marker(Random& random, int first) {
  dynamics::Marker marker;
  marker.coordinates = {first, first + 1, first + 2};
  marker.x = random.vector(2);
  marker.angle0 = random.number();
  marker.S = Eigen::Matrix<double, 2, 3>::Identity();
  marker.psi = Eigen::RowVector3d(0, 0, 1);
  return marker;
}

/// Two places as joints and springs meet them: of two bodies, of one body, with the ground on either side, on a node.
inline std::vector<std::pair<dynamics::Marker, dynamics::Marker>> place_pairs() {
  Random random(7);
  const dynamics::Marker one = framed_marker(random, 0), same = framed_marker(random, 0),
                         other = framed_marker(random, 5), node = node_marker(random, 10),
                         ground = dynamics::Marker::ground(random.vector(2), random.number());
  return {{one, other}, {one, same}, {one, ground}, {ground, one}, {node, one}, {one, node}};
}

}  // namespace floe::testing
