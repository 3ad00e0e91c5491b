#include <algorithm>

#include "floe/assembly/model.h"
#include "floe/math/rotation.h"

namespace floe::assembly {

int moving_frames(const Model& model) {
  return static_cast<int>(std::count_if(model.bodies.begin(), model.bodies.end(),
                                        [](const BodyReport& body) { return body.attitude != nullptr; }));
}

std::vector<double> attitudes(const Model& model, Vec U) {
  std::vector<double> all;
  if (moving_frames(model) == 0) return all;
  Eigen::VectorXd q;
  model.system->gather(U, q);
  for (const BodyReport& body : model.bodies) {
    if (!body.attitude) continue;
    Eigen::Quaterniond at = body.attitude->base * math::quaternion(q.segment<3>(body.first_coordinate + 3));
    if (at.w() < 0) at.coeffs() *= -1;
    all.insert(all.end(), {at.w(), at.x(), at.y(), at.z()});
  }
  return all;
}

}  // namespace floe::assembly
