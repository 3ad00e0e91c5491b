#include <fmt/format.h>

#include "readers.h"

namespace floe::scene {

Motion read_motion(Document& document, const Value& value) {
  constexpr double most_steps = 1e9, most_between = 100;
  Motion motion;
  motion.where = value.where;
  Reading reading(document, value, "motion");
  motion.end = reading.number("end");
  motion.step = reading.number("step");
  motion.spectral_radius = reading.number("spectral_radius");
  motion.tolerance = reading.optional_number("tolerance");
  motion.every = reading.integer("every");
  motion.output = reading.optional_number("output");
  motion.start = reading.choice<Motion::Start>("start", {{"given", Motion::Start::given},
                                                         {"equilibrium", Motion::Start::equilibrium},
                                                         {"steady_rotation", Motion::Start::steady_rotation}});
  if (motion.output && reading.given("every"))
    document.fault(reading.where("every"), "cannot be combined with output, which is independent of the steps",
                   "one of them");
  if (motion.step > motion.end) {
    document.fault(reading.where("step"), fmt::format("is {}", motion.step),
                   fmt::format("at most end, {}", motion.end));
  } else if (motion.end / motion.step > most_steps) {
    document.fault(reading.where("step"),
                   fmt::format("is {}: {} steps to the end", motion.step, motion.end / motion.step),
                   fmt::format("at most {} steps", most_steps));
  }
  if (motion.output && *motion.output < motion.step / most_between)
    document.fault(reading.where("output"), fmt::format("is {}", *motion.output),
                   fmt::format("at least 1/{} of step, {}", most_between, motion.step / most_between));
  return motion;
}

void check_start(Document& document, const Scene& scene) {
  if (scene.motion.start == Motion::Start::given) return;
  const bool rotates = scene.motion.start == Motion::Start::steady_rotation;
  for (const Body& body : scene.bodies) {
    const InitialSpec& initial = body.initial;
    const bool moves = initial.velocity != Point{} || (initial.angular_velocity != Point{} && !rotates) ||
                       initial.deformation_rate || initial.spatial_deformation_rate;
    if (!moves) continue;
    Where where = scene.motion.where;
    where.key += ".start";
    document.fault(where,
                   fmt::format("is {}, and body {} has an initial velocity",
                               rotates ? "steady_rotation" : "equilibrium", body.name),
                   "start: given, or bodies at rest");
  }
}

}  // namespace floe::scene
