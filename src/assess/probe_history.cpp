#include "probe_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "floe/error.h"
#include "floe/solve/branch.h"
#include "floe/solve/start.h"

namespace floe::assess {

AtTimes::AtTimes(const Model& model, std::vector<double> times, double step)
    : times_(std::move(times)),
      tolerance_(1e-6 * step),
      U_(model.system->create_vector()),
      V_(model.system->create_vector()),
      A_(model.system->create_vector()) {}

bool same_joints(const std::vector<JointChange>& changes, double t, std::span<const std::string> happened) {
  std::vector<std::string> before;
  for (const JointChange& change : changes)
    if (change.t < t) before.push_back(change.event);
  return std::is_permutation(before.begin(), before.end(), happened.begin(), happened.end());
}

ProbeHistory probe_history(const Scene& scene, const Model& model, solve::Integration how,
                           const std::vector<double>& times, const std::function<bool(const solve::Instant&)>& enough) {
  ProbeHistory history;
  how.events = events_of(scene, model, how.end);
  how.kinks = kinks_of(scene, how.end);
  bool jumps = false;  // whether joints have changed, or speeds of drives jumped
  how.on_event = [&](const dynamics::EventReport& event) {
    if (event.switches) history.changes.push_back(event.name);
    jumps = jumps || event.switches || event.work;
  };
  how.from = nullptr;
  AtTimes at(model, times, how.step);
  const std::size_t columns = probe_columns(model).size();
  const auto observe = [&](const solve::Instant& instant) {
    at.observe(instant, [&](std::size_t i, double t, Vec U, Vec V, Vec A) {
      // an instant within a step of an integrator that does not interpolate is not known
      history.values.resize(i, std::vector<double>(columns, std::numeric_limits<double>::quiet_NaN()));
      history.values.push_back(probe_values(model, t, U, V, A));
      history.happened.resize(i + 1, history.changes.size());
    });
    history.reached = instant.t;
    if (jumps) history.event_error = std::max(history.event_error, instant.event_error);
    if (!enough || !enough(instant)) return;
    history.enough = true;
    throw RunError("enough");
  };
  try {
    solve::simulate(*model.system, how, model.U, model.V, observe);
  } catch (const solve::MotionStopped& stopped) {
    if (history.enough) return history;
    history.stopped = stopped.what();
    if (jumps) history.event_error = std::numeric_limits<double>::infinity();
  }
  return history;
}

ProbeHistory equilibrium_history(const Model& model, const solve::Integration& how, const std::vector<double>& times,
                                 const std::function<bool(const solve::Instant&)>& enough) {
  ProbeHistory history;
  petsc::check(VecSet(model.V, 0));
  const auto steps = static_cast<PetscInt>(std::floor(how.end / how.step * (1 + 1e-9)));
  try {
    try {
      solve::equilibrium(*model.system, 0, model.U, model.V, true);
    } catch (const solve::Unconstrained&) {  // the first load does
    }
    for (PetscInt step = 1; step <= steps && !history.enough; ++step) {
      const double t = how.step * static_cast<double>(step);
      solve::follow_equilibrium(*model.system, history.reached, t, how.end / 1000, model.U, model.V,
                                [](const solve::BranchJump&, Vec, Vec) {});
      history.reached = t;
      const auto at = std::lower_bound(times.begin(), times.end(), t - 1e-6 * how.step);
      if (at != times.end() && *at < t + 1e-6 * how.step) {
        history.values.resize(
            static_cast<std::size_t>(at - times.begin()),
            std::vector<double>(probe_columns(model).size(), std::numeric_limits<double>::quiet_NaN()));
        history.values.push_back(probe_values(model, t, model.U, model.V, model.V));
      }
      history.enough = enough && enough({t, step, model.U, model.V, nullptr, step == steps});
    }
  } catch (const RunError& fault) {
    history.stopped = fmt::format("the equilibria end at t = {:.6g}: {}", history.reached, fault.what());
  }
  return history;
}

}  // namespace floe::assess
