#include <catch2/catch.hpp>
#include <tuple>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

namespace {

/// The flying spaghetti: EA = 1e4, EI = GJ = 500, mass 1 and rotary inertia 10 about each axis per length, from (6, 0,
/// 0) to (0, 8, 0), in `count` bodies of `elements` elements that are welded together. No section of these stiffnesses
/// has that rotary inertia (its own is 0.05 across and 0.1 along): rigid wheels at the ends of the bodies carry it,
/// rods whose length gives the inertia across and whose section that along, of 6e-6 of the mass.
std::string scene_of(int count, int elements, const std::string& end, const std::string& step, bool shear) {
  std::string bodies, joints;
  const auto at = [&](int i) { return fmt::format("[{:.17g}, {:.17g}, 0]", 6 - 6. * i / count, 8. * i / count); };
  for (int i = 0; i < count; ++i) {
    bodies +=
        fill(R"yaml(
  b$i:
    mesh: {line: {from: $from, to: $to, elements: $elements}}
    section: {A: 1, Iy: 0.05, Iz: 0.05, J: 0.05, orientation: [0, 0, 1]$shear}
    material: {E: 1e4, G: 1e4, nu: 0, rho: 1}
    frame: pinned
    reduction: {modes: 6}
)yaml",
             {{"i", std::to_string(i)}, {"from", at(i)}, {"to", at(i + 1)}, {"elements", std::to_string(elements)}, {"shear", shear ? ", shear_factor: [1, 1]" : ""}});
    for (int k = i > 0 ? 1 : 0; k < 2; ++k) {  // at its start (the first), at its end
      const double share = 10. / count * (k == 0 || (i == count - 1 && k == 1) ? 0.5 : 1);
      bodies += fill(
          R"yaml(
  w$i_$k:
    rigid: true
    mesh: {line: {from: [-500, 0, 0], to: [500, 0, 0], elements: 2}}
    section: {A: 12e-6, Iy: 1, Iz: 1, J: 1, orientation: [0, 0, 1]}
    material: {E: 1, G: 1, nu: 0, rho: $rho}
    initial: {position: $at}
)yaml",
          {{"i", std::to_string(i)}, {"k", std::to_string(k)}, {"at", at(i + k)}, {"rho", number(5 * share / 1000)}});
      joints += fmt::format("  f{}_{}: {{type: fixed, between: [b{}.{}, w{}_{}.middle]}}\n", i, k, i,
                            k ? "end" : "start", i, k);
    }
    if (i > 0) joints += fmt::format("  j{}: {{type: fixed, between: [b{}.end, b{}.start]}}\n", i, i - 1, i);
  }
  return "bodies:" + bodies + (joints.empty() ? "" : "joints:\n" + joints) +
         fill(R"yaml(
loads:
  force: {type: force, at: b0.start, force: ["t < 2.5 ? 8*t : t < 5 ? 8*(5 - t) : 0", 0, 0]}
  moment: {type: moment, at: b0.start,
           moment: [0, "t < 2.5 ? 40*t : t < 5 ? 40*(5 - t) : 0", "t < 2.5 ? -80*t : t < 5 ? -80*(5 - t) : 0"]}
motion: {end: $end, step: $step}
probes: {loaded: {at: b0.start, quantity: position}, free: {at: b$last.end, quantity: position}}
)yaml",
              {{"end", end}, {"step", step}, {"last", std::to_string(count - 1)}});
}

}  // namespace

// Table: independent converged computation of a beam with shear, GA = 1e4, to +-0.003. Without shear beams stay away
// from it by the order of 3 EI / (GA L^2), 0.15 % of a deflection: 32 bodies come as near as 0.012 at t = 2.5 and 0.08 at
// t = 5. What is over the table's own error falls to a quarter with twice as many bodies.
TEST_CASE("spaghetti: the ends of the flying beam with shear, in 8, 16 and 32 frames") {
  const auto away = [](const History& at, double t, const std::string& place, const Eigen::Vector3d& table) {
    const Eigen::Vector3d p(at.at(place + ".x", t), at.at(place + ".y", t), at.at(place + ".z", t));
    return (p - table).cwiseAbs().maxCoeff();
  };
  for (const auto& [count, early, late] : {std::tuple(8, 0.03, 0.1), {16, 0.01, 0.03}, {32, 0.005, 0.01}}) {
    INFO(count);
    const History at = move(scene_of(count, 32 / count, "5", "1e-2", true), Formulation::vm_md);
    CHECK(away(at, 2.5, "loaded", {3.4130, .1969, -.0174}) < early);
    CHECK(away(at, 2.5, "free", {4.0238, 8.4955, .7330}) < early);
    CHECK(away(at, 5, "loaded", {19.563, 1.521, 1.508}) < late);
    CHECK(away(at, 5, "free", {11.879, 6.881, -1.830}) < late);
  }
}
