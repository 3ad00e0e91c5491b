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

void add_load(const math::Formula& load, double step, double end, std::vector<dynamics::Kink>& kinks) {
  const math::Breaks all = math::breaks(load, 0, end, std::min(step, end / 1000));
  for (const math::Break& at : all.at)
    if (jumps(all, at, 0)) kinks.push_back({at.before, at.after, "", ""});
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
