#include <catch2/catch.hpp>

#include "floe/solve/branch.h"
#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

/// The equilibrium at t = 1 as `floe static` finds it.
History follow(const std::string& text, int steps) {
  History history = history_of(text, Formulation::cfr);
  for (int i = 1; i <= steps; ++i)
    solve::follow_equilibrium(*history.model.system, double(i - 1) / steps, double(i) / steps, 1e-3, history.model.U,
                              history.model.V, [](const solve::BranchJump&, Vec, Vec) {});
  store(history, 1, history.model.U, history.model.V);
  return history;
}

/// A beam of length 1, EI = GJ = 1, all but inextensible, along a direction, clamped at its start.
std::string beam(const Eigen::Vector3d& along, const std::string& load, int elements, double EA = 1e6) {
  const Eigen::Vector3d y = along.unitOrthogonal();
  const auto text = [](const Eigen::Vector3d& v) {
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v[0], v[1], v[2]);
  };
  return fill(
      R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: $along, elements: $n}}
    section: {A: $EA, Iy: 1, Iz: 1, J: 1, orientation: $y}
    material: {E: 1, G: 1, rho: 1}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {load: $load}
probes: {tip: {at: beam.end, quantity: position}}
)yaml",
      {{"along", text(along)}, {"EA", number(EA)}, {"y", text(y)}, {"n", std::to_string(elements)}, {"load", load}});
}

std::string load(const char* type, const Eigen::Vector3d& v) {
  return fmt::format("{{type: {0}, at: beam.end, {0}: [\"{1:.17g}*t\", \"{2:.17g}*t\", \"{3:.17g}*t\"]}}", type, v[0],
                     v[1], v[2]);
}

Eigen::Vector3d tip(const History& at, const std::string& probe = "tip") {
  return {at[probe + ".x"].back(), at[probe + ".y"].back(), at[probe + ".z"].back()};
}

/// Any direction and one across it.
std::pair<Eigen::Vector3d, Eigen::Vector3d> directions(int i) {
  const Eigen::Vector3d along[] = {{1, 0, 0}, {0, 1, 0}, {1, 2, -2}, {-2, 1, 3}};
  const Eigen::Vector3d across[] = {{0, 0, 1}, {-2, 0, 1}, {2, 1, 2}, {1, 5, -1}};
  return {along[i].normalized(), across[i].normalized()};
}

/// A clamped strip of shells along x.
std::string strip(double L, int n, const std::string& cells, const std::string& load) {
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [$L, 0, 0], across: [0, 1, 0], elements: [$n, 1], cells: $cells}}
    section: {thickness: 0.1}
    material: {E: 1.2e6, nu: 0, rho: 1}
joints: {clamp: {type: fixed, between: [ground, plate.left]}}
loads: {load: $load}
probes: {tip: {at: plate.p2}, other: {at: plate.p3}}
)yaml",
              {{"L", number(L)}, {"n", std::to_string(n)}, {"cells", cells}, {"load", load}});
}

}  // namespace

// Closed form: the curvature is M/EI everywhere. Elements that bend alike stand on the circle.
TEST_CASE("cfr in space: an end moment rolls a beam to circles, in any direction") {
  const auto [along, across] = directions(GENERATE(0, 1, 2, 3));
  const auto rolled = [&](double rotations) {
    return tip(follow(beam(along, load("moment", 2 * M_PI * rotations * along.cross(across)), 10), 4));
  };
  CHECK((rolled(0.25) - 2 / M_PI * (along + across)).norm() < 5e-5);
  CHECK((rolled(0.5) - 2 / M_PI * across).norm() < 5e-5);
  CHECK(rolled(1).norm() < 1e-9);
}

// Mattiasson 1981, Int. J. Numer. Methods Eng. 17: the elastica under an end force, to five digits.
TEST_CASE("cfr in space: the elastica under an end force, order 4 in the length of the elements") {
  const auto [along, across] = directions(GENERATE(0, 2));
  const auto bent = [&](double P, int n) {
    const Eigen::Vector3d at = tip(follow(beam(along, load("force", P * across), n), 2));
    return Eigen::Vector3d(1 - at.dot(along), at.dot(across), at.dot(along.cross(across)));
  };
  for (const auto& [P, u, w] :
       {std::tuple{1., .05643, .30172}, {2., .16064, .49346}, {5., .38763, .71379}, {10., .55500, .81061}}) {
    const Eigen::Vector3d at = bent(P, 32);
    CHECK(at[0] == Approx(u).margin(3e-5));
    CHECK(at[1] == Approx(w).margin(3e-5));
    CHECK(std::abs(at[2]) < 1e-9);
  }
  const double coarse = bent(2, 4)[1], middle = bent(2, 8)[1], fine = bent(2, 16)[1];
  CHECK(std::log2((coarse - middle) / (middle - fine)) == Approx(4).margin(0.3));
}

// Bathe and Bolourchi 1979, Int. J. Numer. Methods Eng. 14: an arc of 45 degrees, radius 100, section 1 x 1, force out
// of its plane; torsion constant 1/6 as in Simo and Vu-Quoc 1986. Other authors differ from them by 0.7 of a radius of
// 100.
TEST_CASE("cfr in space: the bend of 45 degrees") {
  const auto bend = [](double P, int n) {
    std::string points;
    for (int i = 0; i <= n; ++i) {
      const double angle = M_PI / 4 * i / n;
      points +=
          fmt::format("{}[{:.17g}, {:.17g}, 0]", i ? ", " : "", 100 * std::sin(angle), 100 * (1 - std::cos(angle)));
    }
    return tip(follow(fill(R"yaml(
bodies:
  beam:
    mesh: {polyline: {points: [$points], elements: 1}}
    section: {A: 1, Iy: 0.08333333333333333, Iz: 0.08333333333333333, J: 0.16666666666666667, orientation: [0, 0, 1]}
    material: {E: 1e7, nu: 0, rho: 1}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {load: {type: force, at: beam.end, force: [0, 0, "$P*t"]}}
probes: {tip: {at: beam.end, quantity: position}}
)yaml",
                           {{"points", points}, {"P", number(P)}}),
                      4));
  };
  const auto near = [](const Eigen::Vector3d& found, const Eigen::Vector3d& published) {
    return (found - published).cwiseAbs().maxCoeff();
  };
  CHECK(near(bend(300, 8), {59.2, 22.5, 39.5}) < 1);
  CHECK(near(bend(600, 8), {47.2, 15.9, 53.4}) < 0.5);
  const Eigen::Vector3d coarse = bend(600, 8), middle = bend(600, 16), fine = bend(600, 32);
  CHECK(std::log2((coarse - middle).norm() / (middle - fine).norm()) == Approx(2).margin(0.1));
}

// Both are the same energy of the same nodes.
TEST_CASE("cfr in space: a beam in a plane of space is at rest where the planar one is") {
  const std::string planar = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}
    section: {EA: 2e3, EI: 1, rhoA: 1}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads:
  force: {type: force, at: beam.end, force: ["-1.5*t", "2.5*t"]}
  moment: {type: moment, at: beam.middle, moment: "0.8*t"}
  line: {type: distributed, body: beam, force: ["0.3*t", "-1*t"]}
gravity: [0.2, -0.7]
probes: {tip: {at: beam.end, quantity: position}}
)yaml";
  const std::string spatial = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [0, 1, 0], elements: 6}}
    section: {A: 2e3, Iy: 1, Iz: 1, J: 1, orientation: [1, 0, 0]}
    material: {E: 1, G: 1, rho: 5e-4}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads:
  force: {type: force, at: beam.end, force: [0, "-1.5*t", "2.5*t"]}
  moment: {type: moment, at: beam.middle, moment: ["0.8*t", 0, 0]}
  line: {type: force, at: beam.end, force: [0, 0, 0]}
probes: {tip: {at: beam.end, quantity: position}}
)yaml";
  // without what is spread over the elements, which the plane distributes in another way
  const std::string bare = planar.substr(0, planar.find("  line:")) + planar.substr(planar.find("probes:"));
  const History one = follow(bare, 2), two = follow(spatial, 2);
  CHECK(two["tip.y"].back() == Approx(one["tip.x"].back()).margin(1e-10));
  CHECK(two["tip.z"].back() == Approx(one["tip.y"].back()).margin(1e-10));
  CHECK(std::abs(two["tip.x"].back()) < 1e-12);
}

// Closed form: a circle.
TEST_CASE("cfr in space: an end moment rolls a strip of shells to circles") {
  const std::string cells = GENERATE("quadrilaterals", "triangles");
  const double M = 2 * M_PI * 1.2e6 * 1e-3 / 12 / 12;  // 2 pi EI/L
  const auto rolled = [&](double rotations) {
    return follow(
        strip(12, 16, cells,
              fmt::format("{{type: moment, at: plate.right, moment: [0, \"{:.17g}*t\", 0]}}", -rotations * M)),
        rotations > 0.5 ? 4 : 2);
  };
  const History half = rolled(0.5), whole = rolled(1);
  CHECK(half["tip.x"].back() == Approx(-12).margin(2e-3));
  CHECK(half["tip.z"].back() == Approx(24 / M_PI).epsilon(2e-3));
  CHECK(std::hypot(whole["tip.x"].back() + 12, whole["tip.z"].back()) < 3e-3);
  CHECK(std::abs(whole["tip.y"].back()) < 0.03);  // triangles: the mesh is not symmetric
}

// Sze, Liu and Lo 2004, Finite Elem. Anal. Des. 40, table 1 (16 x 1 elements): P = 4 b; the elastica: 6.6996
// and 3.2894.
TEST_CASE("cfr in space: a strip of shells under an end force") {
  const std::string cells = GENERATE("quadrilaterals", "triangles");
  const History at = follow(strip(10, 16, cells, "{type: force, at: plate.right, force: [0, 0, \"4*t\"]}"), 4);
  CHECK(at["tip.z"].back() == Approx(6.698).epsilon(2e-3));
  CHECK(-at["tip.x"].back() == Approx(3.286).epsilon(2e-3));
  CHECK(at["other.z"].back() == Approx(6.698).epsilon(2e-3));
}

namespace {

/// A mesh of n x m quadrilaterals as a deck; f(s, t) for s, t from 0 to 1. Places A, B: the ends of the side t = 1;
/// `start`, `end`: the sides t = 0 and t = 1.
template <class Map>
void write_deck(const std::string& path, int n, int m, double E, double nu, double thickness, const Map& f) {
  std::string text = "*NODE\n";
  const auto node = [&](int i, int j) { return j * (n + 1) + i + 1; };
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) {
      const Eigen::Vector3d x = f(double(i) / n, double(j) / m);
      text += fmt::format("{}, {:.15g}, {:.15g}, {:.15g}\n", node(i, j), x.x(), x.y(), x.z());
    }
  text += "*ELEMENT, TYPE=S4, ELSET=skin\n";
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i)
      text += fmt::format("{}, {}, {}, {}, {}\n", j * n + i + 1, node(i, j), node(i + 1, j), node(i + 1, j + 1),
                          node(i, j + 1));
  for (const auto& [name, j] : {std::pair{"start", 0}, {"end", m}}) {
    text += fmt::format("*NSET, NSET={}\n", name);
    for (int i = 0; i <= n; ++i) text += fmt::format("{},\n", node(i, j));
  }
  text += fmt::format("*NSET, NSET=A\n{},\n*NSET, NSET=B\n{},\n", node(0, m), node(n, m));
  text +=
      fmt::format("*MATERIAL, NAME=M\n*ELASTIC\n{}, {}\n*DENSITY\n1,\n*SHELL SECTION, ELSET=skin, MATERIAL=M\n{},\n", E,
                  nu, thickness);
  write_text(path, text);
}

}  // namespace

// Sze, Liu and Lo 2004, table 3, under the whole line force of 0.8. Coarse here: 4 x 24 against
// 10 x 80 elements, too stiff by a tenth; 6 x 30 elements err by 4.6 % and 3.8 %.
TEST_CASE("cfr in space: the slit annular plate") {
  const Scratch folder;
  const std::string deck = folder.path / "annulus.inp";
  write_deck(deck, 4, 24, 21e6, 0, 0.03, [](double s, double t) {
    return Eigen::Vector3d((6 + 4 * s) * std::cos(2 * M_PI * t), (6 + 4 * s) * std::sin(2 * M_PI * t), 0);
  });
  const History at = follow(fill(R"yaml(
bodies: {plate: {mesh: {file: {path: $deck}}}}
joints: {clamp: {type: fixed, between: [ground, plate.start]}}
loads: {p: {type: force, at: plate.end, force: [0, 0, "3.2*t"]}}
probes: {A: {at: plate.A}, B: {at: plate.B}}
)yaml",
                                 {{"deck", deck}}),
                            10);
  CHECK(at["A.z"].back() == Approx(13.891).epsilon(0.11));
  CHECK(at["B.z"].back() == Approx(17.528).epsilon(0.11));
}

// The motion is that of rigid bodies at the nodes: all energy that is lost is the scheme's.
// The mean of a cubic edge, by nodes h = 0.15 apart: trapezoidal rule and h^2/12 (w'(0) - w'(L)) / L, w' = theta_x.
TEST_CASE("cfr in space: the mean of an edge is that of the displacements of its elements") {
  std::string panel = R"yaml(
bodies:
  plate:
    mesh: {plate: {origin: [0, 0, 0], along: [1, 0, 0], across: [0, 0.6, 0], elements: [6, 4], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 1e9, nu: 0.3, rho: 1000}
joints: {root: {type: fixed, between: [ground, plate.left]}}
loads:
  edge: {type: force, at: plate.right, force: [0, 0, "1e-2*sin(20*t)"]}
  corner: {type: force, at: plate.p3, force: [0, 0, "2e-2*t"]}
motion: {end: 0.1, step: 1e-3}
probes:
  x: {at: plate.right, quantity: position, relative_to: plate.p1}
)yaml";
  const std::pair<const char*, const char*> pairs[] = {
      {"displacement", "rotation"}, {"velocity", "angular_velocity"}, {"acceleration", "angular_acceleration"}};
  for (const auto& [linear, angular] : pairs) {
    panel += fmt::format("  {0}: {{at: plate.right, quantity: {0}}}\n", linear);
    for (int i = 0; i < 5; ++i)
      panel +=
          fmt::format("  {0}{1}: {{at: {{body: plate, node: [1, {2}, 0]}}, quantity: {0}}}\n", linear, i, 0.15 * i);
    for (const char* end : {"p2", "p3"})
      panel += fmt::format("  {0}_{1}: {{at: plate.{1}, quantity: {0}}}\n", angular, end);
  }
  const History at = move(panel, Formulation::cfr);
  for (const auto& [linear, angular] : pairs) {
    const auto w = [&, name = linear](int i) { return at[fmt::format("{}{}.z", name, i)].back(); };
    const std::string slope = angular, component = linear == std::string("displacement") ? ".rx" : ".x";
    const double ends = at[slope + "_p2" + component].back() - at[slope + "_p3" + component].back();
    const double mean = (w(0) + w(4)) / 8 + (w(1) + w(2) + w(3)) / 4 + 0.15 * 0.15 / 12 * ends / 0.6;
    INFO(linear << ": rotations of the ends contribute " << 0.15 * 0.15 / 12 * ends / 0.6 / mean);
    CHECK(at[linear + std::string(".z")].back() == Approx(mean).epsilon(1e-6));
  }
  CHECK(at["x.x"].back() == Approx(1).epsilon(1e-6));
}

// f L^3 / (3 EI) + f L / (k G A), two different I and k.
TEST_CASE("cfr in space: a beam with shear deflects by bending and by shear") {
  const double f = 0.03, E = 1e4, G = 4e3;
  const auto formulation = GENERATE(Formulation::cfr, Formulation::nlffr);
  const History at = rest(fill(R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0, 0], to: [0, 0, 1], elements: 4}}
    section: {A: 1, Iy: 0.02, Iz: 0.01, J: 0.02, orientation: [1, 0, 0], shear_factor: [0.5, 0.8]}
    material: {E: $E, G: $G, rho: 1}
joints: {root: {type: fixed, between: [ground, b.start]}}
loads: {end: {type: force, at: b.end, force: [$f, $f, 0]}}
probes: {end: {at: b.end, quantity: displacement}}
)yaml",
                               {{"E", number(E)}, {"G", number(G)}, {"f", "\"" + number(f) + "*t\""}}),
                          formulation);
  CHECK(at["end.x"].back() == Approx(f / (3 * E * 0.01) + f / (0.5 * G)).epsilon(1e-6));
  CHECK(at["end.y"].back() == Approx(f / (3 * E * 0.02) + f / (0.8 * G)).epsilon(1e-6));
}

TEST_CASE("cfr in space: a free beam keeps its energy") {
  const auto flown = [](double step) {
    return move(fill(R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 6}}
    section: {A: 1, Iy: 0.001, Iz: 0.002, J: 0.002, orientation: [0, 1, 0]}
    material: {E: 1e3, G: 4e2, rho: 1}
    initial: {velocity: [0, 0, 1], angular_velocity: [1, 2, 8], deformation: ["0", "0.05*x*x", "0.03*x*x"]}
motion: {end: 0.4, step: $h, spectral_radius: 0.99}
probes: {tip: {at: b.end}}
)yaml",
                     {{"h", number(step)}}),
                Formulation::cfr);
  };
  const auto drift = [](const History& h) {
    const auto sum = [](const dynamics::Energy& e) { return e.kinetic + e.elastic; };
    double maximum = 0;
    for (const dynamics::Energy& e : h.energy) maximum = std::max(maximum, std::abs(sum(e) / sum(h.energy[0]) - 1));
    return maximum;
  };
  const double coarse = drift(flown(2e-3)), fine = drift(flown(1e-3));
  CHECK(fine < 2e-4);
  CHECK(fine < coarse / 3);
}

// The floating frames and the elements' own frames say the same of a beam that deflects little.
TEST_CASE("cfr in space: a beam that rotates and deflects little, against the full-order model in a floating frame") {
  const std::string scene = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  b:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: $n}}
    section: {shape: rectangle, width: 0.02, height: 0.03, orientation: [0, 1, 0]}
    material: {E: 2e9, nu: 0.3, rho: 2000}
    damping: {stiffness: 1e-4}
joints: {s: {type: spherical, between: [ground, b.start]}}
loads: {f: {type: force, at: b.end, force: [0, "t < 0.1 ? 20 : 0", 0]}}
motion: {end: 0.5, step: 1e-3}
probes: {tip: {at: b.end}}
)yaml";
  const auto swung = [&](const char* n, Formulation formulation) { return move(fill(scene, {{"n", n}}), formulation); };
  const History exact = swung("16", Formulation::nlffr);
  const auto error = [&](const char* n) {
    const History at = swung(n, Formulation::cfr);
    return std::max(relative_error(at, exact, "tip.y"), relative_error(at, exact, "tip.z"));
  };
  CHECK(error("16") < 1e-3);
}

// For small deflections both models agree; those of cfr are measured from the node or the edge that the frame of
// the other is clamped at, or from the chord of the nodes that it is pinned to.
TEST_CASE("cfr in space: deflections from clamped and pinned frames, against the full-order model") {
  const std::string beam = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 12}}
    section: {shape: rectangle, width: 0.04, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 7e9, nu: 0.3, rho: 2700}
    frame: $frame
    damping: {stiffness: 2e-3}
    initial: {angular_velocity: [0.3, 1, 2]}
joints: {h: {type: spherical, between: [ground, beam.start]}}
gravity: [0, 0, -9.81]
motion: {end: 0.3, step: 2e-3}
probes: {at: {at: $at, quantity: deflection}}
)yaml",
                    strip = R"yaml(
bodies:
  hub:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [0.1, 0, 0], elements: 1}}
    section: {shape: rectangle, width: 0.05, height: 0.05, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
  strip:
    mesh: {plate: {origin: [0.1, -0.05, 0], along: [1, 0, 0], across: [0, 0.1, 0], elements: [12, 2], cells: quadrilaterals}}
    section: {thickness: 6e-3}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    frame: {type: clamped, at: left}
joints:
  drive: {type: driven, between: [ground, hub.start], axis: [0, 1, 0], angle: "0.5*(1 - cos(4*t))"}
  weld: {type: fixed, between: [hub.end, strip.left]}
motion: {end: 0.4, step: 2e-3}
probes: {at: {at: strip.p3, quantity: deflection}}
)yaml";
  for (const std::string& text : {fill(beam, {{"frame", "pinned"}, {"at", "beam.middle"}}),
                                  fill(beam, {{"frame", "{type: clamped, at: start}"}, {"at", "beam.end"}}), strip}) {
    const History exact = move(text, Formulation::nlffr), corotated = move(text, Formulation::cfr);
    double maximum = 0, error = 0;
    for (const char* column : {"at.x", "at.y", "at.z"})
      for (std::size_t i = 0; i < exact.t.size(); ++i) {
        maximum = std::max(maximum, std::abs(exact[column][i]));
        error = std::max(error, std::abs(exact[column][i] - corotated[column][i]));
      }
    INFO(text << maximum);
    CHECK(maximum > 5e-4);
    CHECK(error < (text == strip ? 0.03 : 0.01) * maximum);
  }
}

// At 40 rad/s a step of 0.1 s is 4 rad, of which elements do not see a revolution. Rigid bodies, which have no strains,
// may rotate as far, and adaptive steps become smaller.
TEST_CASE("corotational in space: a node that rotates by more than half a revolution in a step is refused") {
  const std::string spun = R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 8}}
    section: {shape: rectangle, width: 0.06, height: 0.2, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.33, rho: 2700}
    initial: {angular_velocity: [0, 0, 40]}
    rigid: $rigid
joints: {h: {type: revolute, between: [ground, b.start], axis: [0, 0, 1]}}
motion: {end: $end, step: 0.1$tolerance}
probes: {tip: {at: b.end}}
)yaml";
  const auto run = [&](const char* rigid, const char* end, const char* tolerance) {
    return move(fill(spun, {{"rigid", rigid}, {"end", end}, {"tolerance", tolerance}}), Formulation::cfr);
  };
  for (const char* end : {"1", "0.1"}) {
    INFO(end);
    CHECK_THROWS_WITH(run("false", end, ""), Catch::Contains("half a revolution") && Catch::Contains("shorter steps"));
  }
  CHECK(run("false", "1", ", tolerance: 1e-4").at("tip.x", 1) == Approx(std::cos(40.) - 1).margin(0.1));
  CHECK(run("true", "1", "")["tip.y"].size() > 10);
}
