#include <cmath>

#include "readers.h"

namespace floe::scene {
namespace {

constexpr int samples = 16;  // of the time of the motion; the rest is told when the run gets there

void check(Document& document, const math::Formula& formula, double end, Where where, const char* key) {
  if (formula.constant()) return;  // checked when read
  where.key += std::string(".") + key;
  try {
    for (int i = 0; i <= samples; ++i) formula(end * i / samples);
  } catch (const math::FormulaError& error) {
    document.fault(where, error.what(), "a finite number from t = 0 to the end of the motion");
  }
}

}  // namespace

void check_formulas(Document& document, const Scene& scene) {
  const double end = std::isfinite(scene.motion.end) ? scene.motion.end : 0;
  for (const Joint& joint : scene.joints) check(document, joint.angle, end, joint.where, "angle");
  for (const Load& load : scene.loads) {
    check(document, load.moment, end, load.where, "moment");
    check(document, load.force[0], end, load.where, "force[1]");
    check(document, load.force[1], end, load.where, "force[2]");
    check(document, load.force[2], end, load.where, "force[3]");
  }
}

}  // namespace floe::scene
