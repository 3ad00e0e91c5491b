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

Probe read_probe(Document& document, const std::string& name, const Value& value) {
  using Quantity = Probe::Quantity;
  Probe probe;
  probe.name = name;
  probe.where = value.where;
  Reading reading(document, value, "probe");
  if (!value.node.IsMap()) return probe;
  if (const auto at = reading.value("at")) probe.at = read_place(document, *at, reading.key("at"));
  if (const auto from = reading.value("relative_to"))
    probe.relative_to = read_place(document, *from, reading.key("relative_to"));
  probe.quantity = reading.choice<Quantity>("quantity", {{"position", Quantity::position},
                                                         {"displacement", Quantity::displacement},
                                                         {"deflection", Quantity::deflection},
                                                         {"velocity", Quantity::velocity},
                                                         {"rotation", Quantity::rotation}});
  if (probe.relative_to && probe.quantity == Quantity::deflection)
    document.fault(reading.where("relative_to"),
                   "does not apply to a deflection, which is measured in the body's frame",
                   "another quantity, or none");
  return probe;
}

}  // namespace floe::scene
