// Springs between nodes of a body from a deck: in every formulation, in several floating frames, at large rotations.
#include <catch2/catch.hpp>

#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

constexpr double EI = 200, k_t = 4e5, k_r = 50;

/// A beam of 1 m along x, with a bush at x = 1/4 between two of its nodes there; `factor` on E.
std::string jointed_deck(double factor) {
  std::string text =
      fmt::format("BEGIN BULK\nMAT1,1,{:.6E},,0.3,2700.\nPBAR,1,1,4.E-4,2.E-8,1.E-8,2.E-8\n", 1e10 * factor);
  for (int i = 0; i <= 8; ++i) text += fmt::format("GRID,{},,{:.4f},0.,0.\n", i + 1, i / 8.);
  text += "GRID,20,,0.25,0.,0.\n";
  for (int i = 0; i < 8; ++i) text += fmt::format("CBAR,{},1,{},{},0.,1.,0.\n", i + 1, i == 2 ? 20 : i + 1, i + 2);
  return text +
         fmt::format("CBUSH,30,9,3,20,,,,0\nPBUSH,9,K,{0:.1E},{0:.1E},{0:.1E},{1:.1E},{1:.1E},{1:.1E}\nENDDATA\n", k_t,
                     k_r);
}

std::string scene_of(const std::string& deck, const std::string& keys, const std::string& load) {
  return fill(R"yaml(
bodies:
  b: {mesh: {file: {path: $deck}}, reduction: {modes: 4, attachment: all}$keys}
joints: {root: {type: fixed, between: [ground, {body: b, node: [0, 0, 0]}]}}
loads: {tip: {at: {body: b, node: [1, 0, 0]}, $load}}
motion: {end: 1, step: 1}
probes: {tip: {at: {body: b, node: [1, 0, 0]}, quantity: position}}
)yaml",
              {{"deck", deck}, {"keys", keys}, {"load", load}});
}

}  // namespace

// Force P at the tip: w = P (1/(3 EI) + 1/k_t + (3/4)^2/k_r).
TEST_CASE("springs of decks: the deflection of a beam with an elastic joint, in all formulations and in two frames") {
  const Scratch scratch;
  const std::string deck = (scratch.path / "jointed.bdf").string();
  write_text(deck, jointed_deck(1));
  const double P = 1e-3, expected = P * (1 / (3 * EI) + 1 / k_t + 9. / 16 / k_r);
  const std::string load = "type: force, force: [0, 1e-3, 0]";
  for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr, Formulation::vm_md})
    for (const std::string keys : {"", ", frames: 2"}) {
      if (formulation == Formulation::cfr && !keys.empty()) continue;
      INFO(scene::name_of(formulation) << keys);
      CHECK(rest(scene_of(deck, keys, load), formulation)["tip.y"].back() == Approx(expected).epsilon(1e-6));
    }
}

// A moment M bends the joint by M/k_r: nearly rigid beams.
TEST_CASE("springs of decks: an elastic joint rotated by 1 rad, corotational") {
  const Scratch scratch;
  const std::string deck = (scratch.path / "stiff.bdf").string();
  write_text(deck, jointed_deck(1e6));
  const History at = rest(scene_of(deck, "", "type: moment, moment: [0, 0, 50]"), Formulation::cfr, 10);
  CHECK(at["tip.x"].back() == Approx(0.25 + 0.75 * std::cos(1.)).epsilon(1e-6));
  CHECK(at["tip.y"].back() == Approx(0.75 * std::sin(1.)).epsilon(1e-6));
}
