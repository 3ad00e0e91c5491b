#include <cmath>

#include "readers.h"

namespace floe::scene {
namespace {

constexpr int samples = 16;  // of the time of the motion; the rest is reported when the run gets there

void check(Document& document, const math::Formula& formula, double end, Where where, const std::string& key) {
  if (formula.constant() || formula.has_sensors()) return;  // checked when read, or reported when the run gets there
  where.key += (where.key.empty() ? "" : ".") + key;
  try {
    for (int i = 0; i <= samples; ++i) formula(end * i / samples);
  } catch (const math::FormulaError& error) {
    document.fault(where, error.what(), "a finite number from t = 0 to the end of the motion");
  }
}

std::string component(const std::string& key, int i) { return key + "[" + std::to_string(i + 1) + "]"; }

}  // namespace

void check_formulas(Document& document, const Scene& scene) {
  const double end = std::isfinite(scene.motion.end) ? scene.motion.end : 0;
  for (int i = 0; i < 3; ++i) {
    check(document, scene.gravity[i], end, {scene.file, 0, 0, ""}, component("gravity", i));
    check(document, scene.ground_acceleration[i], end, {scene.file, 0, 0, ""}, component("ground.acceleration", i));
  }
  for (const Joint& joint : scene.joints) {
    check(document, joint.angle, end, joint.where, "angle");
    check(document, joint.position, end, joint.where, "position");
    if (joint.speed) check(document, *joint.speed, end, joint.where, "speed");
  }
  for (const Load& load : scene.loads) {
    if (scene.dimension == 2) check(document, load.moment[2], end, load.where, "moment");
    for (int i = 0; scene.dimension == 3 && i < 3; ++i)
      check(document, load.moment[i], end, load.where, component("moment", i));
    for (int i = 0; i < 3; ++i) check(document, load.force[i], end, load.where, component("force", i));
    check(document, load.pressure, end, load.where, "pressure");
    check(document, load.on_joint, end, load.where, load.kind == Load::Kind::moment ? "moment" : "force");
  }
}

}  // namespace floe::scene
