#include "probe_history.h"

#include <limits>

#include "floe/error.h"

namespace floe::assess {

AtTimes::AtTimes(const Model& model, std::vector<double> times, double step)
    : times_(std::move(times)),
      tolerance_(1e-6 * step),
      U_(model.system->create_vector()),
      V_(model.system->create_vector()) {}

ProbeHistory probe_history(const Scene& scene, const Model& model, solve::Integration how,
                           const std::vector<double>& times, const std::function<bool(const solve::Instant&)>& enough) {
  ProbeHistory history;
  how.events = events_of(scene, model, how.end);
  how.kinks = kinks_of(scene, how.end);
  how.on_event = [](const dynamics::EventReport&) {};
  how.from = nullptr;
  AtTimes at(model, times, how.step);
  const std::size_t columns = probe_columns(model).size();
  const auto observe = [&](const solve::Instant& instant) {
    at.observe(instant, [&](std::size_t i, double t, Vec U, Vec V) {
      // an instant within a step of an integrator that does not interpolate is not known
      history.values.resize(i, std::vector<double>(columns, std::numeric_limits<double>::quiet_NaN()));
      history.values.push_back(probe_values(model, t, U, V));
    });
    history.reached = instant.t;
    if (!enough || !enough(instant)) return;
    history.enough = true;
    throw RunError("enough");
  };
  try {
    solve::simulate(*model.system, how, model.U, model.V, observe);
  } catch (const solve::MotionStopped& stopped) {
    if (!history.enough) history.stopped = stopped.what();
  }
  return history;
}

}  // namespace floe::assess
