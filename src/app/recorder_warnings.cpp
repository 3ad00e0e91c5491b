#include <fmt/format.h>

#include <algorithm>

#include "recorder.h"

namespace floe::app {

using nlohmann::ordered_json;

// Kinks of loads, which are not in the list, have such errors, too: those long after an event are not its own.
void Recorder::note_error(const solve::Instant& instant) {
  ordered_json& events = result_.summary["events"];
  if (instant.event_error == 0 || events.empty()) return;
  const auto event = std::find_if(events.rbegin(), events.rend(), [](const ordered_json& one) {
    return !one.contains("speed") && !one.contains("kinetic_energy_gained");  // at stops the motion goes on
  });
  if (event == events.rend()) return;
  const double since = instant.t - (*event)["t"].get<double>();
  if (since <= 0 || since > 2.5 * scene_.motion.step) return;  // at its own instant the step before it ends
  (*event)["step_error"] = std::max(event->value("step_error", 0.), instant.event_error);
}

// Where every step is recorded, no work is missed.
void Recorder::refuse_runaway() const {
  const double round_off = 1e-14 * model_.force * model_.extent;
  if (scene_.motion.every != 1 || scene_.motion.output || !balance_.runs_away(round_off)) return;
  throw RunError(fmt::format(
      "total energy has grown by {:.3g} J beyond the work of loads and drives ({:.3g} J; limit {:g} times the "
      "energy exchanged before): the steps did not converge (unstable time integration). Try {}a smaller motion.step",
      balance_.growth(), balance_.work(), solve::EnergyBalance::most_growth, clamped_frames()));
}

/// Whether every step is stored and all are equally long: else the trapezoidal rule for the work of loads can miss what
/// jumps.
bool Recorder::balances_every_step() const {
  const scene::Motion& motion = scene_.motion;
  if (motion.tolerance) return false;
  return motion.output ? *motion.output <= (1 + 1e-9) * motion.step : motion.every == 1;
}

/// A frame that is clamped at a free end follows its fastest vibrations, which a smaller step excites the more.
std::string Recorder::clamped_frames() const {
  std::vector<std::string> names;
  for (const scene::Body& body : scene_.bodies)
    if (scene_.dimension == 3 && model_.formulation == scene::Formulation::nlffr && body.frame.given &&
        body.frame.kind == scene::FrameSpec::Kind::clamped)
      names.push_back(body.name);
  if (names.empty()) return "";
  return fmt::format(
      "frame: mean-axis where no joint constrains the clamped place of {} (smaller steps do not help there), "
      "otherwise ",
      fmt::join(names, ", "));
}

std::string Recorder::growth_warning() const {
  constexpr double limit = 0.1;
  if (!balances_every_step()) return "";
  const double scale = std::max(balance_.turnover(), max_energy_), growth = balance_.growth();
  if (!(growth > limit * scale)) return "";
  return fmt::format(
      "total energy: grows by {:.3g} J beyond the work of loads and drives ({:.3g} J), {:.0f} % of the maximum energy "
      "(limit {:.0f} %): the equations of motion are not satisfied; take {}a smaller motion.step, and remove options "
      "-motion_snes_... that stop Newton's method early",
      growth, balance_.work(), 100 * growth / scale, 100 * limit, clamped_frames());
}

std::string Recorder::event_warning() const {
  constexpr double limit = 0.15;
  const ordered_json* worst = nullptr;
  if (!result_.summary.contains("events")) return "";
  for (const ordered_json& event : result_.summary["events"])
    if (event.value("step_error", 0.) > (worst ? worst->value("step_error", 0.) : limit)) worst = &event;
  if (!worst) return "";
  return fmt::format(
      "event {} ({}) at t = {:.4g} s: the step after it has an estimated error of {:.0f} % of its path (limit {:.0f} "
      "%), which remains in the velocities: motion.step does not resolve the vibrations that the event excites; take "
      "a smaller motion.step, or a motion.tolerance",
      worst->value("name", ""), worst->value("what", ""), worst->value("t", 0.), 100 * worst->value("step_error", 0.),
      100 * limit);
}

}  // namespace floe::app
