#include "drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "floe/dynamics/patched_function.h"
#include "floe/math/integral.h"

namespace floe::assembly {
namespace {

/// Of some values in the motion, those that are none apart.
double greatest_of(const math::Formula& f, double end) {
  constexpr int samples = 64;
  double greatest = 0;
  for (int i = 0; i <= samples; ++i) {
    try {
      greatest = std::max(greatest, std::abs(f(end * i / samples)));
    } catch (const math::FormulaError&) {  // reported when the motion gets there
    }
  }
  return greatest;
}

const math::Formula& formula_of(const Joint& joint) {
  return joint.speed ? *joint.speed : joint.kind == Joint::Kind::driven ? joint.angle : joint.position;
}

std::string key_of(const Joint& joint) {
  return joint.speed ? "speed" : joint.kind == Joint::Kind::driven ? "angle" : "position";
}

/// The derivative of f where it is finite, else 0.
double derivative(const math::Formula& f, int which, double t) {
  try {
    return which == 0 ? f(t) : which == 1 ? f.derivative(t) : f.second_derivative(t);
  } catch (const math::FormulaError&) {
    return 0;
  }
}

/// Whether a derivative of f grows without limit towards `at` from one side, as a power of the distance: it is more
/// than half as large again at a thousandth of the distance, and more than anywhere else.
bool grows(const math::Formula& f, const math::Breaks& all, int which, double at, double side, double step) {
  const double far = std::abs(derivative(f, which, at + side * 1e-3 * step)),
               near = std::abs(derivative(f, which, at + side * 1e-6 * step));
  return near > 1.5 * far && near > 1.5 * all.size[which];
}

/// Joins [a, b] by a polynomial that has the drive's acceleration at one of its ends, `smooth_end`.
dynamics::Patch patch_over(const dynamics::TimeFunction& drive, double a, double b, double smooth_end) {
  const double h = b - a, s = (smooth_end - a) / h;
  Eigen::Matrix<double, 5, 5> rows;
  rows << 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1, 1, 0, 1, 2, 3, 4, 0, 0, 2, 6 * s, 12 * s * s;
  Eigen::Matrix<double, 5, 1> given;
  given << drive.value(a), h * drive.rate(a), drive.value(b), h * drive.rate(b), h * h * drive.acceleration(smooth_end);
  return {a, b, rows.partialPivLu().solve(given)};
}

/// What is left of `smoothing` steps on both sides of a kink, beside its neighbours.
std::array<double, 2> room(const std::vector<DriveKink>& kinks, std::size_t i, double step) {
  const double most = smoothing * step;
  const double before = kinks[i].before - (i > 0 ? kinks[i - 1].after : 0.0);
  return {i > 0 ? std::min(most, before / 2) : std::min(most, before),
          i + 1 < kinks.size() ? std::min(most, (kinks[i + 1].before - kinks[i].after) / 2) : most};
}

dynamics::TimeFunction as_written(const Joint& joint, const Motion& motion) {
  const math::Formula f = formula_of(joint);
  if (joint.speed) {
    std::vector<double> breaks;
    if (motion.step > 0 && motion.end > 0 && std::isfinite(motion.end))
      for (const math::Break& at : math::breaks(f, 0, motion.end, std::min(motion.step, motion.end / 1000)).at)
        breaks.push_back(at.before), breaks.push_back(at.after);
    const math::Integral travelled([f](double t) { return f(t); }, motion.step > 0 ? 16 * motion.step : 1,
                                   std::move(breaks));
    return {[travelled](double t) { return travelled(t); }, [f](double t) { return f(t); },
            [f](double t) { return f.derivative(t); }};
  }
  if (std::abs(f(0)) > 1e-9 * greatest_of(f, motion.end > 0 ? motion.end : 1))
    throw InputError(fmt::format(
        "{}: the driven {} is {:.6g} at t = 0; expected 0, because it is measured from the initial configuration",
        joint.where.text(), key_of(joint), f(0)));
  return {[f](double t) { return f(t); }, [f](double t) { return f.derivative(t); },
          [f](double t) { return f.second_derivative(t); }};
}

}  // namespace

bool is_drive(Joint::Kind kind) { return kind == Joint::Kind::driven || kind == Joint::Kind::driven_slide; }

bool jumps(const math::Breaks& all, const math::Break& at, int derivative) {
  const double jump = std::abs(at.right[derivative] - at.left[derivative]);
  const double change =
      derivative < 2
          ? std::max(std::abs(at.left[derivative + 1]), std::abs(at.right[derivative + 1])) * (at.after - at.before)
          : 0;
  return std::isfinite(jump) && jump > 1e-9 * all.size[derivative] + 10 * (std::isfinite(change) ? change : 0);
}

std::vector<DriveKink> drive_kinks(const Joint& joint, const Motion& motion, double end) {
  std::vector<DriveKink> kinks;
  if (std::isfinite(motion.end)) end = std::max(end, motion.end);
  if (!is_drive(joint.kind) || !(motion.step > 0) || !(end > 0)) return kinks;
  const math::Formula& f = formula_of(joint);
  const math::Breaks all = math::breaks(f, 0, end, std::min(motion.step, end / 1000));
  const int rate = joint.speed ? 0 : 1;  // which derivative of f it is
  const char* unit = joint.kind == Joint::Kind::driven ? "rad" : "m";
  for (const math::Break& at : all.at) {
    const double t = at.before > 0 ? 0.5 * (at.before + at.after) : 0;
    const auto endless = [&](int which) {
      return std::array{grows(f, all, which, at.before, -1, motion.step),
                        grows(f, all, which, at.after, 1, motion.step)};
    };
    if (const auto [left, right] = endless(rate); left || right)
      throw InputError(fmt::format("{}.{}: the rate of \"{}\" is infinite at t = {:.9g}; expected a finite one",
                                   joint.where.text(), key_of(joint), f.text(), t));
    if (!joint.speed && jumps(all, at, 0))
      throw InputError(
          fmt::format("{}.{}: \"{}\" jumps from {:.6g} to {:.6g} {} at t = {:.9g}; expected a continuous {}, "
                      "as with ramp(t, from, to)",
                      joint.where.text(), key_of(joint), f.text(), at.left[0], at.right[0], unit, t, key_of(joint)));
    const auto [left, right] = endless(rate + 1);
    DriveKink kink{at.before, at.after, jumps(all, at, rate), at.left[rate], at.right[rate], {left, right}};
    if (left || right)  // which makes the rate change much within round-off of the time
      kink.velocity = std::abs(kink.to - kink.from) > 1e-5 * all.size[rate];
    if (kink.velocity || left || right || jumps(all, at, rate + 1)) kinks.push_back(kink);
  }
  return kinks;
}

dynamics::TimeFunction drive_of(const Joint& joint, const Motion& motion) {
  dynamics::TimeFunction drive = as_written(joint, motion);
  const std::vector<DriveKink> kinks = drive_kinks(joint, motion);
  std::vector<dynamics::Patch> patches;
  for (std::size_t i = 0; i < kinks.size(); ++i) {
    const DriveKink& at = kinks[i];
    const auto [left, right] = room(kinks, i, motion.step);
    if (at.endless[0] && left > 0) patches.push_back(patch_over(drive, at.before - left, at.before, at.before - left));
    if (at.endless[1]) patches.push_back(patch_over(drive, at.after, at.after + right, at.after + right));
  }
  const double begin = !kinks.empty() && kinks[0].before <= 0 ? kinks[0].after : 0;
  return begin > 0 || !patches.empty() ? dynamics::patched(std::move(drive), std::move(patches), begin) : drive;
}

std::vector<std::string> smoothed_drives(const Scene& scene) {
  std::vector<std::string> words;
  for (const Joint& joint : scene.joints) {
    const std::vector<DriveKink> kinks = drive_kinks(joint, scene.motion);
    for (std::size_t i = 0; i < kinks.size(); ++i) {
      if (!kinks[i].endless[0] && !kinks[i].endless[1]) continue;
      const auto sides = room(kinks, i, scene.motion.step);
      words.push_back(fmt::format(
          "joint {}: the acceleration of its drive \"{}\" is infinite at t = {:.6g} s; a polynomial of fourth degree "
          "replaces the drive for {:.3g} s ({:.0f} steps); use a formula with a finite second derivative",
          joint.name, formula_of(joint).text(), kinks[i].before,
          (kinks[i].endless[0] ? sides[0] : 0) + (kinks[i].endless[1] ? sides[1] : 0),
          ((kinks[i].endless[0] ? sides[0] : 0) + (kinks[i].endless[1] ? sides[1] : 0)) / scene.motion.step));
    }
  }
  return words;
}

}  // namespace floe::assembly
