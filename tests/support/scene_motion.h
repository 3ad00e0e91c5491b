#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "floe/assembly/model.h"
#include "floe/petsc/values.h"
#include "floe/solve/simulation.h"
#include "floe/solve/start.h"
#include "structures.h"

namespace floe::test {

using scene::Formulation;
using testing::everywhere;
using Words = std::vector<std::pair<std::string, std::string>>;

/// A scene's text with every `$name` replaced.
inline std::string fill(std::string text, const Words& words) {
  for (const auto& [name, value] : words)
    for (std::size_t at = text.find('$' + name); at != std::string::npos; at = text.find('$' + name))
      text.replace(at, name.size() + 1, value);
  return text;
}

/// All digits of a number, for a scene's text.
inline std::string number(double value) { return fmt::format("{:.17g}", value); }

/// What the probes and the energy did in time.
struct History {
  assembly::Model model;
  std::vector<double> t;
  std::map<std::string, std::vector<double>> columns;  ///< `tip.x`
  std::vector<dynamics::Energy> energy;                ///< of every step
  solve::IntegrationReport report;
  std::vector<dynamics::EventReport> events = {};

  const std::vector<double>& operator[](const std::string& column) const { return columns.at(column); }
  /// Between stored times: on the straight line.
  double at(const std::string& column, double time) const {
    const auto& values = columns.at(column);
    const std::size_t next = std::lower_bound(t.begin() + 1, t.end() - 1, time - 1e-12) - t.begin();
    const double s = (time - t[next - 1]) / (t[next] - t[next - 1]);
    return (1 - s) * values[next - 1] + s * values[next];
  }
  /// Times where a column passes through zero upwards or downwards, on the straight line.
  std::vector<double> crossings(const std::string& column) const {
    const auto& x = columns.at(column);
    std::vector<double> all;
    for (std::size_t i = 1; i < x.size(); ++i)
      if (x[i - 1] * x[i] < 0) all.push_back(t[i - 1] + (t[i] - t[i - 1]) * x[i - 1] / (x[i - 1] - x[i]));
    return all;
  }
};

inline void store(History& history, double t, Vec U, Vec V, Vec A = nullptr) {
  const auto columns = assembly::probe_columns(history.model);
  const std::vector<double> values = assembly::probe_values(history.model, t, U, V, A);
  history.t.push_back(t);
  for (std::size_t c = 0; c < columns.size(); ++c) history.columns[columns[c].name].push_back(values[c]);
  history.energy.push_back(history.model.system->energy(t, U, V));
}

inline History history_of(const std::string& text, Formulation formulation) {
  return {assembly::build(scene::parse_scene(text, "scene"), formulation, PETSC_COMM_WORLD), {}, {}, {}, {}};
}

/// Reads, builds and moves a scene as `floe run` does. U, V of the model hold the end.
inline History move(const std::string& text, Formulation formulation) {
  History history = history_of(text, formulation);
  const scene::Scene scene = scene::parse_scene(text, "scene");
  const scene::Motion& motion = scene.motion;
  solve::Integration how{motion.end, motion.step, motion.spectral_radius, motion.tolerance};
  how.events = assembly::events_of(scene, history.model, motion.end);
  how.kinks = assembly::kinks_of(scene, motion.end);
  how.state_loads =
      std::any_of(scene.loads.begin(), scene.loads.end(), [](const scene::Load& load) { return load.has_sensors(); });
  how.on_event = [&](const dynamics::EventReport& event) { history.events.push_back(event); };
  history.report = solve::simulate(*history.model.system, how, history.model.U, history.model.V,
                                   [&](const solve::Instant& at) { store(history, at.t, at.U, at.V, at.A); });
  return history;
}

/// What is wrong with a scene whose motion by modes and derivatives is refused; empty where it is not.
inline std::string fault_of_motion(const std::string& text) {
  try {
    move(text, Formulation::vm_md);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// The equilibrium at t = 1, reached from t = 0 in equal steps of load.
inline History rest(const std::string& text, Formulation formulation, int steps = 1) {
  History history = history_of(text, formulation);
  for (int i = 1; i <= steps; ++i)
    solve::equilibrium(*history.model.system, double(i) / steps, history.model.U, history.model.V);
  store(history, 1, history.model.U, history.model.V, history.model.V);
  return history;
}

/// Relative L2 error of one column against another history with the same stored times, to `end`.
inline double relative_error(const History& a, const History& b, const std::string& column, double end = INFINITY) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.t.size() && a.t[i] <= end * (1 + 1e-12); ++i) {
    const double reference = b.at(column, a.t[i]);
    difference += std::pow(a[column][i] - reference, 2);
    size += reference * reference;
  }
  return std::sqrt(difference / size);
}

/// Global indices of all multipliers, on every rank. Collective.
inline std::vector<PetscInt> multipliers(const dynamics::System& system) {
  petsc::IsHandle all;
  const petsc::IsHandle mine = system.multipliers();
  const PetscInt* values = nullptr;
  PetscInt n = 0;
  petsc::check(ISAllGather(mine, all.out()));
  petsc::check(ISGetLocalSize(all, &n));
  petsc::check(ISGetIndices(all, &values));
  const std::vector<PetscInt> copy(values, values + n);
  petsc::check(ISRestoreIndices(all, &values));
  return copy;
}

}  // namespace floe::test
