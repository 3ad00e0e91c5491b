#include "drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/math/integral.h"

namespace floe::scene {
namespace {

/// Of some values in the motion, those that are none apart.
double greatest_of(const math::Formula& f, double end) {
  constexpr int samples = 64;
  double greatest = 0;
  for (int i = 0; i <= samples; ++i) {
    try {
      greatest = std::max(greatest, std::abs(f(end * i / samples)));
    } catch (const math::FormulaError&) {  // told when the motion gets there
    }
  }
  return greatest;
}

}  // namespace

dynamics::TimeFunction drive_of(const Joint& joint, const Motion& motion) {
  if (joint.speed) {
    const math::Formula speed = *joint.speed;
    const math::Integral travelled([speed](double t) { return speed(t); }, motion.step > 0 ? 16 * motion.step : 1);
    return {[travelled](double t) { return travelled(t); }, [speed](double t) { return speed(t); },
            [speed](double t) { return speed.derivative(t); }};
  }
  const bool turns = joint.kind == Joint::Kind::driven;
  const math::Formula f = turns ? joint.angle : joint.position;
  if (std::abs(f(0)) > 1e-9 * greatest_of(f, motion.end > 0 ? motion.end : 1))
    throw InputError(
        fmt::format("{}: the driven {} is {:.6g} at t = 0; expected 0, because it is measured from the start",
                    joint.where.text(), turns ? "angle" : "position", f(0)));
  return {[f](double t) { return f(t); }, [f](double t) { return f.derivative(t); },
          [f](double t) { return f.second_derivative(t); }};
}

}  // namespace floe::scene
