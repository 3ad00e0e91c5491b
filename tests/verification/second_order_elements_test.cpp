#include <catch2/catch.hpp>

#include "floe/assess/body_properties.h"
#include "floe/solve/branch.h"
#include "shell_decks.h"

using namespace floe;
using namespace floe::test;
using Eigen::Vector3d;

// Bodies of S8R, S6 and B32R, read from decks.

namespace {

Vector3d flat(double u, double v) { return {u, v, 0}; }

/// n beams of three nodes along a curve, with its ends as node sets. @param section  lines of *BEAM GENERAL SECTION
std::string beams(int n, const std::function<Vector3d(double)>& at, const std::string& section) {
  std::string text = "*NODE\n";
  for (int i = 0; i <= 2 * n; ++i) text += node_line(i + 1, at(i / (2. * n)));
  text += "*ELEMENT, TYPE=B32R, ELSET=line\n";
  for (int i = 0; i < n; ++i) text += fmt::format("{}, {}, {}, {}\n", i + 1, 2 * i + 1, 2 * i + 2, 2 * i + 3);
  return text + fmt::format("*NSET, NSET=start\n1\n*NSET, NSET=end\n{}\n", 2 * n + 1) +
         "*BEAM GENERAL SECTION, ELSET=line, DENSITY=1.\n" + section;
}

std::string triple(const Vector3d& v) { return fmt::format("{:.17g}, {:.17g}, {:.17g}", v[0], v[1], v[2]); }

/// Of length 1, EI = GJ = 1, all but inextensible, clamped at its start.
std::string unit_section(const Vector3d& orientation, double EA) {
  return fmt::format("{:.17g}, 1., 0., 1., 1.\n{}\n1., 1.\n", EA, triple(orientation));
}

std::string clamped_beam(const Deck& deck, const std::string& load) {
  return fill(R"yaml(
bodies: {beam: {mesh: {file: {path: $path}}, reduction: {modes: 4}}}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {load: $load}
probes: {tip: {at: beam.end, quantity: position}}
)yaml",
              {{"path", deck.path()}, {"load", load}});
}

std::string load(const char* type, const Vector3d& v) {
  return fmt::format("{{type: {0}, at: beam.end, {0}: [\"{1:.17g}*t\", \"{2:.17g}*t\", \"{3:.17g}*t\"]}}", type, v[0],
                     v[1], v[2]);
}

/// At the equilibrium that `floe static` follows from no load to t = 1.
Vector3d tip_at_rest(const std::string& text, int steps) {
  History at = history_of(text, Formulation::cfr);
  for (int i = 1; i <= steps; ++i)
    solve::follow_equilibrium(*at.model.system, double(i - 1) / steps, double(i) / steps, 1e-3, at.model.U, at.model.V,
                              [](const solve::BranchJump&, Vec, Vec) {});
  store(at, 1, at.model.U, at.model.V);
  return {at["tip.x"].back(), at["tip.y"].back(), at["tip.z"].back()};
}

/// Side 1, D = 1, mass 1 per area, nu = 0.3. @param edges  `fixed` or `revolute`
std::vector<double> plate_frequencies(bool triangles, double thickness, const std::string& edges, int n) {
  const Deck deck(shells(
      triangles ? "S6" : "S8R", n, n, thickness,
      fmt::format("*ELASTIC\n{:.17g}, 0.3\n*DENSITY\n{:.17g}\n", 12 * 0.91 / std::pow(thickness, 3), 1 / thickness),
      flat));
  std::string joints;
  for (const char* side : {"left", "right", "bottom", "top"})
    joints += fmt::format("{0}: {{type: {1}, between: [ground, p.{0}]}}, ", side, edges);
  return omega_of(
      fmt::format("bodies: {{p: {{mesh: {{file: {{path: {}}}}}, reduction: {{modes: 4}}}}}}\njoints: {{{}}}\n",
                  deck.path(), joints));
}

}  // namespace

// Closed form pi^2 (i^2 + j^2); clamped: Leissa 1973, J. Sound Vib. 31.
TEST_CASE("plates of second order: frequencies of hinged and clamped plates, however thin") {
  const bool triangles = GENERATE(false, true);
  const double thickness = GENERATE(2e-3, 1e-4);
  CAPTURE(triangles, thickness);
  const double of_hinged[] = {2, 5, 5, 8}, of_clamped[] = {35.985, 73.394, 73.394, 108.22};
  for (const auto& [edges, expected, factor] :
       {std::tuple("revolute", of_hinged, M_PI * M_PI), {"fixed", of_clamped, 1.}}) {
    const auto coarse = plate_frequencies(triangles, thickness, edges, 8),
               fine = plate_frequencies(triangles, thickness, edges, 16);
    for (int i = 0; i < 4; ++i) {
      const double limit = factor * expected[i];
      CHECK(fine.at(i) == Approx(limit).epsilon(triangles ? 2e-2 : 2e-3));
      CHECK((4 * fine[i] - coarse.at(i)) / 3 == Approx(limit).epsilon(triangles ? 7e-3 : 2e-3));
    }
  }
}

// Converged independent computation, as in static_plate_test.
TEST_CASE("clamped plate of second order under pressure: large static deflection") {
  const bool triangles = GENERATE(false, true);
  const int n = triangles ? 16 : 8;
  const Deck deck(shells(triangles ? "S6" : "S8R", n, n, 0.01, "*ELASTIC\n1e7, 0.3\n*DENSITY\n1.\n", flat));
  const auto deflection = [&](double Q, Formulation formulation) {
    return rest(fill(R"yaml(
bodies: {p: {mesh: {file: {path: $path}}, reduction: {modes: {count: 24, alone: 24}}}}
joints:
  l: {type: fixed, between: [ground, p.left]}
  r: {type: fixed, between: [ground, p.right]}
  b: {type: fixed, between: [ground, p.bottom]}
  t: {type: fixed, between: [ground, p.top]}
loads: {load: {type: distributed, body: p, force: [0, 0, "$p*t"]}}
probes: {centre: {at: {body: p, node: [0.5, 0.5, 0]}}}
)yaml",
                     {{"path", deck.path()}, {"p", number(Q * 1e7 * 1e-8)}}),
                formulation, 4)["centre.z"]
               .back() /
           0.01;
  };
  for (const auto& [Q, w] : {std::pair{1., .013816}, {25., .326962}, {100., .937420}, {200., 1.364028}})
    CHECK(deflection(Q, Formulation::nlffr) == Approx(w).epsilon(triangles ? 1.8e-2 : 5e-3));
  CHECK(deflection(100, Formulation::vm_md) == Approx(.937420).epsilon(1e-2));
  CHECK(deflection(100, Formulation::cfr) == Approx(.937420).epsilon(1e-2));
}

// 0.5 m by 0.5 m, of radius 1 m and 4 mm thick; CalculiX 2.20 with NLGEOM on the same mesh of S8R. Forces of facets
// between the nodes, which are not those of the shape functions, gave 7.66e-5 in cfr.
TEST_CASE("hinged cylindrical panel of second order under external pressure") {
  const auto panel = [](double s, double t) {
    return Vector3d(0.5 * s, std::sin(0.5 * t - 0.25), std::cos(0.5 * t - 0.25) - 1);
  };
  const Deck deck(shells("S8R", 8, 8, 0.004, "*ELASTIC\n7e10, 0.3\n*DENSITY\n2700.\n", panel));
  for (const bool follower : {true, false})
    for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr}) {
      const History at = rest(fill(R"yaml(
bodies: {p: {mesh: {file: {path: $path}}, reduction: {modes: 1}}}
joints:
  l: {type: support, between: [ground, p.left], hold: [x, y, z]}
  r: {type: support, between: [ground, p.right], hold: [x, y, z]}
  b: {type: support, between: [ground, p.bottom], hold: [x, y, z]}
  t: {type: support, between: [ground, p.top], hold: [x, y, z]}
loads: {load: {type: pressure, body: p, pressure: "-16e3*t", follower: $follower}}
probes: {centre: {at: {body: p, node: [0.25, 0, 0]}}}
)yaml",
                                   {{"path", deck.path()}, {"follower", follower ? "true" : "false"}}),
                              formulation, 2);
      INFO(name_of(formulation) << " " << follower);
      CHECK(std::abs(at["centre.z"].back()) == Approx(7.198e-5).epsilon(0.01));
    }
}

TEST_CASE("beams of second order: an end moment rolls them to circles, in any direction") {
  const int i = GENERATE(0, 1);
  const Vector3d along = (i ? Vector3d(1, 2, -2) : Vector3d(1, 0, 0)).normalized(),
                 across = (i ? Vector3d(2, 1, 2) : Vector3d(0, 0, 1)).normalized();
  const Deck deck(beams(
      10, [&](double s) -> Vector3d { return s * along; }, unit_section(along.unitOrthogonal(), 1e6)));
  const auto rolled = [&](double rotations) {
    return tip_at_rest(clamped_beam(deck, load("moment", 2 * M_PI * rotations * along.cross(across))), 8);
  };
  CHECK((rolled(0.25) - 2 / M_PI * (along + across)).norm() < 2e-3);
  CHECK((rolled(0.5) - 2 / M_PI * across).norm() < 4e-3);
}

// Mattiasson 1981, Int. J. Numer. Methods Eng. 17.
TEST_CASE("beams of second order: the elastica under an end force") {
  const Deck deck(beams(
      16, [](double s) { return Vector3d(s, 0, 0); }, unit_section({0, 1, 0}, 1e6)));
  for (const auto& [P, u, w] : {std::tuple{1., .05643, .30172}, {5., .38763, .71379}, {10., .55500, .81061}}) {
    const Vector3d at = tip_at_rest(clamped_beam(deck, load("force", {0, 0, P})), 4);
    CHECK(1 - at.x() == Approx(u).margin(5e-4));
    CHECK(at.z() == Approx(w).margin(5e-4));
    CHECK(std::abs(at.y()) < 1e-9);
  }
}

// Bathe and Bolourchi 1979, Int. J. Numer. Methods Eng. 14; see corotational_space_test.
TEST_CASE("beams of second order: the bend of 45 degrees, of curved elements") {
  const auto arc = [](double s) {
    const double angle = M_PI / 4 * s;
    return Vector3d(100 * std::sin(angle), 100 * (1 - std::cos(angle)), 0);
  };
  const auto bend = [&](double P, int n) {
    const Deck deck(
        beams(n, arc, "1., 0.08333333333333333, 0., 0.08333333333333333, 0.16666666666666667\n0., 0., 1.\n1e7, 5e6\n"));
    return tip_at_rest(clamped_beam(deck, load("force", {0, 0, P})), 4);
  };
  CHECK((bend(300, 8) - Vector3d(59.2, 22.5, 39.5)).cwiseAbs().maxCoeff() < 1);
  CHECK((bend(600, 8) - Vector3d(47.2, 15.9, 53.4)).cwiseAbs().maxCoeff() < 0.5);
  CHECK((bend(600, 4) - Vector3d(47.2, 15.9, 53.4)).cwiseAbs().maxCoeff() < 0.5);
}

// A strip of shells in `cfr` bent to a quarter and half of a circle.
TEST_CASE("shells of second order: an end moment rolls a strip to a circle") {
  const bool triangles = GENERATE(false, true);
  const double h = GENERATE(0.1, 0.01), L = 10, EI = 1.2e6 * h * h * h / 12;
  CAPTURE(triangles, h);
  const Deck deck(shells(triangles ? "S6" : "S8R", 10, 1, h, "*ELASTIC\n1.2e6, 0\n*DENSITY\n1.\n",
                         [&](double u, double v) { return Vector3d(L * u, v, 0); }));
  const auto rolled = [&](double rotations) {
    return tip_at_rest(fill(R"yaml(
bodies: {p: {mesh: {file: {path: $path}}}}
joints: {clamp: {type: fixed, between: [ground, p.left]}}
loads: {load: {type: moment, at: p.right, moment: [0, "$M*t", 0]}}
probes: {tip: {at: {body: p, node: [$L, 0.5, 0]}, quantity: position}}
)yaml",
                            {{"path", deck.path()}, {"L", number(L)}, {"M", number(-2 * M_PI * rotations * EI / L)}}),
                       8);
  };
  for (const double rotations : {0.25, 0.5}) {
    const double angle = 2 * M_PI * rotations, r = L / angle;
    CHECK((rolled(rotations) - Vector3d(r * std::sin(angle), 0.5, r * (1 - std::cos(angle)))).norm() < 5e-3 * L);
  }
}

// 1 x 0.1 x 0.002, with a rigid body at its end, whose edge contracts as it rotates; edges rotated to first order alone
// are stretched, and resist. Strains of second order: the drilling of quadratic shells is linear, 0.3 % here.
TEST_CASE("shells of second order: a strip twists with a rigid edge as corotational shells") {
  const auto [triangles, strains, tolerance] =
      GENERATE(std::tuple(false, "von_karman", 1e-3), std::tuple(true, "von_karman", 1e-3),
               std::tuple(false, "second_order", 5e-3), std::tuple(true, "second_order", 5e-3));
  const Deck deck(shells(triangles ? "S6" : "S8R", 10, 2, 0.002, "*ELASTIC\n7e10, 0\n*DENSITY\n2700\n",
                         [](double u, double v) { return Vector3d(u, 0.1 * v, 0); }));
  const std::string text = fill(R"yaml(
bodies:
  strip: {mesh: {file: {path: $path}}, strains: $strains}
  hub: {rigid: {mass: 1, centre: [1, 0.05, 0], inertia: [1e-3, 1e-3, 1e-3]}}
joints:
  root: {type: fixed, between: [ground, strip.left]}
  weld: {type: fixed, between: [hub.centre, strip.right]}
loads: {twist: {type: moment, at: hub.centre, moment: ["t", 0, 0]}}
probes: {tip: {at: hub.centre, quantity: rotation}}
)yaml",
                                {{"path", deck.path()}, {"strains", strains}});
  const auto twist = [&](Formulation formulation) { return rest(text, formulation, 4)["tip.rx"].back(); };
  const double exact = twist(Formulation::cfr);
  CAPTURE(triangles, strains);
  CHECK(exact > 0.08);
  CHECK(twist(Formulation::nlffr) == Approx(exact).epsilon(tolerance));
}

// Elastica (Mattiasson 1981), P L^2 / EI = 0.5: w / L = .16214, u / L = .01592. Of the reduced body the strain of third
// order is condensed (reduction/condensation.h): without it the tip of the beam, all but rigid in shear, moved by
// 0.062.
TEST_CASE("beams and shells of second order: reduced bodies follow the elastica") {
  const auto reduced = [](const std::string& text) {
    const History at = rest(text, Formulation::vm_md);
    return Vector3d(at["tip.x"].back(), at["tip.y"].back(), at["tip.z"].back());
  };
  const Deck beam(beams(
      20, [](double s) { return Vector3d(s, 0, 0); }, unit_section({0, 1, 0}, 1e5)));
  for (const char* frame : {"{type: mean-axis}", "{type: pinned, from: start, to: end}"}) {
    CAPTURE(frame);
    const Vector3d tip = reduced(fill(R"yaml(
bodies: {beam: {mesh: {file: {path: $path}}, frame: $frame, reduction: {modes: 5, derivatives: all}}}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {load: {type: force, at: beam.end, force: [0, 0, 0.5]}}
motion: {end: 1, step: 1}
probes: {tip: {at: beam.end, quantity: position}}
)yaml",
                                      {{"path", beam.path()}, {"frame", frame}}));
    CHECK(tip.z() == Approx(0.16214).epsilon(5e-3));
    CHECK(1 - tip.x() == Approx(0.01592).epsilon(2e-2));
  }
  const double h = 5e-3, EI = 7e10 * 0.1 * h * h * h / 12;
  const Deck strip(shells("S8R", 20, 2, h, "*ELASTIC\n7e10, 0\n*DENSITY\n2700.\n",
                          [&](double u, double v) { return Vector3d(u, 0.1 * v, 0); }));
  const Vector3d tip = reduced(fill(R"yaml(
bodies: {p: {mesh: {file: {path: $path}}, strains: second_order, reduction: {modes: 6, derivatives: all}}}
joints: {clamp: {type: fixed, between: [ground, p.left]}}
loads: {load: {type: force, at: p.right, force: [0, 0, $P]}}
motion: {end: 1, step: 1}
probes: {tip: {at: {body: p, node: [1, 0.05, 0]}, quantity: position}}
)yaml",
                                    {{"path", strip.path()}, {"P", number(0.5 * EI)}}));
  CHECK(tip.z() == Approx(0.16214).epsilon(1.5e-2));
}

// w = a sin(pi x) sin(pi y) of a free plate of side 1: elastic energy (D/8) (2 pi^2)^2 a^2, kinetic energy of the rate
// b sin(pi x) sin(pi y) (m/8) b^2.
TEST_CASE("shells of second order start with the energies of their deformation and its rate") {
  for (const bool triangles : {false, true}) {
    CAPTURE(triangles);
    const Deck plate(shells(triangles ? "S6" : "S8R", 10, 10, 0.01, "*ELASTIC\n1.092e7, 0.3\n*DENSITY\n100.\n",
                            flat));  // D = 1, m = 1
    const History at = move(fill(R"yaml(
parameters: {a: 1e-5, b: 1e-4}
bodies:
  plate:
    mesh: {file: {path: $path}}
    reduction: {modes: 4, derivatives: none, attachment: none}
    initial: {deformation: [0, 0, "a*sin(pi*x)*sin(pi*y)"], deformation_rate: [0, 0, "b*sin(pi*x)*sin(pi*y)"]}
motion: {end: 1e-3, step: 1e-3}
probes: {middle: {at: {body: plate, node: [0.5, 0.5, 0]}, quantity: position}}
)yaml",
                                 {{"path", plate.path()}}),
                            Formulation::lffr);
    CHECK(at.energy.front().elastic == Approx(std::pow(2 * M_PI * M_PI * 1e-5, 2) / 8).epsilon(0.05));
    CHECK(at.energy.front().kinetic == Approx(1e-8 / 8).epsilon(0.05));
    CHECK(at["middle.z"].front() == Approx(1e-5).epsilon(1e-3));
  }
}

TEST_CASE("mass, centre and inertia of bodies of second order") {
  const bool triangles = GENERATE(false, true);
  const double R = 0.5, a = 0.6, L = 1, h = 0.005, rho = 7800;
  const Deck deck(
      shells(triangles ? "S6" : "S8R", 12, 8, h, "*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7800.\n", [&](double u, double v) {
        const double b = a * (2 * v - 1);
        return Vector3d(L * u, R * std::sin(b), R * std::cos(b));
      }));
  const auto scene = scene::parse_scene("bodies: {p: {mesh: {file: {path: " + deck.path() + "}}}}\n", "scene");
  const auto found = assess::body_properties(scene, PETSC_COMM_WORLD, 0).at(0);
  const double mass = rho * h * L * 2 * a * R, height = R * std::sin(a) / a, own = h * h / 12;
  CHECK(found.mass == Approx(mass).epsilon(1e-6));
  CHECK((found.centre - Vector3d(L / 2, 0, height)).norm() < 1e-6);
  // int cos^2 over the arc; the thickness adds h^2/12 along the normals
  const double c2 = (0.5 + std::sin(2 * a) / (4 * a)), yy = (R * R + own) * (1 - c2),
               zz = (R * R + own) * c2 - height * height, xx = L * L / 12;
  CHECK(found.inertia(0, 0) == Approx(mass * (yy + zz)).epsilon(1e-5));
  CHECK(found.inertia(1, 1) == Approx(mass * (xx + zz)).epsilon(1e-5));
  CHECK(found.inertia(2, 2) == Approx(mass * (xx + yy)).epsilon(1e-5));
  CHECK(std::abs(found.inertia(0, 1)) + std::abs(found.inertia(0, 2)) + std::abs(found.inertia(1, 2)) < 1e-9 * mass);
}

// A strip of 1 x 0.1 x 0.005 on a universal joint whose axes lie in its plane, at the mean of its edge: F L^3 / 3 EI in
// the plane, and M L / EI under a moment. With the drilling rotations of nodes for the rotation about the normal the
// deflection was 261 times (S8R) and 1.1 times (S4) as large, and grew with refinement.
TEST_CASE("edges of shells rotate in their plane by their displacements") {
  const auto [type, tolerance] = GENERATE(std::pair("S8R", 1.2e-2), std::pair("S4", 3e-2), std::pair("S3", 4.5e-2));
  const Deck deck(shells(type, 10, 2, 0.005, "*ELASTIC\n7e10, 0.3\n*DENSITY\n2700\n",
                         [](double u, double v) { return Vector3d(u, 0.1 * v, 0); }));
  const std::string text = fill(R"yaml(
bodies: {strip: {mesh: {file: {path: $path}}, reduction: {modes: 1, attachment: all}}}
joints:
  u: {type: universal, axis: [1, 0, 0], second_axis: [0, 1, 0], between: [ground, strip.left]}
  b: {type: bushing, between: [ground, {body: strip, node: [1, 0.05, 0]}], translation: [0, 0, 1e3]}
  c: {type: bushing, between: [ground, {body: strip, node: [0, 0.05, 0]}], rotation: [1e3, 1e3, 0]}
loads: {end: $load}
probes: {end: {at: strip.right}, turn: {at: strip.right, quantity: rotation}}
)yaml",
                                {{"path", deck.path()}});
  const double EI = 7e10 * 0.005 * 0.1 * 0.1 * 0.1 / 12;
  for (const auto formulation : {Formulation::lffr, Formulation::nlffr, Formulation::cfr, Formulation::vm}) {
    CAPTURE(type, scene::name_of(formulation));
    const History force = rest(fill(text, {{"load", "{type: force, at: strip.right, force: [0, \"10*t\", 0]}"}}),
                               formulation),
                  moment = rest(fill(text, {{"load", "{type: moment, at: strip.right, moment: [0, 0, \"10*t\"]}"}}),
                                formulation);
    CHECK(force["end.y"].back() == Approx(10 / (3 * EI)).epsilon(tolerance));
    CHECK(force["turn.rz"].back() == Approx(10 / (2 * EI)).epsilon(tolerance));
    CHECK(moment["end.y"].back() == Approx(10 / (2 * EI)).epsilon(tolerance));
    CHECK(moment["turn.rz"].back() == Approx(10 / EI).epsilon(tolerance));
    for (const char* shape : {"", ", shape: \"1\""}) {
      const std::string per_length = "{type: moment, at: strip.right, per: length, moment: [0, 0, \"100*t\"]";
      const History spread = rest(fill(text, {{"load", per_length + shape + "}"}}), formulation);
      CHECK(spread["turn.rz"].back() == Approx(moment["turn.rz"].back()).epsilon(1e-6));
    }
  }
}

// The strip above, clamped at one node of its edge: by the drilling stiffness there, of which a note warns.
TEST_CASE("a strip that one node clamps moves in its plane by drilling rotations") {
  const auto [type, factor] = GENERATE(std::pair("S8R", 520.), std::pair("S4", 1.15));
  const Deck deck(shells(type, 10, 2, 0.005, "*ELASTIC\n7e10, 0.3\n*DENSITY\n2700\n",
                         [](double u, double v) { return Vector3d(u, 0.1 * v, 0); }));
  const History at = rest(fill(R"yaml(
bodies: {strip: {mesh: {file: {path: $path}}}}
joints: {root: {type: fixed, between: [ground, {body: strip, node: [0, 0.05, 0]}]}}
loads: {end: {type: force, at: strip.right, force: [0, "10*t", 0]}}
probes: {end: {at: strip.right, quantity: displacement}}
)yaml",
                               {{"path", deck.path()}}),
                          Formulation::nlffr);
  CHECK(at["end.y"].back() == Approx(factor * 10 / (3 * 7e10 * 0.005 * 1e-3 / 12)).epsilon(0.02));
}

// A tube, r = 0.1, h = 0.004, 1 m long, clamped at one end: moment about an axis across it at the mean of its other
// rim, and a hinge across it at the first rim with a force at the other. With the mean of nodal rotations the rim
// rotated 10 (S4) and 235 times (S8R) as far, and the hinged tube deflected 26 and 514 times as far in the plane that
// it is held in.
TEST_CASE("rims of tubes rotate by their displacements") {
  const auto [type, along, around] = GENERATE(std::tuple("S4", 20, 16), std::tuple("S8R", 10, 8));
  const Deck deck(shells(
      type, along, around, 0.004, "*ELASTIC\n7e10, 0.3\n*DENSITY\n2700\n",
      [](double u, double v) {
        const double a = 2 * M_PI * v;
        return Vector3d(u, 0.1 * std::cos(a), 0.1 * std::sin(a));
      },
      true));
  const auto tube = [&](const std::string& joints, const std::string& load) {
    return fill(R"yaml(
bodies: {tube: {mesh: {file: {path: $path}}, reduction: {modes: 1, attachment: all}}}
joints: {$joints}
loads: {end: $load}
probes: {end: {at: tube.right, quantity: displacement}, turn: {at: tube.right, quantity: rotation}}
)yaml",
                {{"path", deck.path()}, {"joints", joints}, {"load", load}});
  };
  const std::string
      fixed = "root: {type: fixed, between: [ground, tube.left]}",
      moment = "{type: moment, at: tube.right, moment: [0, 0, \"10*t\"]}",
      hinged =
          "root: {type: revolute, axis: [0, 1, 0], between: [ground, tube.left]}, s: {type: spring, between: "
          "[ground, tube.left], axis: [0, 1, 0], torsional_stiffness: 1000}",
      force = "{type: force, at: tube.right, force: [0, \"10*t\", 0]}";
  const double EI = 7e10 * M_PI * 0.004 * 1e-3;
  for (const auto formulation : {Formulation::lffr, Formulation::nlffr, Formulation::cfr, Formulation::vm}) {
    CAPTURE(type, scene::name_of(formulation));
    CHECK(rest(tube(fixed, moment), formulation)["turn.rz"].back() == Approx(10 / EI).epsilon(0.06));
    CHECK(rest(tube(hinged, force), formulation)["end.y"].back() ==
          Approx(rest(tube(fixed, force), formulation)["end.y"].back()).epsilon(0.03));
  }
}
