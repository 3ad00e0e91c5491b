#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "drive.h"
#include "floe/assembly/model.h"

namespace floe::assembly {
namespace {

void add_drive(const Joint& joint, const Motion& motion, double end, std::vector<dynamics::Kink>& kinks) {
  const char* unit = joint.kind == Joint::Kind::driven ? "rad/s" : "m/s";
  for (const DriveKink& at : drive_kinks(joint, motion, end)) {
    if (at.before <= 0 || at.before >= end) continue;  // drive_of begins just after t = 0
    dynamics::Kink kink{at.before, at.after, joint.name, ""};
    if (at.velocity) kink.what = fmt::format("speed of the drive jumps from {:.6g} to {:.6g} {}", at.from, at.to, unit);
    kinks.push_back(std::move(kink));
  }
}

/// Values of a formula's sensors at which its jumps in time are searched: one set may make a jump vanish
/// (`(1 - slide.travel)*pulse(t, 1, 2)` at 1), or take another branch.
std::vector<std::vector<double>> sensor_values(std::size_t sensors) {
  std::vector<std::vector<double>> sets(sensors == 0 ? 1 : 4);
  for (std::size_t i = 0; i < sensors; ++i) {
    sets[0].push_back(1);
    sets[1].push_back(0.37 + 0.29 * static_cast<double>(i));
    sets[2].push_back(-0.73 - 0.41 * static_cast<double>(i));
    sets[3].push_back(1.83 - 0.97 * static_cast<double>(i));
  }
  return sets;
}

/// Where a load jumps in time for any value of its sensors: of sensors themselves steps take care as of any state.
void add_load(const math::Formula& load, double step, double end, std::vector<dynamics::Kink>& kinks) {
  struct Found {
    double before, after;
    int times;
    bool jump;
  };
  std::vector<Found> found;
  const std::size_t sensors = load.has_sensors() ? load.variables().size() - 1 : 0;
  for (const std::vector<double>& values : sensor_values(sensors)) {
    const math::Breaks all = math::breaks(load, 0, end, std::min(step, end / 1000), values);
    for (const math::Break& at : all.at) {
      const auto same = std::find_if(found.begin(), found.end(), [&](const Found& other) {
        return at.before <= other.after && other.before <= at.after;
      });
      if (same == found.end())
        found.push_back({at.before, at.after, 1, jumps(all, at, 0)});
      else
        ++same->times, same->jump = same->jump || jumps(all, at, 0);
    }
  }
  for (const Found& at : found)  // an instant that moves with the sensors is none of time
    if (at.jump && (sensors == 0 || at.times > 1)) kinks.push_back({at.before, at.after, "", ""});
}

/// The later one into the earlier one.
void join(dynamics::Kink& kink, const dynamics::Kink& later) {
  kink.after = std::max(kink.after, later.after);
  if (later.what.empty()) return;
  kink.name += (kink.what.empty() ? "" : ", ") + later.name;
  kink.what += (kink.what.empty() ? "" : "; ") + later.what;
}

}  // namespace

std::vector<dynamics::Kink> kinks_of(const Scene& scene, double end) {
  std::vector<dynamics::Kink> all;
  const double step = scene.motion.step;
  if (!(step > 0) || !(end > 0) || !std::isfinite(end)) return all;
  for (const Joint& joint : scene.joints) add_drive(joint, scene.motion, end, all);
  for (int i = 0; i < 3; ++i) {
    add_load(scene.gravity[i], step, end, all);
    add_load(scene.ground_acceleration[i], step, end, all);
  }
  for (const Load& load : scene.loads)
    for (const math::Formula* formula : load.formulas()) add_load(*formula, step, end, all);
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.before < b.before; });
  std::vector<dynamics::Kink> joined;
  for (dynamics::Kink& kink : all) {
    if (kink.what.empty()) kink.name.clear();
    if (!joined.empty() && kink.before <= joined.back().after + 1e-9 * step)
      join(joined.back(), kink);
    else
      joined.push_back(std::move(kink));
  }
  return joined;
}

}  // namespace floe::assembly
