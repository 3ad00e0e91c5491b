#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

namespace {

/// The flying spaghetti: EA = GA = 1e4, EI = GJ = 500, mass 1 and rotary inertia 10 about each axis per length, from
/// (6, 0, 0) to (0, 8, 0), in `count` bodies of `elements` elements that are welded together. A section of these
/// stiffnesses has a rotary inertia of 0.05 across and 0.1 along; rigid wheels at the ends of the bodies carry the
/// rest: rods along the beam, whose length gives half of the inertia across and whose section the other half and that
/// along, of 6e-5 of the mass.
std::string scene_of(int count, int elements, const std::string& end, const std::string& step) {
  std::string bodies, joints;
  const auto at = [&](int i) { return fmt::format("[{:.17g}, {:.17g}, 0]", 6 - 6. * i / count, 8. * i / count); };
  for (int i = 0; i < count; ++i) {
    bodies +=
        fill(R"yaml(
  b$i:
    mesh: {line: {from: $from, to: $to, elements: $elements}}
    section: {A: 1, Iy: 0.05, Iz: 0.05, J: 0.05, orientation: [0, 0, 1], shear_factor: [1, 1]}
    material: {E: 1e4, G: 1e4, nu: 0, rho: 1}
    frame: pinned
    reduction: {modes: 6}
)yaml",
             {{"i", std::to_string(i)}, {"from", at(i)}, {"to", at(i + 1)}, {"elements", std::to_string(elements)}});
    for (int k = i > 0 ? 1 : 0; k < 2; ++k) {  // at its start (the first), at its end
      const double share = 10. / count * (k == 0 || (i == count - 1 && k == 1) ? 0.5 : 1);
      bodies += fill(
          R"yaml(
  w$i_$k:
    rigid: true
    mesh: {line: {from: [300, -400, 0], to: [-300, 400, 0], elements: 2}}
    section: {A: 12e-6, Iy: 0.99, Iz: 0.99, J: 1, orientation: [0, 0, 1]}
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

// Table: independent converged computation, to +-0.003. Bodies bend little in their own frames: errors fall to a
// quarter with twice as many. What 16 and 32 of them promise of infinitely many is within what the table leaves open.
TEST_CASE("spaghetti: the ends of the flying beam with shear, in 8, 16 and 32 frames") {
  const std::vector<std::pair<double, std::string>> where{{2.5, "loaded"}, {2.5, "free"}, {5, "loaded"}, {5, "free"}};
  const std::vector<Eigen::Vector3d> table{
      {3.4130, .1969, -.0174}, {4.0238, 8.4955, .7330}, {19.563, 1.521, 1.508}, {11.879, 6.881, -1.830}};
  const auto positions = [&](int count) {
    const History at = move(scene_of(count, 32 / count, "5", "1e-2"), Formulation::vm_md);
    std::vector<Eigen::Vector3d> all;
    for (const auto& [t, place] : where)
      all.emplace_back(at.at(place + ".x", t), at.at(place + ".y", t), at.at(place + ".z", t));
    return all;
  };
  const auto away = [&](const std::vector<Eigen::Vector3d>& found, double t) {
    double greatest = 0;
    for (std::size_t i = 0; i < where.size(); ++i)
      if (where[i].first == t) greatest = std::max(greatest, (found[i] - table[i]).cwiseAbs().maxCoeff());
    return greatest;
  };
  const auto coarse = positions(8), middle = positions(16), fine = positions(32);
  std::vector<Eigen::Vector3d> limit;
  for (std::size_t i = 0; i < where.size(); ++i) limit.push_back(fine[i] + (fine[i] - middle[i]) / 3);
  CHECK(away(coarse, 2.5) < 0.02);
  CHECK(away(middle, 2.5) < 0.006);
  CHECK(away(fine, 2.5) < 0.003);
  CHECK(away(limit, 2.5) < 0.003);
  CHECK(away(coarse, 5) < 0.06);
  CHECK(away(middle, 5) < 0.018);
  CHECK(away(fine, 5) < 0.006);
  CHECK(away(limit, 5) < 0.003);
}
