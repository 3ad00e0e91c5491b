#include <catch2/catch.hpp>

#include "../../src/app/equilibrium.h"
#include "spatial_scenes.h"
#include "truss.h"

using namespace floe;
using namespace floe::test;

namespace {

app::RunResult path_of(const std::string& text, Formulation formulation, double at, int steps, int points = 1000) {
  return app::rest(scene::parse_scene(text, "scene"), formulation, PETSC_COMM_WORLD, {at, steps, true, points},
                   std::nullopt, false);
}

std::vector<double> column(const app::RunResult& result, const std::string& name) {
  const auto at = std::find_if(result.series.columns.begin(), result.series.columns.end(),
                               [&](const auto& one) { return one.name == name; });
  REQUIRE(at != result.series.columns.end());
  std::vector<double> values;
  for (const auto& row : result.series.values) values.push_back(row[at - result.series.columns.begin()]);
  return values;
}

/// Loads of the limit points, in order.
std::vector<double> limits_of(const app::RunResult& result) {
  std::vector<double> loads;
  for (const auto& point : result.summary["path"]["limit_points"]) loads.push_back(point["t"]);
  return loads;
}

/// The force at its apex where that is x above the supports. Engineering strain of straight bars:
/// P = 2 EA (l0 - l)/l0 x/l, l^2 = 1 + x^2; maximum and minimum at l^3 = l0.
double truss_load(double h, double x) { return 2e3 * (1 - std::hypot(1, x) / std::hypot(1, h)) * x / std::hypot(1, x); }

double truss_limit(double h) { return truss_load(h, std::sqrt(std::pow(std::hypot(1, h), 2. / 3) - 1)); }

/// A clamped beam of length 1, EI = 1, under an axial force t with these settings.
std::string strut(const std::string& settings) {
  return fill(R"yaml(
bodies: {beam: {mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}, section: {EA: 1e6, EI: 1, rhoA: 1}}}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {push: {type: force, at: beam.end, force: [-t, 0]$settings}}
probes: {tip: {at: beam.end}}
)yaml",
              {{"settings", settings}});
}

/// A roof of n x n quadrilaterals: 508 along its axis, radius 2540, half angle 0.1, E = 3102.75, nu = 0.3, every node
/// of its straight edges hinged, its curved ones free, a force of 3000 t at its crown [N, mm].
struct Roof {
  Scratch folder;
  int n;
  double h;
  std::string text(int modes = 8) const {
    const auto node = [&](int i, int j) { return j * (n + 1) + i + 1; };
    std::string deck = "*NODE\n", joints;
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const double a = 0.1 * (2. * j / n - 1);
        deck += fmt::format("{}, {:.15g}, {:.15g}, {:.15g}\n", node(i, j), 508. * i / n, 2540 * std::sin(a),
                            2540 * std::cos(a));
      }
    deck += "*ELEMENT, TYPE=S4, ELSET=skin\n";
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        deck += fmt::format("{}, {}, {}, {}, {}\n", j * n + i + 1, node(i, j), node(i + 1, j), node(i + 1, j + 1),
                            node(i, j + 1));
    deck += fmt::format("*NSET, NSET=crown\n{},\n", node(n / 2, n / 2));
    for (const int j : {0, n})
      for (int i = 0; i <= n; ++i) {
        deck += fmt::format("*NSET, NSET=n{}\n{},\n", node(i, j), node(i, j));
        joints += fmt::format("  j{0}: {{type: spherical, between: [ground, roof.n{0}]}}\n", node(i, j));
      }
    deck += fmt::format(
        "*MATERIAL, NAME=M\n*ELASTIC\n3102.75, 0.3\n*DENSITY\n1e-6,\n*SHELL SECTION, ELSET=skin, MATERIAL=M\n{},\n", h);
    const std::string path = folder.path / "roof.inp";
    write_text(path, deck);
    return fmt::format(
        "bodies: {{roof: {{mesh: {{file: {{path: {}}}}}, reduction: {{modes: {}}}}}}}\njoints:\n{}loads: {{p: {{type: "
        "force, at: roof.crown, force: [0, 0, \"-3000*t\"]}}}}\nprobes: {{crown: {{at: roof.crown}}}}\n",
        path, modes, joints);
  }
};

}  // namespace

TEST_CASE("path: von Mises' truss through both limit points, every point against the closed form") {
  const double h = GENERATE(0.05, 0.3), limit = truss_limit(h);
  for (const Formulation formulation : {Formulation::cfr, Formulation::nlffr, Formulation::vm_md}) {
    INFO(h << " " << scene::name_of(formulation));
    const bool exact = formulation == Formulation::cfr || h < 0.1;
    const app::RunResult path = path_of(truss(h), formulation, 2 * limit, 20);
    const std::vector<double> y = column(path, "apex.y"), limits = limits_of(path);
    REQUIRE(path.series.t.size() > 30);
    for (std::size_t i = 0; i < y.size(); ++i)
      CHECK(path.series.t[i] == Approx(truss_load(h, h + y[i])).margin((exact ? 1e-4 : 1e-2) * limit));
    REQUIRE(limits.size() == 2);
    CHECK(limits[0] == Approx(limit).epsilon(exact ? 1e-5 : 1e-2));
    CHECK(limits[1] == Approx(-limit).epsilon(exact ? 1e-5 : 1e-2));
    CHECK(path.series.t.back() == 2 * limit);
    CHECK(path.summary["path"]["at_end"] == true);
  }
}

// Sabir and Lock 1972; limit load by Sze, Liu and Lo 2004 (shells with shear): 2.21 kN.
TEST_CASE("path: the hinged cylindrical roof, thickness 12.7") {
  const Roof roof{{}, 8, 12.7};
  for (const Formulation formulation : {Formulation::cfr, Formulation::nlffr, Formulation::vm_md}) {
    INFO(scene::name_of(formulation));
    const bool reduced = formulation == Formulation::vm_md;
    const app::RunResult path = path_of(roof.text(), formulation, 1, 15, reduced ? 18 : 1000);
    const std::vector<double> limits = limits_of(path);
    REQUIRE(limits.size() == (reduced ? 1 : 2));
    CHECK(3000 * limits[0] == Approx(2210).epsilon(reduced ? 0.006 : 0.005));
    if (!reduced) CHECK(path.series.t.back() == 1);
  }
}

// The same source: 0.583 kN. Order 2 in the length of the elements.
TEST_CASE("path: the hinged cylindrical roof, thickness 6.35: snap-back") {
  const auto follow = [](int n, int points) {
    return path_of(Roof{{}, n, 6.35}.text(), Formulation::cfr, 0.5, 30, points);
  };
  const app::RunResult coarse = follow(8, 1000);
  const std::vector<double> limits = limits_of(coarse), z = column(coarse, "crown.z");
  REQUIRE(limits.size() == 2);
  CHECK(limits[1] < -0.1);
  // The crown itself comes back on the way, and goes down again.
  bool rises = false;
  for (std::size_t i = 1; i < z.size(); ++i) rises = rises || z[i] > z[i - 1] + 0.1;
  CHECK(rises);
  const double fine = limits_of(follow(12, 22)).at(0);
  CHECK(3000 * (fine - (limits[0] - fine) * 64 / (144 - 64)) == Approx(583).epsilon(0.01));
  // Above the limit point there is one equilibrium: that to which load control snaps.
  const app::RunResult snapped = app::rest(scene::parse_scene(Roof{{}, 8, 6.35}.text(), "scene"), Formulation::cfr,
                                           PETSC_COMM_WORLD, {0.5, 5}, std::nullopt, false);
  CHECK(z.back() == Approx(column(snapped, "crown.z").back()).epsilon(1e-6));
}

// Beam of length 1, EI = 1, under an axial force: Euler's load.
TEST_CASE("path: a bifurcation is reported with its location") {
  const app::RunResult path = path_of(strut(""), Formulation::cfr, 3, 30);
  const auto& bifurcations = path.summary["path"]["bifurcations"];
  REQUIRE(bifurcations.size() == 1);
  CHECK(bifurcations[0]["from"].get<double>() < M_PI * M_PI / 4);
  CHECK(bifurcations[0]["to"].get<double>() > M_PI * M_PI / 4);
  CHECK(limits_of(path).empty());
}

TEST_CASE("path: warnings name limit points, unstable points and bifurcations") {
  const auto warned = [](const app::RunResult& result, const std::string& words) {
    return std::any_of(result.warnings.begin(), result.warnings.end(),
                       [&](const std::string& one) { return one.find(words) != std::string::npos; });
  };
  const app::RunResult snap = path_of(truss(0.3), Formulation::cfr, 20, 20);
  const auto& counts = snap.summary["path"]["unstable_directions"];
  const auto unstable =
      std::count_if(counts.begin(), counts.end(), [](const auto& one) { return one.is_number() && one > 0; });
  REQUIRE(unstable > 0);
  CHECK(warned(snap, fmt::format("limit points at t = {:.6g} (apex.y = ", limits_of(snap).at(0))));
  CHECK(warned(snap, fmt::format("{} of the {} points of the path are unstable", unstable, counts.size())));
  CHECK_FALSE(warned(snap, "stability is not determined"));
  CHECK(warned(path_of(strut(""), Formulation::cfr, 3, 30), "the path passes a bifurcation between t = "));
  // A follower force: the tangent is not symmetric.
  const app::RunResult follower = path_of(strut(", axes: place"), Formulation::cfr, 3, 5);
  CHECK(warned(follower, "stability is not determined at "));
  CHECK_FALSE(warned(follower, "unstable equilibria"));
}

// Near t = 0 the load is constant: dF/dt gives no scale.
TEST_CASE("path: loads and drives that begin smoothly") {
  const double h = 0.3;
  const app::RunResult ramp = path_of(truss(h, "-8*smooth(t, 0, 1)"), Formulation::cfr, 1, 20);
  const std::vector<double> y = column(ramp, "apex.y");
  REQUIRE(ramp.summary["path"]["at_end"] == true);
  CHECK(y.size() < 60);
  CHECK(truss_load(h, h + y.back()) == Approx(8).epsilon(1e-5));
  CHECK(limits_of(ramp).empty());

  const app::RunResult cube = path_of(truss(h, "-100*t^3 - 1e-4*t"), Formulation::cfr, 1, 20);
  const std::vector<double> limits = limits_of(cube);
  REQUIRE(limits.size() == 2);
  for (const double t : limits) CHECK(std::abs(100 * t * t * t + 1e-4 * t) == Approx(truss_limit(h)).epsilon(1e-5));

  const app::RunResult arm = path_of(R"yaml(
bodies: {arm: {mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}, section: {EA: 1e4, EI: 10, rhoA: 1}}}
joints: {motor: {type: driven, between: [ground, arm.start], angle: "0.9*smooth(t, 0, 1)"}}
probes: {tip: {at: arm.end, quantity: position}}
)yaml",
                                     Formulation::cfr, 1, 10);
  REQUIRE(arm.summary["path"]["at_end"] == true);
  CHECK(column(arm, "tip.y").back() == Approx(std::sin(0.9)).epsilon(1e-9));
}

// Limit load 9.53: the first step leads beyond the far branch at the same t.
TEST_CASE("path: first steps longer than the way to the limit point") {
  const double h = 0.3;
  for (const double at : {100., 1000., 1e6}) {
    INFO(at);
    const app::RunResult path = path_of(truss(h), Formulation::cfr, at, 10);
    const std::vector<double> limits = limits_of(path);
    REQUIRE(limits.size() == 2);
    CHECK(limits[0] == Approx(truss_limit(h)).epsilon(1e-5));
    CHECK(limits[1] == Approx(-truss_limit(h)).epsilon(1e-5));
  }
}

// There is no equilibrium at t = 0: the path begins at the first increment, which is the end.
TEST_CASE("path: one step of a mechanism that only its load makes stable") {
  const app::RunResult path = path_of(R"yaml(
bodies: {arm: {mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}, section: {EA: 1e4, EI: 10, rhoA: 1}}}
joints: {pin: {type: revolute, between: [ground, arm.start]}}
loads: {pull: {type: force, at: arm.end, force: [0, -t]}}
probes: {tip: {at: arm.end, quantity: position}}
)yaml",
                                      Formulation::cfr, 1, 1);
  CHECK(path.series.t == std::vector<double>{1});
  CHECK(path.summary["path"]["at_end"] == true);
  CHECK(column(path, "tip.y").back() == Approx(-1.0001).epsilon(1e-6));
}

// Kink: no load until t = 0.1; begin with an infinite rate.
TEST_CASE("path: loads with a kink, or with an infinite rate at the start") {
  const double h = 0.3, limit = truss_limit(h);
  const std::vector<double> kink =
      limits_of(path_of(truss(h, "t < 0.1 ? 0 : -30*(t - 0.1)"), Formulation::cfr, 1, 20, 60));
  REQUIRE(!kink.empty());
  CHECK(30 * (kink[0] - 0.1) == Approx(limit).epsilon(1e-5));
  const app::RunResult root = path_of(truss(h, "-8*sqrt(t)"), Formulation::cfr, 1, 20);
  CHECK(root.summary["path"]["at_end"] == true);
  CHECK(truss_load(h, h + column(root, "apex.y").back()) == Approx(8).epsilon(1e-5));
}

// The origin of the frame stays where it is, and the load has the same limit at every half turn: attitudes distinguish
// these limit points. M = sin(2 angle) + t has limits where cos(2 angle) vanishes.
TEST_CASE("path: limit points of a body that rotates about a place are different ones") {
  const app::RunResult result = path_of(R"yaml(
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {A: 1e-3, Iy: 1e-8, Iz: 1e-8, J: 1e-8, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    frame: {type: pinned}
joints: {hinge: {type: revolute, between: [ground, rod.start], axis: [0, 0, 1]}}
loads: {twist: {type: moment, at: rod.start, moment: [0, 0, "t - sin(2*hinge.angle)"]}}
probes: {a: {joint: hinge, quantity: angle}}
)yaml",
                                        Formulation::nlffr, 2, 20, 100);
  const std::vector<double> angle = column(result, "a.value");
  CHECK(*std::max_element(angle.begin(), angle.end()) > 3 * M_PI / 2);
  for (const std::string& warning : result.warnings) CHECK_THAT(warning, !Catch::Contains("closed"));
}
