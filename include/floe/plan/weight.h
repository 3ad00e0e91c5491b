#pragma once
#include <algorithm>

#include "floe/scene/scene.h"

namespace floe::plan {
using namespace scene;

/// The acceleration that all that has mass feels: gravity less that of the ground, world axes [m/s2].
struct Weight {
  std::array<math::Formula, 3> gravity, ground;

  explicit Weight(const Scene& scene) : gravity(scene.gravity), ground(scene.ground_acceleration) {}
  Eigen::Vector3d operator()(double t) const {
    Eigen::Vector3d g;
    for (int i = 0; i < 3; ++i) g[i] = gravity[i](t) - ground[i](t);
    return g;
  }
  /// The same at all times: then it has a potential.
  bool constant() const {
    const auto is = [](const math::Formula& f) { return f.constant(); };
    return std::all_of(gravity.begin(), gravity.end(), is) && std::all_of(ground.begin(), ground.end(), is);
  }
  bool none() const { return constant() && (*this)(0).isZero(0); }
};

}  // namespace floe::plan
