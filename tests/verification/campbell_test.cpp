#include "../../src/app/campbell.h"

#include <catch2/catch.hpp>
#include <map>

#include "eigenvalues.h"
#include "shell_decks.h"

using namespace floe;
using namespace floe::test;

namespace {

app::CampbellDiagram diagram(const std::string& text, Formulation formulation, const std::string& speeds, int modes = 6,
                             const app::CampbellRequest& axis = {}) {
  app::CampbellRequest request = axis;
  request.speeds = speeds, request.modes = modes;
  std::exception_ptr fault;
  app::CampbellDiagram found =
      app::campbell(scene::parse_scene(text, "scene"), formulation, PETSC_COMM_WORLD, request, fault);
  if (fault) std::rethrow_exception(fault);
  return found;
}

std::vector<double> omega(const app::CampbellPoint& point) {
  REQUIRE(point.fault == "");
  std::vector<double> all;
  for (const auto& vibration : point.vibrations) {
    CHECK(vibration.growth == 0);
    all.push_back(vibration.omega);
  }
  return all;
}

/// Flap frequencies of a clamped beam, hub radius 0, no rotary inertia, by independent converged computation.
struct Flap {
  double gamma, omega[3];
};
const Flap flaps[] = {{2, {4.1373196, 22.6149220, 62.2731841}},
                      {6, {7.3603730, 26.8090817, 66.6839144}},
                      {12, {13.1701505, 37.6031123, 79.6144785}}};
double lag(const Flap& flap, int i) { return std::sqrt(std::pow(flap.omega[i], 2) - std::pow(flap.gamma, 2)); }

/// L = EI = rhoA = 1, driven at its root.
std::string planar(const std::string& frame, const std::string& joint, const std::string& elements,
                   const std::string& EA = "1e8") {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [3, 2], to: [4, 2], elements: $elements}}
    section: {EA: $EA, EI: 1, rhoA: 1}
    frame: $frame
    reduction: {modes: 8, derivatives: all}
joints: {root: {$joint, between: [ground, beam.start]}}
probes: {tip: {at: beam.end, quantity: deflection}}
)yaml",
              {{"EA", EA}, {"frame", frame}, {"joint", joint}, {"elements", elements}});
}
const std::string driven = "type: driven, angle: \"2*t\"";

/// The same in space along x, as stiff in both directions, rotating about z.
std::string spatial(const std::string& elements, const std::string& joint) {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 1], to: [1, 0, 1], elements: $elements}}
    section: {A: 1, Iy: 1e-8, Iz: 1e-8, J: 2e-8, orientation: [0, 1, 0]}
    material: {E: 1e8, G: 4e7, rho: 1}
    reduction: {modes: 12, derivatives: all}
joints: {root: {$joint, between: [ground, beam.start]}}
)yaml",
              {{"elements", elements}, {"joint", joint}});
}

/// A rigid rod of length 1 on a driven rigid hub, hinged at the distance e from the axis.
std::string hinged_rod(double e, const std::string& hinge, const std::string& rigid = "true") {
  return fill(R"yaml(
bodies:
  hub:
    mesh: {line: {from: [0, 0, -1], to: [$e, 0, 0], elements: 1}}
    section: {A: 1, Iy: 1e-3, Iz: 1e-3, J: 2e-3, orientation: [0, 1, 0]}
    material: {E: 1e8, G: 4e7, rho: 1}
    rigid: true
  rod:
    mesh: {line: {from: [$e, 0, 0], to: [$tip, 0, 0], elements: 40}}
    section: {A: 1, Iy: 1e-8, Iz: 1e-8, J: 2e-8, orientation: [0, 1, 0]}
    material: {E: 1e8, G: 4e7, rho: 1}
    rigid: $rigid
joints:
  hub: {type: driven, between: [ground, hub.start], axis: [0, 0, 1], angle: "t"}
  hinge: {type: revolute, between: [hub.end, rod.start], axis: $hinge}
)yaml",
              {{"e", number(e)}, {"tip", number(1 + e)}, {"hinge", hinge}, {"rigid", rigid}});
}

/// A square plate of side and bending stiffness 1, mass 1 per area, driven at its left edge.
std::string plate(const std::string& elements, const std::string& modes) {
  const double h = 1e-3, E = 12 * (1 - 0.09) / (h * h * h), rho = 1 / h;
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {origin: [0, -0.5, 0], along: [1, 0, 0], across: [0, 1, 0], elements: [$n, $n], cells: $cells}}
    section: {thickness: 1e-3}
    material: {E: $E, nu: 0.3, rho: $rho}
    frame: {type: clamped, at: left}
    reduction: {modes: $modes, derivatives: all}
joints: {root: {type: driven, between: [ground, plate.left], axis: [0, 0, 1], angle: "t"}}
)yaml",
              {{"n", elements}, {"cells", "quadrilaterals"}, {"E", number(E)}, {"rho", number(rho)}, {"modes", modes}});
}

}  // namespace

// Coriolis forces couple lag to stretch and change omega by a part of the order (gamma r/L)^2, 1e-6 here at most. The
// tension acts on the mean slope of an element: error O(h^2), removed by extrapolation from two meshes.
TEST_CASE("campbell: a driven planar beam lags at sqrt(flap^2 - gamma^2)") {
  for (const std::string frame : {"pinned", "clamped"}) {
    const auto coarse = diagram(planar(frame, driven, "12"), Formulation::nlffr, "2,6,12", 3),
               fine = diagram(planar(frame, driven, "24"), Formulation::nlffr, "2,6,12", 3),
               reduced = diagram(planar(frame, driven, "24"), Formulation::vm_md, "2,6,12", 3);
    for (int s = 0; s < 3; ++s) {
      INFO(frame << " at gamma = " << flaps[s].gamma);
      const auto a = omega(coarse.points.at(s)), b = omega(fine.points.at(s)), r = omega(reduced.points.at(s));
      for (int i = 0; i < 3; ++i) {
        CHECK((4 * b.at(i) - a.at(i)) / 3 == Approx(lag(flaps[s], i)).epsilon(5e-5));
        CHECK(r.at(i) == Approx(b.at(i)).epsilon(2e-3));
      }
    }
  }
}

TEST_CASE("campbell: flap and lag frequencies of a driven beam in space") {
  const std::string drive = "type: driven, axis: [0, 0, 1], angle: \"t\"";
  const auto coarse = diagram(spatial("12", drive), Formulation::nlffr, "2:12:2", 6),
             fine = diagram(spatial("24", drive), Formulation::nlffr, "2,6,12", 6),
             reduced = diagram(spatial("24", drive), Formulation::vm_md, "2,6,12", 6);
  for (int s = 0; s < 3; ++s) {
    INFO("gamma = " << flaps[s].gamma);
    const auto a = omega(coarse.points.at(s == 0   ? 0
                                          : s == 1 ? 2
                                                   : 5)),
               b = omega(fine.points.at(s)), r = omega(reduced.points.at(s));
    for (int i = 0; i < 3; ++i) {
      CHECK((4 * b.at(2 * i) - a.at(2 * i)) / 3 == Approx(lag(flaps[s], i)).epsilon(5e-5));
      CHECK((4 * b.at(2 * i + 1) - a.at(2 * i + 1)) / 3 == Approx(flaps[s].omega[i]).epsilon(5e-5));
      CHECK(r.at(2 * i) == Approx(b.at(2 * i)).epsilon(2e-3));
      CHECK(r.at(2 * i + 1) == Approx(b.at(2 * i + 1)).epsilon(2e-3));
    }
  }
}

// EI = 1 out of the plane, 4 in it, where omega(gamma; 4) = 2 omega(gamma/2; 1): lag is above flap at rest and below it
// at gamma = 12, so that lines cross (both of first order) as the second ones of flap and third ones of lag do not.
TEST_CASE("campbell: vibrations are followed by shape through a crossing of flap and lag") {
  const std::string beam = fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 1], to: [1, 0, 1], elements: 24}}
    section: {A: 1, Iy: 1e-8, Iz: 4e-8, J: 5e-8, orientation: [0, 1, 0]}
    material: {E: 1e8, G: 4e7, rho: 1}
    reduction: {modes: 12, derivatives: all}
joints: {root: {type: driven, axis: [0, 0, 1], angle: "t", between: [ground, beam.start]}}
)yaml",
                                {});
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const auto found = diagram(beam, formulation, "0:12:2", 3);
    std::map<int, std::vector<double>> tracks;
    for (const auto& point : found.points) {
      omega(point);
      for (const auto& one : point.vibrations) tracks[one.track].push_back(one.omega);
    }
    REQUIRE(tracks.size() >= 2);
    const double lag_at_12 = std::sqrt(std::pow(2 * flaps[1].omega[0], 2) - std::pow(12, 2));
    CHECK(tracks[1].front() == Approx(3.5160152685).epsilon(3e-3));
    CHECK(tracks[2].front() == Approx(2 * 3.5160152685).epsilon(3e-3));
    REQUIRE(tracks[1].size() == 7);
    REQUIRE(tracks[2].size() == 7);
    CHECK(tracks[1].back() == Approx(flaps[2].omega[0]).epsilon(3e-3));
    CHECK(tracks[2].back() == Approx(lag_at_12).epsilon(3e-3));
    for (const auto& one : found.points.back().vibrations) CHECK(one.assurance > 0.5);
  }
}

// Two bending modes of a slender beam and their derivatives leave errors of frequencies, which the full-order model of
// the same mesh shows.
TEST_CASE("campbell: errors of reduced frequencies are estimated") {
  std::string scene = planar("pinned", driven, "24");
  scene.replace(scene.find("modes: 8"), 8, "modes: 3");
  const auto reduced = diagram(scene, Formulation::vm_md, "4,12", 3),
             full = diagram(scene, Formulation::nlffr, "12", 3);
  REQUIRE(reduced.estimate.missing == "");
  CHECK(reduced.estimate.speed == 12);
  REQUIRE(reduced.estimate.errors.size() == 3);
  const auto approximate = omega(reduced.points.back()), exact = omega(full.points.back());
  for (std::size_t i = 0; i < 3; ++i) {
    const double error = std::abs(approximate[i] - exact[i]) / exact[i];
    INFO("true " << error << ", estimated " << reduced.estimate.errors[i].relative);
    if (error > 1e-5) {
      CHECK(reduced.estimate.errors[i].relative > 0.3 * error);
      CHECK(reduced.estimate.errors[i].relative < 3 * error);
    }
  }
  CHECK(std::abs(approximate[2] - exact[2]) > 1e-5 * exact[2]);
  CHECK(full.estimate.errors.empty());
}

// A rod that is hinged at the distance e: flap^2 = gamma^2 (1 + 3e/2), lag^2 = gamma^2 3e/2 (moments about the hinge);
// e = 0: flap omega_1 = gamma exactly, for elastic beams too. Blades fold outwards as the hub begins to rotate.
TEST_CASE("campbell: frequencies of hinged rods are proportional to the speed") {
  for (const double e : {0., 0.1}) {
    for (const bool flap : {true, false}) {
      INFO("e = " << e << (flap ? ", flap" : ", lag"));
      const auto found = diagram(hinged_rod(e, flap ? "[0, 1, 0]" : "[0, 0, 1]"), Formulation::nlffr, "0,5,100", 1);
      CHECK(found.points.at(0).vibrations.at(0).zero);
      for (int s = 1; s < 3; ++s) {
        const auto& at = found.points.at(s);
        const double ratio = std::sqrt((flap ? 1 : 0) + 1.5 * e);
        if (ratio > 0.01)
          CHECK(omega(at).at(0) == Approx(ratio * at.speed).epsilon(1e-7));
        else
          CHECK(at.vibrations.at(0).omega < 1e-3 * at.speed);
      }
    }
  }
}

TEST_CASE("campbell: an elastic beam that is hinged at the axis flaps at the speed of rotation") {
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const auto found = diagram(hinged_rod(0, "[0, 1, 0]", "false"), formulation, "2,12", 4);
    for (const auto& point : found.points) {
      const auto all = omega(point);
      CHECK(std::any_of(all.begin(), all.end(), [&](double one) { return one == Approx(point.speed).epsilon(1e-5); }));
    }
  }
}

// Hinged at the axis the first flap is gamma (above), so the first lag is neutral: the beam rotates on.
TEST_CASE("campbell: a beam on a free hub has a zero mode, and rotates as one that is driven") {
  for (const bool space : {false, true}) {
    const auto found =
        diagram(space ? spatial("16", "type: revolute, axis: [0, 0, 1]") : planar("pinned", "type: revolute", "16"),
                Formulation::vm_md, "0,2,6", 4);
    for (const auto& point : found.points) {
      INFO((space ? "space" : "plane") << " at " << point.speed << ": " << point.fault);
      REQUIRE(point.vibrations.size() == 4);
      CHECK(point.vibrations[0].zero);
      CHECK_FALSE(point.vibrations[1].zero);
    }
    if (!space) {
      CHECK(found.axis.point.isApprox(Eigen::Vector3d(3, 2, 0)));
      // free-hinged beam at rest: (4k+1)^2 pi^2/16 approximately; exactly tan = tanh
      CHECK(found.points[0].vibrations[1].omega == Approx(15.418206).epsilon(1e-4));
    }
  }
}

// Linear elastic forces in the clamped frame: lag^2 = beta_1^4 - gamma^2 is negative beyond gamma = 3.516015, and the
// motion grows at sqrt(gamma^2 - beta_1^4).
TEST_CASE("campbell: linear elastic forces grow beyond gamma = 3.516, von Karman's do not") {
  for (const Formulation formulation : {Formulation::lffr, Formulation::nlffr, Formulation::vm_md}) {
    const auto found = diagram(planar("clamped", driven, "16"), formulation, "3.49,3.54,4,6", 2);
    for (const auto& point : found.points) {
      INFO(scene::name_of(formulation) << " at " << point.speed << ": " << point.fault);
      REQUIRE(point.vibrations.size() == 2);
      if (formulation == Formulation::lffr && point.speed > 3.5) {
        CHECK(point.vibrations[0].unstable());
        CHECK(point.vibrations[0].growth ==
              Approx(std::sqrt(std::pow(point.speed, 2) - std::pow(3.5160152685, 2))).epsilon(1e-2));
      } else {
        CHECK_FALSE(point.vibrations[0].unstable());
      }
    }
  }
}

// Both planes of a clamped shaft without rotary inertia have the shapes of the standing beam: each mode is a Jeffcott
// rotor with s^4 + s^2 (a + b + 4 W^2) + a b = 0, a = w_y^2 - W^2, b = w_z^2 - W^2, which grows for w_y < W < w_z.
TEST_CASE("campbell: a shaft of unequal stiffness grows between its critical speeds") {
  const double beta = 3.5160152685, at = 0.4;
  for (const double ratio : {1.1, 1.5, 3.}) {
    const double W = beta * (1 + at * (std::sqrt(ratio) - 1));
    const double a = beta * beta - W * W, b = ratio * beta * beta - W * W, p = a + b + 4 * W * W,
                 root = std::sqrt(p * p - 4 * a * b);
    const std::string shaft = fill(R"yaml(
bodies:
  shaft:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 16}}
    section: {A: 1, Iy: 1e-8, Iz: $Iz, J: 2e-8, orientation: [0, 1, 0]}
    material: {E: 1e8, G: 4e7, rho: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: 6, derivatives: all}
joints: {root: {type: driven, between: [ground, shaft.start], axis: [1, 0, 0], angle: "t"}}
)yaml",
                                   {{"Iz", number(1e-8 * ratio)}});
    for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
      INFO("ratio " << ratio << ", " << scene::name_of(formulation));
      const auto found = diagram(shaft, formulation, number(W) + "," + number(0.9 * beta), 3);
      REQUIRE(found.points.at(0).fault == "");
      const auto& vibrations = found.points.at(0).vibrations;
      REQUIRE(vibrations.size() == 3);
      CHECK(vibrations[0].omega == 0);
      CHECK(vibrations[0].growth == Approx(std::sqrt(-2 * a * b / (p + root))).epsilon(2e-5));
      CHECK(vibrations[1].omega == Approx(std::sqrt((p + root) / 2)).epsilon(1e-5));
      CHECK(vibrations[1].growth == 0);
      CHECK(vibrations[2].growth == 0);
      CHECK(omega(found.points.at(1)).size() == 3);
    }
  }
}

// The propeller moment, (rho Iz - rho Iy) Omega^2 phi: omega^2 = omega_t^2 +- Omega^2 (Iz - Iy)/(Iz + Iy), + for the
// chord in the plane of rotation. omega_t = pi/2 sqrt(GJ/rho (Iy + Iz)) = 10 for a root that is constrained.
TEST_CASE("campbell: the propeller moment in the torsion of a flat blade") {
  const auto blade = [](const std::string& chord) {
    return fill(R"yaml(
bodies:
  blade:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 20}}
    section: {A: 1, Iy: 1e-6, Iz: 0.01, J: 0.4052847e-2, orientation: $chord}
    material: {E: 1e8, G: 100, rho: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: 6, derivatives: all}
joints: {root: {type: driven, between: [ground, blade.start], axis: [0, 0, 1], angle: "t"}}
)yaml",
                {{"chord", chord}});
  };
  const double share = (0.01 - 1e-6) / (0.01 + 1e-6);
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const auto flat = diagram(blade("[0, 1, 0]"), formulation, "0,5,10", 3),
               upright = diagram(blade("[0, 0, 1]"), formulation, "0,8", 3);
    for (const auto& point : flat.points) {
      INFO(scene::name_of(formulation) << ", chord in the plane, " << point.speed);
      const double torsion = std::sqrt(100 + point.speed * point.speed * share);
      CHECK(omega(point).at(0) == Approx(torsion).epsilon(5e-4));
    }
    for (const auto& point : upright.points) {
      INFO(scene::name_of(formulation) << ", chord along the axis, " << point.speed);
      const double torsion = std::sqrt(100 - point.speed * point.speed * share);
      CHECK(omega(point).at(0) == Approx(torsion).epsilon(1e-3));
    }
  }
}

// Rayleigh's shaft, clamped and free, r = rhoI/(rhoA L^2) = 0.01: seen from axes that rotate with it whirl has
//   omega^2 (A + r S) + 2 Omega omega A + Omega^2 (A - r S) - K = 0,   A = int w^2, S = int w'^2, K = int w''^2,
// both directions of whirl by the sign of omega; Galerkin's method with w = x^k, k = 2..8. Gyroscopic moments and the
// moment of inertia about the axis, which falls as sections tilt, are in it.
TEST_CASE("campbell: a thick shaft whirls as Rayleigh's does") {
  constexpr int n = 7;
  const double r = 0.01, W = 2;
  Eigen::MatrixXd A(n, n), S(n, n), K(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double a = i + 2, b = j + 2;
      A(i, j) = 1 / (a + b + 1), S(i, j) = a * b / (a + b - 1), K(i, j) = a * (a - 1) * b * (b - 1) / (a + b - 3);
    }
  Eigen::MatrixXd left = Eigen::MatrixXd::Zero(2 * n, 2 * n), right = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  left.topRightCorner(n, n).setIdentity();
  left.bottomLeftCorner(n, n) = K - W * W * (A - r * S);
  left.bottomRightCorner(n, n) = -2 * W * A;
  right.bottomRightCorner(n, n) = A + r * S;
  const Eigen::VectorXcd exponents = testing::complex_eigenvalues(left, right);
  std::vector<double> whirl;
  for (const auto& each : exponents) whirl.push_back(std::abs(each.real()));
  std::sort(whirl.begin(), whirl.end());
  const std::string shaft = R"yaml(
bodies:
  shaft:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 16}}
    section: {A: 1, Iy: 0.01, Iz: 0.01, J: 1, orientation: [0, 1, 0]}
    material: {E: 100, G: 1e4, rho: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: 12, derivatives: all}
joints: {root: {type: driven, between: [ground, shaft.start], axis: [1, 0, 0], angle: "t"}}
)yaml";
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const auto found = omega(diagram(shaft, formulation, number(W), 2).points.at(0));
    for (int i = 0; i < 2; ++i) {
      INFO(scene::name_of(formulation) << ", whirl " << i + 1);
      CHECK(found.at(i) == Approx(whirl.at(i)).epsilon(1e-3));
    }
  }
}

// omega a^2 sqrt(rho h / D), nu = 0.3, the plate in the plane of rotation: independent converged computation. The error
// of the mesh is of order 2.
TEST_CASE("campbell: a rotating square plate") {
  const double exact[3][3] = {{3.6393, 8.6267, 21.429}, {4.7677, 9.5316, 22.544}, {11.1945, 16.6312, 31.956}};
  const auto coarse = diagram(plate("6", "6"), Formulation::nlffr, "1,3,10", 3),
             fine = diagram(plate("12", "6"), Formulation::nlffr, "1,3,10", 3),
             reduced = diagram(plate("12", "10"), Formulation::vm_md, "1,3,10", 3);
  for (int s = 0; s < 3; ++s) {
    INFO("gamma = " << fine.points[s].speed);
    const auto a = omega(coarse.points[s]), b = omega(fine.points[s]), r = omega(reduced.points[s]);
    for (int i = 0; i < 3; ++i) {
      CHECK((4 * b.at(i) - a.at(i)) / 3 == Approx(exact[s][i]).epsilon(1e-3));
      CHECK(r.at(i) == Approx(b.at(i)).epsilon(4e-3));
    }
  }
}

// EA u'' + rhoA Omega^2 (x + u) = 0: u(L) = sin(kL)/(k cos kL) - L, k = Omega sqrt(rhoA/EA).
TEST_CASE("campbell: the steady stretch has its closed form") {
  for (const double k : {0.1, 0.5}) {
    const auto found = diagram(planar("clamped", driven, "40", "1e4"), Formulation::nlffr, number(100 * k), 1);
    REQUIRE(found.points.at(0).fault == "");
    const auto values = assembly::probe_values(found.model, 0, found.model.U, found.model.V);
    CHECK(values.at(0) == Approx(std::sin(k) / (k * std::cos(k)) - 1).epsilon(5e-4));
    CHECK(std::abs(values.at(1)) < 1e-9);
  }
}

TEST_CASE("campbell: at rest the frequencies are those of the supported body") {
  for (const std::string& text : {planar("pinned", driven, "16"),
                                  spatial("16", "type: driven, axis: [0, 0, 1], angle: \"t\""), plate("8", "5")}) {
    const auto at = omega(diagram(text, Formulation::vm_md, "0", 4).points.at(0));
    const auto modes = omega_of(text);
    for (int i = 0; i < 4; ++i) CHECK(at.at(i) == Approx(modes.at(i)).epsilon(1e-8));
  }
}

// Above its critical speed a shaft with an unbalance e = 1 mm has two steady rotations: the one of the linear theory,
// (K - Omega^2 M) q = m e Omega^2, and one that hardens to 0.3 m, which cfr follows from rest.
TEST_CASE("campbell: the steady rotation of another branch in cfr is reported, not compared") {
  const auto found = diagram(R"yaml(
bodies:
  a:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 8}}
    section: {shape: circle, radius: 0.01, orientation: [0, 1, 0]}
    material: {E: 2.1e11, nu: 0.3, rho: 7800}
    reduction: {modes: 6, derivatives: all}
  d: {rigid: {mass: 5, centre: [0.5, 0.001, 0], inertia: [1e-3, 6e-4, 6e-4]}}
joints:
  l: {type: driven, between: [ground, a.start], axis: [1, 0, 0], angle: "300*t"}
  e: {type: cylindrical, between: [ground, a.end], axis: [1, 0, 0]}
  w: {type: fixed, between: [a.middle, {body: d, node: [0.5, 0, 0]}]}
motion: {end: 0.2, step: 5e-4}
)yaml",
                             Formulation::vm_md, "300", 2);
  const auto& warnings = found.model.warnings;
  const auto reported = [&](const std::string& text) {
    return std::any_of(warnings.begin(), warnings.end(),
                       [&](const std::string& line) { return line.find(text) != std::string::npos; });
  };
  CHECK(reported("(cfr) on the same mesh is another one"));
  CHECK_FALSE(reported("frequency 1 is"));
}

// Without vectors that stretch the blade it has no centrifugal stiffness: the same state, and other frequencies.
TEST_CASE("campbell: a basis without axial stretch is reported by its frequencies") {
  const auto found = diagram(R"yaml(
bodies:
  a:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 6}}
    section: {shape: rectangle, width: 0.03, height: 0.01, orientation: [0, 1, 0]}
    material: {E: 2.1e11, nu: 0.3, rho: 7800}
    reduction: {modes: 4, derivatives: none}
joints: {l: {type: driven, between: [ground, a.start], axis: [0, 0, 1], angle: "300*t"}}
motion: {end: 0.2, step: 5e-4}
)yaml",
                             Formulation::vm_md, "300", 2);
  const auto& warnings = found.model.warnings;
  CHECK(std::any_of(warnings.begin(), warnings.end(),
                    [&](const std::string& line) { return line.find("frequency 1 is") != std::string::npos; }));
}

// Nothing holds the second plate's rotation on the hinge: the tangent is singular, and nothing acts.
TEST_CASE("campbell: two hinged plates at rest, in full-order models, too") {
  const auto text = [](const Eigen::Vector3d& rotation) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(rotation.norm(), rotation.stableNormalized()).toRotationMatrix();
    const auto vector = [](const Eigen::Vector3d& v) {
      return "[" + number(v[0]) + ", " + number(v[1]) + ", " + number(v[2]) + "]";
    };
    return fill(R"yaml(
bodies:
  a:
    mesh: {plate: {along: [0.6, 0, 0], across: [0, 0.4, 0], elements: [6, 4], cells: quadrilaterals}}
    section: {thickness: 0.004}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 6, derivatives: none, attachment: all}
    initial: {rotation: $rotation}
  b: {like: a, initial: {rotation: $rotation, position: $position}}
joints:
  w: {type: revolute, between: [a.right, b.left], axis: $hinge}
  r: {type: driven, between: [ground, a.left], axis: $axis, angle: "0"}
motion: {end: 1, step: 1e-3}
)yaml",
                {{"rotation", vector(rotation)},
                 {"position", vector(0.6 * R.col(0))},
                 {"hinge", vector(R.col(1))},
                 {"axis", vector(R.col(0))}});
  };
  const auto exact = omega(diagram(text({0, 0, 0}), Formulation::cfr, "0", 3).points.at(0));
  for (const Eigen::Vector3d& rotation :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.3, 0.2, 0.7), Eigen::Vector3d(-1.1, 0.4, 2.0)})
    for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
      INFO(name_of(formulation) << " " << rotation.transpose());
      const auto found = omega(diagram(text(rotation), formulation, "0", 3).points.at(0));
      CHECK(found.at(0) < 1e-3 * exact.at(1));
      for (int i : {1, 2}) CHECK(found.at(i) == Approx(exact.at(i)).epsilon(0.01));
    }
}

// A disk (m, J about its axis, J/2 across) on a massless cantilever: bending by the flexibility [L^3/3, L^2/2; L^2/2,
// L] / EI of its end. The shaft weighs 1.6e-7 of 5 kg, and its own frequencies are up to 1e7 times higher: round-off of
// its stiffness, eps (omega_max / omega_1)^2, must not reach the first.
TEST_CASE("campbell: a disk on a shaft of almost no mass has the frequencies of a massless shaft") {
  const double L = 0.5, E = 2.1e11, nu = 0.3, I = M_PI * 1e-8 / 4, m = 5, J = 0.05;
  Eigen::Matrix2d flexibility;
  flexibility << L * L * L / 3, L * L / 2, L * L / 2, L;
  const Eigen::VectorXd slowness =
      testing::eigenvalues(flexibility, Eigen::Vector2d(E * I / m, 2 * E * I / J).asDiagonal().toDenseMatrix());
  const double torsion = std::sqrt(E / (1 + nu) * I / (L * J)), first = 1 / std::sqrt(slowness.maxCoeff()),
               second = 1 / std::sqrt(slowness.minCoeff());
  for (const char* modes : {"6", "10"}) {
    const auto found = omega(diagram(fill(R"yaml(
bodies:
  shaft:
    mesh: {line: {from: [0, 0, 0], to: [0.5, 0, 0], elements: 10}}
    section: {shape: circle, radius: 0.01, orientation: [0, 0.7073882691671999, 0.706825181105366]}
    material: {E: 2.1e11, nu: 0.3, rho: 0.001}
    masses: {disk: {at: end, mass: 5, inertia: [0.05, 0.025, 0.025]}}
    reduction: {modes: $modes}
joints: {root: {type: driven, between: [ground, shaft.start], axis: [1, 0, 0], speed: 100}}
)yaml",
                                          {{"modes", modes}}),
                                     Formulation::vm_md, "0", 5)
                                 .points.at(0));
    const double expected[] = {first, first, torsion, second, second};
    for (int i = 0; i < 5; ++i) CHECK(found.at(i) == Approx(expected[i]).epsilon(1e-6));
  }
}

TEST_CASE("campbell: scenes without a steady rotation are refused with the reason") {
  using Catch::Matchers::Contains;
  const auto fault = [](const std::string& text, const app::CampbellRequest& axis = {}) -> std::string {
    try {
      diagram(text, Formulation::vm_md, "1", 1, axis);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string drive = "type: driven, axis: [0, 0, 1], angle: \"t\"";
  CHECK_THAT(fault(planar("pinned", "type: fixed", "4")), Contains("--through"));
  CHECK_THAT(fault(planar("pinned", "type: fixed", "4"), {"", {}, "3,2"}), Contains("joint root does not rotate"));
  CHECK_THAT(fault(planar("pinned", driven, "4"), {"", {}, "3,2.5"}), Contains("joint root does not rotate"));
  CHECK_THAT(fault(spatial("4", drive), {"", "1,0,0", {}}), Contains("joint root does not rotate"));
  CHECK_THAT(fault(spatial("4", drive), {"", "0,0,1", "0,0.1,0"}), Contains("joint root does not rotate"));
  CHECK(fault(spatial("4", drive), {"", "0,0,1", "0,0,7"}) == "");
  CHECK_THAT(fault(spatial("4", "type: fixed"), {"", "0,0,1", {}}), Contains("joint root does not rotate"));
  std::string still = spatial("4", "type: fixed");
  still.replace(still.find("    reduction"), 0, "    frame: {type: clamped, at: start}\n");
  CHECK_THAT(fault(still, {"", "0,0,1", {}}), Contains("clamped to the ground"));
  CHECK_THAT(fault(planar("pinned", driven, "4") + "gravity: [0, -9.81]\n"), Contains("gravity"));
  CHECK(fault(spatial("4", drive) + "gravity: [0, 0, -9.81]\n") == "");
  CHECK_THAT(fault(spatial("4", drive) + "gravity: [0, -9.81, 0]\n"), Contains("gravity"));
}

TEST_CASE("campbell: with a moment on a free hub there is no steady rotation") {
  const auto found = diagram(planar("pinned", "type: revolute", "4") +
                                 "loads: {motor: {type: moment, at: beam.end, "
                                 "moment: 0.01}}\n",
                             Formulation::vm_md, "1", 1);
  CHECK_THAT(found.points.at(0).fault, Catch::Matchers::Contains("accelerates the rotation"));
}

TEST_CASE("campbell: speeds as a list or a range") {
  CHECK(app::parse_speeds("0,2.5,-1") == std::vector<double>{0, 2.5, -1});
  CHECK(app::parse_speeds("0:0.3:0.1").size() == 4);
  CHECK(app::parse_speeds("4:0:-2") == std::vector<double>{4, 2, 0});
  for (const char* wrong : {"", "a", "1,,2", "0:1", "0:1:0", "0:1:-1", "0:1:1e-9", "1:2:nan"})
    CHECK_THROWS_AS(app::parse_speeds(wrong), InputError);
}

// More than 150 coordinates and six free motions: an iteration that looks for vibrations about zero breaks down.
TEST_CASE("campbell: a free plate of many coordinates at rest has the frequencies of its modes") {
  const std::string text = R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [6, 5], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 12*0.91*1e6, nu: 0.3, rho: 100}
    reduction: {modes: 6}
)yaml";
  app::CampbellRequest axis;
  axis.about = "0,0,1", axis.through = "0.5,0.5,0";
  const auto found = omega(diagram(text, Formulation::nlffr, "0", 12, axis).points.at(0));
  const std::vector<double> modes = omega_of(text);
  REQUIRE(found.size() == 12);
  for (int i = 0; i < 6; ++i) {
    CHECK(found[i] == 0);
    CHECK(found[6 + i] == Approx(modes[i]).epsilon(1e-6));
  }
}

// A thin ring about its axis, supported by the mean of all its nodes: in-plane bending with n waves, inextensional
// (Bryan 1890), w = +- 2 n/(n^2 + 1) Omega + sqrt(w_0^2 + (n (n^2 - 1)/(n^2 + 1) Omega)^2), w_0^2 = n^2 (n^2 -
// 1)^2/(n^2 + 1) EI/(rho A R^4). The axes of the mean have no mass: their stiffness, round-off, must not scale them.
TEST_CASE("campbell: a rotating ring of shells, supported by its mean") {
  const double R = 0.5, t = 0.01, E = 7e10, rho = 2700;
  const auto at = [&](double x, double y) {
    return Eigen::Vector3d(R * std::cos(2 * M_PI * y), R * std::sin(2 * M_PI * y), 0.02 * (x - 0.5));
  };
  std::string text = shells("S4", 1, 32, t, fmt::format("*ELASTIC\n{}, 0\n*DENSITY\n{}\n", E, rho), at, true);
  text += "*NSET, NSET=ring\nleft, right\n";
  const Deck deck(text);
  for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr, Formulation::vm_md}) {
    INFO(scene::name_of(formulation));
    const app::CampbellDiagram found = diagram(fill(R"yaml(
bodies:
  hub: {rigid: {mass: 1, centre: [0, 0, 0], inertia: [1, 1, 1]}}
  b:
    mesh: {file: {path: $deck}}
    frame: mean-axis
    reduction: {modes: 10, attachment: all}
joints:
  r: {type: driven, between: [ground, hub.centre], axis: [0, 0, 1], speed: 30}
  k: {type: fixed, between: [hub.centre, b.ring], edges: mean}
)yaml",
                                                    {{"deck", deck.path()}}),
                                               formulation, "0,30", 6);
    for (const app::CampbellPoint& point : found.points) {
      const std::vector<double> here = omega(point);
      const auto nearest = [&](double wanted) {
        return *std::min_element(here.begin(), here.end(),
                                 [&](double a, double b) { return std::abs(a - wanted) < std::abs(b - wanted); });
      };
      CHECK(here.front() > 100);  // others bend out of its plane or rotate it
      for (const double sign : {-1., 1.}) {
        const double n = 2, w0 = n * (n * n - 1) * t / (R * R) * std::sqrt(E / (12 * rho * (n * n + 1))),
                     c = n * (n * n - 1) / (n * n + 1) * point.speed,
                     expected = sign * 2 * n / (n * n + 1) * point.speed + std::hypot(w0, c);
        CHECK(nearest(expected) == Approx(expected).epsilon(1e-2));
      }
      CHECK(std::count_if(here.begin(), here.end(), [](double one) { return one < 200; }) == 2);
    }
  }
}
