#pragma once
#include <Eigen/Dense>

#include "floe/math/rotation.h"
#include "spatial_scenes.h"

namespace floe::test {

/// What converts a planar scene into one in space: everything by one rotation about an axis that is none of the
/// world's.
struct Rotated {
  Eigen::Vector3d vector{0.4, -0.9, 0.7};
  Eigen::Matrix3d Q = math::rotation(vector);

  /// Rotated, as a scene's text.
  std::string operator()(double x, double y, double z = 0) const {
    const Eigen::Vector3d p = Q * Eigen::Vector3d(x, y, z);
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", p.x(), p.y(), p.z());
  }
  /// As `initial.rotation`.
  std::string text() const { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", vector.x(), vector.y(), vector.z()); }
};

inline Eigen::Vector3d vector_at(const History& history, const std::string& probe, std::size_t i) {
  return {history[probe + ".x"][i], history[probe + ".y"][i], history[probe + ".z"][i]};
}

/// Greatest distance between a probe in space, rotated back, and its planar twin, over the greatest size of the twin.
inline double apart(const History& space, const Eigen::Matrix3d& Q, const History& plane, const std::string& probe) {
  REQUIRE(space.t.size() == plane.t.size());
  double worst = 0, size = 0;
  for (std::size_t i = 0; i < space.t.size(); ++i) {
    const Eigen::Vector3d flat(plane[probe + ".x"][i], plane[probe + ".y"][i], 0);
    worst = std::max(worst, (Q.transpose() * vector_at(space, probe, i) - flat).norm());
    size = std::max(size, flat.norm());
  }
  return worst / size;
}

/// Greatest distance between two histories in space of one probe, over its greatest size.
inline double apart(const History& a, const History& b, const std::string& probe) {
  REQUIRE(a.t.size() == b.t.size());
  double worst = 0, size = 0;
  for (std::size_t i = 0; i < a.t.size(); ++i) {
    worst = std::max(worst, (vector_at(a, probe, i) - vector_at(b, probe, i)).norm());
    size = std::max(size, vector_at(b, probe, i).norm());
  }
  return worst / size;
}

inline double total(const dynamics::Energy& e) { return e.kinetic + e.elastic + e.potential; }

/// Greatest change of the energy since the start, over the greatest kinetic energy.
inline double drift(const History& at) {
  double worst = 0, size = 0;
  for (const dynamics::Energy& e : at.energy)
    worst = std::max(worst, std::abs(total(e) - total(at.energy.front()))), size = std::max(size, e.kinetic);
  return worst / size;
}

}  // namespace floe::test
