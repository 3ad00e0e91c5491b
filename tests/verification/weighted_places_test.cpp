// Places whose nodes have weights by their file: RBE3.
#include <catch2/catch.hpp>

#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

constexpr double heights[] = {0, 0.05, 0.1, 0.4}, weights[] = {1, 1, 1, 3};
constexpr double mean = (0.05 + 0.1 + 3 * 0.4) / 6;

/// A plate of 1 x 0.4, clamped at x = 0, with an RBE3 of the nodes at x = 1.
std::string plate_deck() {
  std::string text = "BEGIN BULK\nMAT1,1,7.+10,,0.3,2700.\nPSHELL,1,1,0.01,1,,1\n";
  for (int i = 0; i <= 6; ++i)
    for (int j = 0; j < 4; ++j) text += fmt::format("GRID,{},,{:.6f},{:.4f},0.\n", 4 * i + j + 1, i / 6., heights[j]);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = 4 * i + j + 1;
      text += fmt::format("CQUAD4,{},1,{},{},{},{}\n", 3 * i + j + 1, a, a + 4, a + 5, a + 1);
    }
  return text + fmt::format("GRID,90,,1.,{:.12f},0.\nRBE3,70,,90,123456,1.,123,25,26\n,27,3.,123,28\n", mean) +
         "SPC1,1,123456,1,2,3,4\nENDDATA\n";
}

std::string scene_of(const std::string& deck, const std::string& loads) {
  return fill(R"yaml(
bodies:
  b: {mesh: {file: {path: $deck}}, reduction: {modes: 4, attachment: all}}
joints: {root: {type: fixed, between: [ground, b.SPC1]}}
loads: {$loads}
motion: {end: 1, step: 1}
probes: {corner: {at: {body: b, node: [1, 0, 0]}, quantity: displacement}, mean: {at: b.RBE3_70, quantity: displacement}}
)yaml",
              {{"deck", deck}, {"loads", loads}});
}

}  // namespace

// A force acts on the nodes as w_i F, a moment as forces w_i (J^-1 m) x r_i, J = sum w_i (r_i^2 1 - r_i r_i'); the
// place moves by sum w_i u_i.
TEST_CASE("RBE3: forces and moments are distributed by the weights of the card") {
  const Scratch scratch;
  const std::string deck = (scratch.path / "mean.bdf").string();
  write_text(deck, plate_deck());
  double J = 0;
  for (int j = 0; j < 4; ++j) J += weights[j] / 6 * std::pow(heights[j] - mean, 2);
  const auto [whole, force, moment] =
      GENERATE(std::tuple(std::string("type: force, force: [1000, 500, 20]"), Eigen::Vector3d(1000, 500, 20), 0.),
               std::tuple(std::string("type: moment, moment: [0, 0, 100]"), Eigen::Vector3d(0, 0, 0), 100.));
  std::string parts;
  for (int j = 0; j < 4; ++j) {
    const Eigen::Vector3d f = weights[j] / 6 * (force + moment / J * Eigen::Vector3d(-(heights[j] - mean), 0, 0));
    parts +=
        fmt::format("f{}: {{type: force, at: {{body: b, node: [1, {}, 0]}}, force: [{:.12g}, {:.12g}, {:.12g}]}}, ", j,
                    heights[j], f.x(), f.y(), f.z());
  }
  for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr, Formulation::vm_md}) {
    INFO(scene::name_of(formulation) << " " << whole);
    History one = rest(scene_of(deck, "p: {at: b.RBE3_70, " + whole + "}"), formulation);
    History other = rest(scene_of(deck, parts), formulation);
    for (const std::string probe : {"corner", "mean"}) {
      const auto at = [&](History& history) {
        return Eigen::Vector3d(history[probe + ".x"].back(), history[probe + ".y"].back(),
                               history[probe + ".z"].back());
      };
      const Eigen::Vector3d off = (at(one) - at(other)).cwiseAbs(), size = at(other).cwiseAbs();
      CHECK(off.head<2>().norm() < 2e-4 * size.head<2>().norm());
      CHECK(off.z() <= 2e-4 * size.z());
    }
  }
}

// A shaft along (1, 2, 3), coordinates of 6 decimals: a line, though rounding moves its grids off it. A moment about it
// acts on the grids by their weights, a third of it on each of the last three: 5/9 M h / GJ beyond the first of these.
TEST_CASE("RBE3: grids on one line rotate about it by themselves") {
  const Scratch scratch;
  const std::string deck = (scratch.path / "shaft.bdf").string();
  const Eigen::Vector3d end(1, 2, 3), along = end.normalized();
  std::string text = "BEGIN BULK\nMAT1,1,7.+10,,0.3,2700.\nPBAR,1,1,4.E-4,2.E-8,1.E-8,2.E-8\n";
  for (int i = 0; i <= 6; ++i)
    text += fmt::format("GRID,{},,{:.6f},{:.6f},{:.6f}\n", i + 1, end.x() * i / 6, end.y() * i / 6, end.z() * i / 6);
  for (int i = 0; i < 6; ++i) text += fmt::format("CBAR,{},1,{},{},0.,0.,1.\n", i + 1, i + 1, i + 2);
  const Eigen::Vector3d mean = end * 5 / 6;
  text += fmt::format("GRID,90,,{:.6f},{:.6f},{:.6f}\nRBE3,70,,90,123456,1.,123,5,6\n,7\nSPC1,1,123456,1\nENDDATA\n",
                      mean.x(), mean.y(), mean.z());
  write_text(deck, text);
  const std::string scene =
      fill(R"yaml(
bodies: {b: {mesh: {file: {path: $deck}}, reduction: {modes: 4, attachment: all}}}
joints: {root: {type: fixed, between: [ground, b.SPC1]}}
loads: {p: {type: moment, at: b.RBE3_70, moment: [$x, $y, $z]}}
motion: {end: 1, step: 1}
probes: {turn: {at: b.RBE3_70, quantity: rotation}, mean: {at: b.RBE3_70, quantity: displacement}}
)yaml",
           {{"deck", deck}, {"x", number(along.x())}, {"y", number(along.y())}, {"z", number(along.z())}});
  const double GJ = 7e10 / 2.6 * 2e-8, L = end.norm(), expected = (4. / 6 + 5. / 9 / 6) * L / GJ;
  for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr, Formulation::vm_md}) {
    INFO(scene::name_of(formulation));
    History at = rest(scene, formulation);
    const Eigen::Vector3d turn(at["turn.rx"].back(), at["turn.ry"].back(), at["turn.rz"].back());
    CHECK((turn - expected * along).norm() < 1e-4 * expected);
    CHECK(std::abs(at["mean.x"].back()) + std::abs(at["mean.y"].back()) + std::abs(at["mean.z"].back()) < 1e-6);
  }
}

// A moment on two parallel cantilevers at a distance 2 a is a pair of forces M / (2 a): w = M / (2 a) L^3 / (3 EI).
TEST_CASE("*DISTRIBUTING: moments on nodes of beams are forces") {
  const Scratch scratch;
  const std::string deck = (scratch.path / "pair.inp").string();
  write_text(deck,
             "*NODE\n1, 0, -0.1\n2, 1, -0.1\n3, 0, 0.1\n4, 1, 0.1\n50, 1, 0\n*ELEMENT, TYPE=B31, ELSET=B\n1, 1, 2\n"
             "2, 3, 4\n3, 1, 3\n*MATERIAL, NAME=M\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*BEAM SECTION, ELSET=B, "
             "SECTION=RECT, MATERIAL=M\n0.02, 0.01\n0, 0, 1\n*NSET, NSET=root\n1, 3\n*SURFACE, NAME=tips, TYPE=NODE\n"
             "2\n4\n*COUPLING, CONSTRAINT NAME=c, SURFACE=tips, REF NODE=50\n*DISTRIBUTING\n1, 6\n");
  const std::string scene = fill(R"yaml(
bodies: {b: {mesh: {file: {path: $deck}}, reduction: {modes: 4, attachment: all}}}
joints: {root: {type: fixed, between: [ground, b.root]}}
loads: {p: {type: moment, at: b.tips, moment: [0.01, 0, 0]}}
motion: {end: 1, step: 1}
probes: {turn: {at: b.tips, quantity: rotation}, one: {at: {body: b, node: [1, 0.1, 0]}, quantity: displacement}}
)yaml",
                                 {{"deck", deck}});
  const double EI = 2e11 * 0.01 * std::pow(0.02, 3) / 12, w = 0.01 / 0.2 / (3 * EI);
  for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr, Formulation::vm_md}) {
    INFO(scene::name_of(formulation));
    History at = rest(scene, formulation);
    CHECK(at["one.z"].back() == Approx(w).epsilon(1e-3));
    CHECK(at["turn.rx"].back() == Approx(w / 0.1).epsilon(1e-3));
  }
}
