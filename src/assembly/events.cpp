#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/assembly/model.h"
#include "floe/assembly/values_of_probe.h"
#include "floe/math/nearest.h"
#include "floe/scene/sensors.h"

namespace floe::assembly {
namespace {

/// Whether all samples of a formula are 0 or 1: it is a condition.
bool is_condition(const math::Formula& formula, double h, std::int64_t count, double end) {
  for (std::int64_t i = 0; i <= count; ++i) {
    const double value = formula(std::min(static_cast<double>(i) * h, end));
    if (value != 0 && value != 1) return false;
  }
  return true;
}

/// Where a formula of t first changes sign in (0, end], or a condition changes: sampled 1000 times, and by motion.step;
/// then bisection.
std::optional<double> first_sign_change(const math::Formula& of_time, double step, double end) {
  const double h = std::min(step, end / 1000);
  const auto count = static_cast<std::int64_t>(std::ceil(end / h));
  const double lowered = is_condition(of_time, h, count, end) ? 0.5 : 0;
  const auto formula = [&](double t) { return of_time(t) - lowered; };
  double before = formula(0), low = 0;
  for (std::int64_t i = 1; i <= count; ++i) {
    double high = std::min(static_cast<double>(i) * h, end);
    const double after = formula(high);
    if (before == 0 || after * before > 0) {
      before = after, low = high;
      continue;
    }
    while (true) {
      const double middle = 0.5 * (low + high);
      if (!(middle > low && middle < high)) return high;
      if ((formula(middle) < 0) == (before < 0) && formula(middle) != 0)
        low = middle;
      else
        high = middle;
    }
  }
  return {};
}

/// Of an event that a formula of t decides; infinite: never.
double time_of(const Event& event, double step, double end) {
  try {
    return first_sign_change(*event.when, step, end).value_or(INFINITY);
  } catch (const math::FormulaError& error) {
    throw InputError(
        fmt::format("{}.when: {}; expected a finite number until it changes sign", event.where.text(), error.what()));
  }
}

struct ProbeComponent {
  std::size_t probe, component;
};

/// The component of a probe that an event watches.
ProbeComponent component_of(const Event& event, const Model& model) {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < model.probes.size(); ++p) {
    const ModelProbe& probe = model.probes[p];
    const std::vector<std::string> components = components_of(probe.quantity, probe.spatial ? 3 : 2);
    for (std::size_t i = 0; i < components.size(); ++i)
      if (names.emplace_back(probe.name + "." + components[i]) == event.probe) return {p, i};
  }
  const std::string near = math::nearest(event.probe, names);
  throw InputError(fmt::format("{}.probe: is \"{}\"; expected a component of a probe{}", event.where.text(),
                               event.probe, near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
}

}  // namespace

std::map<std::string, JointSwitches> switches_of(const Scene& scene) {
  std::map<std::string, JointSwitches> switches;
  for (const Event& event : scene.events) {
    if (event.kind == Event::Kind::stop) continue;
    JointSwitches& of = switches[event.joint];
    if (event.kind == Event::Kind::unlock)
      of.joint = std::make_shared<dynamics::ConstraintSwitch>(dynamics::ConstraintSwitch{true});
    if (event.kind == Event::Kind::lock)
      of.lock = std::make_shared<dynamics::ConstraintSwitch>(dynamics::ConstraintSwitch{false});
  }
  return switches;
}

std::vector<dynamics::Event> events_of(const Scene& scene, const Model& model, double end) {
  std::vector<dynamics::Event> events;
  for (const Event& event : scene.events) {
    dynamics::Event out;
    out.name = event.name;
    if (event.kind == Event::Kind::stop) {
      out.what = "stop";
      out.stops = true;
    } else {
      const JointSwitches& switches = model.switches.at(event.joint);
      const bool lock = event.kind == Event::Kind::lock;
      out.what = (lock ? "lock joint " : "unlock joint ") + event.joint;
      out.closes = lock;
      out.constraint_switch = lock || switches.lock ? switches.lock : switches.joint;
      if (lock) out.first_row = switches.first_row, out.rows = switches.rows;
    }
    if (event.at) out.at = *event.at;
    if (event.when) out.at = time_of(event, scene.motion.step, end);
    if (!event.probe.empty()) {
      out.crosses = [&model, at = component_of(event, model), value = event.crosses](double t, Vec U, Vec V) {
        return values_of_probe(model, at.probe, t, U, V)[at.component] - value;
      };
    }
    events.push_back(std::move(out));
  }
  for (std::size_t i = 0; i < model.stops.size(); ++i) {
    const ModelStop& stop = model.stops[i];
    const bool second =
        std::any_of(model.stops.begin(), model.stops.begin() + static_cast<long>(i), [&](const auto& s) {
          return s.joint == stop.joint && s.upper == stop.upper;  // rotation_limits stand after limits
        });
    const std::string side = std::string(second ? "turn_" : "") + (stop.upper ? "upper" : "lower");
    dynamics::Event out;
    out.name = fmt::format("{}.{}", stop.joint, side);
    out.what = fmt::format("joint {} hits its {} limit", stop.joint, side);
    out.what_back = fmt::format("joint {} leaves its {} limit", stop.joint, side);
    out.width = stop.term ? stop.term->law().width : 0;
    MPI_Allreduce(MPI_IN_PLACE, &out.width, 1, MPI_DOUBLE, MPI_MAX, model.system->comm());
    out.gap = [&model, i](double t, Vec U, Vec V) { return stop_gap(model, i, t, U, V); };
    events.push_back(std::move(out));
  }
  return events;
}

}  // namespace floe::assembly
