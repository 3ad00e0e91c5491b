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

// A bush of viscosity alone; it made an element without rows, at which reduced and full-order models crashed.
TEST_CASE("springs of decks: those without stiffness are omitted and named") {
  const Scratch scratch;
  const std::string deck = (scratch.path / "jointed.bdf").string(), damped = (scratch.path / "damped.bdf").string();
  std::string text = jointed_deck(1);
  write_text(deck, text);
  text.insert(text.find("ENDDATA"), "CBUSH,31,10,1,9,,,,0\nPBUSH,10,B,1.E5\nCELAS2,32,0.,1,1,9,1\n");
  write_text(damped, text);
  for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr, Formulation::vm_md}) {
    const std::string load = "type: force, force: [0, 1e-3, 0]";
    CHECK(rest(scene_of(damped, "", load), formulation)["tip.y"].back() ==
          Approx(rest(scene_of(deck, "", load), formulation)["tip.y"].back()).epsilon(1e-10));
  }
  const scene::Scene scene = scene::parse_scene(scene_of(damped, "", "type: force, force: [0, 1, 0]"), "scene");
  const assembly::Model model = assembly::build(scene, Formulation::nlffr, PETSC_COMM_WORLD);
  CHECK(std::count_if(model.warnings.begin(), model.warnings.end(), [](const std::string& text) {
          return text.find("2 springs without stiffness are omitted") != std::string::npos;
        }) == 1);
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

namespace {

/// A bush over a gap of 0.3 m between two beams, of 0.25 and of 0.75 m, that are nearly rigid.
std::string gap_deck() {
  std::string text = "BEGIN BULK\nMAT1,1,1.+14,,0.3,2700.\nPBAR,1,1,4.E-4,2.E-8,2.E-8,2.E-8\n";
  for (int i = 0; i <= 2; ++i) text += fmt::format("GRID,{},,{:.4f},0.,0.\n", i + 1, i / 8.);
  for (int i = 0; i <= 6; ++i) text += fmt::format("GRID,{},,{:.4f},0.,0.\n", i + 11, 0.55 + i / 8.);
  for (int i : {1, 2, 11, 12, 13, 14, 15, 16}) text += fmt::format("CBAR,{0},1,{0},{1},0.,1.,0.\n", i, i + 1);
  return text + "CBUSH,30,9,3,11,0.,1.,0.\nPBUSH,9,K,1.E8,1.E8,1.E8,50.,50.,50.\nENDDATA\n";
}

/// A beam of 1 m and, beside it, a spring between its ends that takes nearly all of a tension.
std::string strut_deck(const std::string& spring) {
  std::string text = "*NODE\n";
  for (int i = 0; i <= 16; ++i) text += fmt::format("{}, {:.6f}, 0, 0\n", i + 1, i / 16.);
  text += "*ELEMENT, TYPE=B31, ELSET=E\n";
  for (int i = 1; i <= 16; ++i) text += fmt::format("{0}, {0}, {1}\n", i, i + 1);
  return text + "*ELEMENT, TYPE=" + spring +
         "*MATERIAL, NAME=M\n*ELASTIC\n7e10, 0.3\n*DENSITY\n2700\n*BEAM SECTION, ELSET=E, SECTION=RECT, "
         "MATERIAL=M\n0.01, 0.01\n0, 1, 0\n";
}

/// At rest under a force at its end. @param quantity  of the end
History pulled(const std::string& deck, const std::string& end, const std::string& force, const std::string& quantity,
               Formulation formulation) {
  return rest(fill(R"yaml(
bodies:
  b: {mesh: {file: {path: $deck}}, reduction: {modes: 4, attachment: all}}
joints: {root: {type: fixed, between: [ground, {body: b, node: [0, 0, 0]}]}}
loads: {tip: {type: force, at: {body: b, node: $end}, force: $force}}
motion: {end: 1, step: 1}
probes: {tip: {at: {body: b, node: $end}, quantity: $quantity}}
)yaml",
                   {{"deck", deck}, {"end", end}, {"force", force}, {"quantity", quantity}}),
              formulation);
}

}  // namespace

// k_r theta = F a - N a theta: what is carried at an arm a of the joint straightens under tension.
TEST_CASE("springs of decks: an elastic joint over a gap is stiffened by tension") {
  const Scratch scratch;
  const std::string deck = (scratch.path / "gap.bdf").string();
  write_text(deck, gap_deck());
  const double a = 0.9;
  for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr, Formulation::vm_md}) {
    INFO(scene::name_of(formulation));
    const History at = pulled(deck, "[1.3, 0, 0]", "[100, 0.1, 0]", "rotation", formulation);
    CHECK(at["tip.rz"].back() == Approx(0.1 * a / (50 + 100 * a)).epsilon(1e-3));
  }
}

// A string beside a beam: F/w = T/L + P/(L (1 - tanh(s)/s)), s = L sqrt(P/EI), of the tension N = T + P.
TEST_CASE("springs of decks: a spring along a line follows its ends") {
  const Scratch scratch;
  const std::string deck = (scratch.path / "strut.inp").string();
  write_text(deck, strut_deck("SPRINGA, ELSET=S\n99, 1, 17\n*SPRING, ELSET=S\n\n1e8\n"));
  const double EI = 7e10 * 1e-8 / 12, EA = 7e6, N = 1000, T = N * 1e8 / (1e8 + EA), P = N - T, s = std::sqrt(P / EI);
  const double expected = 0.1 / (T + P / (1 - std::tanh(s) / s));
  for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr, Formulation::vm_md}) {
    INFO(scene::name_of(formulation));
    const History at = pulled(deck, "[1, 0, 0]", "[1000, 0, 0.1]", "displacement", formulation);
    CHECK(at["tip.z"].back() == Approx(expected).epsilon(2e-3));
  }
}
