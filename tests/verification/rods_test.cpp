// Lattices of rods from Nastran decks, whose grids no beam or shell holds.
#include <catch2/catch.hpp>

#include "eigenvalues.h"
#include "floe/assess/body_properties.h"
#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

constexpr double E = 7e10, A = 1e-4, rho = 2700;

/// A tower of so many bays: four legs, frames and diagonals of rods between pins. One that is crossed has both
/// diagonals of each square, and no frame at its feet.
struct Tower {
  explicit Tower(int bays, double width = 1, double height = 1, bool crossed = false) {
    for (int bay = 0; bay <= bays; ++bay)
      for (const auto& [x, y] : {std::pair{0., 0.}, {1., 0.}, {1., 1.}, {0., 1.}})
        grids.emplace_back(width * x, width * y, height * bay);
    if (!crossed) rods = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}};
    for (int foot = 0; foot < 4 * bays; foot += 4) {
      for (int i = 0; i < 4; ++i) {
        const int next = (i + 1) % 4;
        rods.insert(rods.end(),
                    {{foot + i, foot + 4 + i}, {foot + 4 + i, foot + 4 + next}, {foot + i, foot + 4 + next}});
        if (crossed) rods.emplace_back(foot + next, foot + 4 + i);
      }
      rods.emplace_back(foot + 4, foot + 6);
      if (crossed) rods.emplace_back(foot + 5, foot + 7);
    }
  }
  /// J: of each rod [m^4]. The grids of `from_top` have their numbers from the highest on.
  std::string deck(const std::string& J, bool from_top = false) const {
    std::string text = "BEGIN BULK\nPROD,1,1,1.-4," + J + "\nMAT1,1,7.+10,,.3,2700.\n";
    const auto number = [&](std::size_t i) { return (from_top ? grids.size() - 4 - i / 4 * 4 + i % 4 : i) + 1; };
    for (std::size_t i = 0; i < grids.size(); ++i) {
      const Eigen::Vector3d& x = grids[number(i) - 1];
      text += fmt::format("GRID,{},,{:.1f},{:.1f},{:.1f}\n", i + 1, x.x(), x.y(), x.z());
    }
    for (std::size_t i = 0; i < rods.size(); ++i)
      text += fmt::format("CROD,{},1,{},{}\n", i + 1, number(rods[i].first), number(rods[i].second));
    return text + "ENDDATA\n";
  }
  /// Of bars between pins, with consistent mass.
  std::pair<Eigen::MatrixXd, Eigen::MatrixXd> matrices() const {
    const auto n = static_cast<Eigen::Index>(3 * grids.size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), M = K;
    for (const auto& [a, b] : rods) {
      const Eigen::Vector3d line = grids[b] - grids[a];
      const double length = line.norm();
      const Eigen::Matrix3d k = E * A / std::pow(length, 3) * line * line.transpose(),
                            m = rho * A * length / 6 * Eigen::Matrix3d::Identity();
      for (const int i : {a, b})
        for (const int j : {a, b}) {
          K.block<3, 3>(3 * i, 3 * j) += i == j ? k : -k;
          M.block<3, 3>(3 * i, 3 * j) += (i == j ? 2 : 1) * m;
        }
    }
    return {K, M};
  }
  std::vector<Eigen::Vector3d> grids;
  std::vector<std::pair<int, int>> rods;
};

const char* const standing = R"yaml(
bodies:
  tower: {mesh: {file: {path: $deck}}, reduction: {modes: 6}}
joints:
  a: {type: spherical, between: [ground, {body: tower, node: [0, 0, 0]}]}
  b: {type: spherical, between: [ground, {body: tower, node: [1, 0, 0]}]}
  c: {type: spherical, between: [ground, {body: tower, node: [1, 1, 0]}]}
  d: {type: spherical, between: [ground, {body: tower, node: [0, 1, 0]}]}
loads: {push: {type: force, at: {body: tower, node: [0, 0, 4]}, force: [10, 20, -5]}}
probes: {tip: {at: {body: tower, node: [0, 0, 4]}}}
)yaml";

}  // namespace

TEST_CASE("frequencies of a free tower of rods are those of bars between pins") {
  const Scratch scratch;
  const Tower tower(4);
  const auto [K, M] = tower.matrices();
  const Eigen::VectorXd lambda = testing::eigenvalues(K, M);
  for (const std::string J : {"", "1.-9"}) {
    const std::string deck = (scratch.path / ("tower" + J + ".bdf")).string();
    write_text(deck, tower.deck(J));
    const std::vector<double> omega =
        omega_of(fill("bodies: {b: {mesh: {file: {path: $deck}}, reduction: {modes: 8}}}\n", {{"deck", deck}}));
    REQUIRE(omega.size() == 8);
    for (int i = 0; i < 8; ++i) {
      INFO("J = " << J << ", mode " << i + 1);
      CHECK(omega[i] == Approx(std::sqrt(lambda[6 + i])).epsilon(J.empty() ? 1e-7 : 1e-5));
    }
  }
}

TEST_CASE("a tower of rods gives way to a force as bars between pins, in every formulation") {
  const Scratch scratch;
  const Tower tower(4);
  const std::string deck = (scratch.path / "tower.bdf").string();
  write_text(deck, tower.deck(""));
  const Eigen::MatrixXd K = tower.matrices().first.bottomRightCorner(48, 48);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(48);
  force.segment<3>(36) << 10, 20, -5;
  const Eigen::Vector3d expected = K.llt().solve(force).segment<3>(36);
  for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr}) {
    const assembly::Model model =
        assembly::build(scene::parse_scene(fill(standing, {{"deck", deck}}), "scene"), formulation, PETSC_COMM_WORLD);
    solve::equilibrium(*model.system, 0, model.U, model.V);
    const std::vector<double> tip = assembly::probe_values(model, 0, model.U, model.V, model.V);
    const Eigen::Vector3d moved(tip[0], tip[1], tip[2]);
    INFO(name_of(formulation) << ": " << moved.transpose() << ", expected " << expected.transpose());
    CHECK((moved - expected).norm() < 1e-4 * expected.norm());  // of second order
  }
}

// The dimensions of the tower of 72 bars of Haftka & Guerdal, Elements of structural optimization, 3rd ed., ch. 6.
TEST_CASE("a tower whose supports hold the rotations of its pins has the frequencies of bars, free and standing") {
  const Scratch scratch;
  const Tower tower(4, 120, 60, true);
  REQUIRE(tower.rods.size() == 72);
  const std::string deck = (scratch.path / "tower.bdf").string();
  write_text(deck, tower.deck("", true));
  std::string text = "bodies: {b: {mesh: {file: {path: " + deck + "}}, reduction: {modes: 8}}}\njoints:\n";
  for (std::size_t i = 0; i < tower.grids.size(); ++i)
    text += fmt::format("  s{}: {{type: support, between: [ground, {{body: b, node: [{}, {}, {}]}}], hold: [{}]}}\n", i,
                        tower.grids[i].x(), tower.grids[i].y(), tower.grids[i].z(), i < 4 ? "x, y, z" : "rx, ry, rz");
  const auto [K, M] = tower.matrices();
  const auto omega = [](const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass, Eigen::Index first) {
    const Eigen::VectorXd lambda = testing::eigenvalues(stiffness, mass);
    return Eigen::VectorXd(lambda.segment(first, 8).cwiseSqrt());
  };
  const Eigen::VectorXd free = omega(K, M, 6),
                        standing_still = omega(K.bottomRightCorner(48, 48), M.bottomRightCorner(48, 48), 0);
  const auto found = assess::body_properties(scene::parse_scene(text, "scene"), PETSC_COMM_WORLD, 8).at(0);
  REQUIRE(found.free.size() == 8);
  REQUIRE(found.constrained.size() == 8);
  for (int i = 0; i < 8; ++i) {
    INFO("mode " << i + 1);
    CHECK(found.free[i] == Approx(free[i]).epsilon(1e-7));
    CHECK(found.constrained[i] == Approx(standing_still[i]).epsilon(1e-6));
  }
}
