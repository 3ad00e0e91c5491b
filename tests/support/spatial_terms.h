#pragma once
#include "floe/dynamics/spatial_marker.h"
#include "terms.h"

namespace floe::testing {

/// A matrix of two or three elastic coordinates of a place, moderate rotations.
inline void add_elastic(Random& random, int k, dynamics::SpatialMarker& marker, int first) {
  for (int i = 0; i < k; ++i) marker.coordinates.push_back(first + i);
  marker.S = random.matrix(3, k);
  marker.psi = random.matrix(3, k);
}

/// A place with random axes on a frame that stands still, not at the origin, of a body with k elastic coordinates.
inline dynamics::SpatialMarker still_marker(Random& random, int first, int k = 2) {
  dynamics::SpatialMarker marker;
  marker.origin = random.vector(3), marker.axes = math::rotation(2 * random.vector(3));
  marker.x0 = random.vector(3), marker.D0 = math::rotation(2 * random.vector(3));
  add_elastic(random, k, marker, first);
  return marker;
}

/// A place of a body in space with frame and k elastic coordinates, the body's coordinates beginning at `first`.
inline dynamics::SpatialMarker spatial_marker(Random& random, int first,
                                              std::shared_ptr<const dynamics::Attitude> attitude, int k = 2) {
  dynamics::SpatialMarker marker;
  marker.attitude = std::move(attitude);
  marker.x0 = random.vector(3), marker.D0 = math::rotation(2 * random.vector(3));
  for (int i = 0; i < 6; ++i) marker.coordinates.push_back(first + i);
  add_elastic(random, k, marker, first + 6);
  return marker;
}

inline std::shared_ptr<const dynamics::Attitude> attitude(Random& random) {
  return std::make_shared<const dynamics::Attitude>(dynamics::Attitude{math::quaternion(2 * random.vector(3))});
}

/// Two places with what their joint coordinates are: where frames stand among them.
struct PlacePair {
  dynamics::SpatialMarker first, second;
  std::vector<Eigen::Index> frames;  ///< first of the six of each frame, as a term of the pair numbers them
};

/// Two bodies; one body; the ground on either side; a body on a frame that stands still on either side.
inline std::vector<PlacePair> spatial_pairs() {
  Random random(17);
  const auto a = attitude(random), b = attitude(random);
  const auto one = spatial_marker(random, 0, a), same = spatial_marker(random, 0, a),
             other = spatial_marker(random, 8, b), still = still_marker(random, 20),
             ground = dynamics::SpatialMarker::ground(random.vector(3), math::rotation(random.vector(3)));
  return {{one, other, {0, 8}}, {one, same, {0}},  {one, ground, {0}},
          {ground, one, {0}},   {still, one, {2}}, {one, still, {0}}};
}

/// A smooth motion in chart coordinates with what stands for x among velocities and accelerations.
struct SpatialMotion {
  SmoothMotion chart;
  std::vector<Eigen::Index> frames;
  SpatialMotion(Random& random, Eigen::Index size, std::vector<Eigen::Index> places)
      : chart(random, size), frames(std::move(places)) {}
  Eigen::VectorXd q(double t) const { return chart.q(t); }
  /// omega = T(x) x.
  Eigen::VectorXd v(double t) const {
    Eigen::VectorXd rates = chart.v(t);
    const Eigen::VectorXd at = q(t);
    for (Eigen::Index i : frames)
      rates.segment<3>(i + 3) = (math::rotation_tangent(at.segment<3>(i + 3)) * rates.segment<3>(i + 3)).eval();
    return rates;
  }
  /// alpha = T(x) x.. + d(T(x) x.)/dx x.
  Eigen::VectorXd a(double t) const {
    Eigen::VectorXd rates = chart.a(t);
    const Eigen::VectorXd at = q(t), xd = chart.v(t);
    for (Eigen::Index i : frames) {
      const Eigen::Vector3d x = at.segment<3>(i + 3), w = xd.segment<3>(i + 3);
      rates.segment<3>(i + 3) =
          (math::rotation_tangent(x) * rates.segment<3>(i + 3) + math::rotation_tangent_derivative(x, w) * w).eval();
    }
    return rates;
  }
  State state(double t) const {
    Random none;
    State s(none, 0);
    s.q = q(t), s.v = v(t), s.a = a(t), s.t = t;
    return s;
  }
};

/// A planar place as one in space, its coordinates those of the body from six for its frame on.
inline dynamics::SpatialMarker in_space(const dynamics::Marker& flat,
                                        std::shared_ptr<const dynamics::Attitude> attitude, int first = 0) {
  dynamics::SpatialMarker marker;
  marker.attitude = flat.framed ? std::move(attitude) : nullptr;
  const int k = static_cast<int>(flat.S.cols()), size = k + (flat.framed ? 6 : 0);
  for (int i = 0; i < size; ++i) marker.coordinates.push_back(first + i);
  marker.x0 << flat.x, 0;
  marker.D0 = math::rotation({0, 0, flat.angle0});
  marker.S = Eigen::Matrix3Xd::Zero(3, k), marker.S.topRows(2) = flat.S;
  marker.psi = Eigen::Matrix3Xd::Zero(3, k), marker.psi.row(2) = flat.psi;
  marker.mass = flat.mass;
  return marker;
}

/// A state of planar coordinates as one of `size` coordinates in space; coordinate i goes to where[i].
inline State in_space(const State& flat, const std::vector<int>& where, Eigen::Index size) {
  Random none;
  State s(none, 0);
  s.q.setZero(size), s.v.setZero(size), s.a.setZero(size), s.t = flat.t;
  for (std::size_t i = 0; i < where.size(); ++i)
    s.q[where[i]] = flat.q[i], s.v[where[i]] = flat.v[i], s.a[where[i]] = flat.a[i];
  return s;
}

/// Rows `where` of a vector, or rows and columns of a matrix.
inline Eigen::MatrixXd picked(const Eigen::MatrixXd& from, const std::vector<int>& where) {
  return from.cols() == 1 ? Eigen::MatrixXd(from(where, Eigen::all)) : Eigen::MatrixXd(from(where, where));
}

/// The vector of a skew matrix.
inline Eigen::Vector3d axial(const Eigen::Matrix3d& W) { return {W(2, 1), W(0, 2), W(1, 0)}; }

}  // namespace floe::testing
