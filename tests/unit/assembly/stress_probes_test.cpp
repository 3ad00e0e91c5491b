#include <catch2/catch.hpp>
#include <map>

#include "building.h"

using namespace floe;
using scene::Formulation;

namespace {

constexpr double E = 1e7, nu = 0.3, h = 0.01, stretch = 1e-7, bend = 1e-6, twist = 5e-7;

/// A plate that starts with u = a x, w = b x^2 + c x y: e_xx = a, kappa_xx = -2 b, 2 kappa_xy = -2 c.
std::map<std::string, double> start_of(const std::string& cells, Formulation formulation) {
  const assembly::Model model = testing::built(R"yaml(
parameters: {a: 1e-7, b: 1e-6, c: 5e-7}
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [8, 4], cells: )yaml" +
                                                   cells + R"yaml(}}
    section: {thickness: 0.01}
    material: {E: 1e7, nu: 0.3, rho: 100}
    initial: {deformation: ["a*x", 0, "b*x^2 + c*x*y"]}
motion: {end: 1, step: 0.1}
probes:
  top: {at: {body: plate, node: [0.5, 0.25, 0]}, quantity: stress, surface: top}
  top_strain: {at: {body: plate, node: [0.5, 0.25, 0]}, quantity: strain, surface: top}
  diagonal: {at: {body: plate, node: [0.5, 0.25, 0]}, quantity: strain, surface: top, axis: [1, 1, 0]}
  low: {at: {body: plate, node: [0.5, 0.25, 0]}, quantity: stress, surface: bottom}
  edge: {at: {body: plate, node: [0, 0.25, 0]}, quantity: stress, surface: top}
  strain: {at: {body: plate, node: [0.5, 0.25, 0]}, quantity: strain, surface: middle}
  across: {at: {body: plate, node: [0.5, 0.25, 0]}, quantity: strain, surface: middle, axis: [0, 1, 0]}
  n: {at: {body: plate, node: [0.5, 0.25, 0]}, quantity: membrane_force}
  m: {at: {body: plate, node: [0.5, 0.25, 0]}, quantity: bending_moment}
  mises: {at: {body: plate, node: [0.5, 0.25, 0]}, quantity: von_mises_stress, surface: top}
)yaml",
                                               formulation);
  std::map<std::string, double> all;
  const auto columns = assembly::probe_columns(model);
  const auto values = testing::at_start(model);
  for (std::size_t i = 0; i < columns.size(); ++i) all[columns[i].name] = values[i];
  return all;
}

}  // namespace

TEST_CASE("stresses, strains, forces and moments of a shell that starts stretched, bent and twisted") {
  for (const std::string cells : {"triangles", "quadrilaterals"}) {
    INFO(cells);
    auto at = start_of(cells, Formulation::lffr);
    const double Q = E / (1 - nu * nu), D = Q * h * h * h / 12;
    const auto stress = [&](double z) { return Q * (stretch - 2 * bend * z); };
    CHECK(at["top.xx"] == Approx(stress(h / 2)).epsilon(1e-3));
    CHECK(at["top.yy"] == Approx(nu * stress(h / 2)).epsilon(1e-3));
    CHECK(at["low.xx"] == Approx(stress(-h / 2)).epsilon(1e-3));
    CHECK(at["edge.xx"] == Approx(stress(h / 2)).epsilon(1e-3));
    CHECK(at["top.xy"] == Approx(-E / (1 + nu) * twist * h / 2).epsilon(1e-3));
    CHECK(at["strain.xx"] == Approx(stretch).epsilon(1e-3));
    CHECK(at["across.yy"] == Approx(stretch).epsilon(1e-3));
    CHECK(std::abs(at["across.xx"]) < 1e-3 * stretch);
    // gamma_xy = 2 eps_xy; in axes rotated by 45 degrees gamma is the difference of the stretches along the first ones
    const double top = stretch - h * bend, gamma = -h * twist;
    CHECK(at["top_strain.xx"] == Approx(top).epsilon(1e-3));
    CHECK(std::abs(at["top_strain.yy"]) < 1e-3 * stretch);
    CHECK(at["top_strain.xy"] == Approx(gamma).epsilon(1e-3));
    CHECK(at["diagonal.xx"] == Approx((top + gamma) / 2).epsilon(1e-3));
    CHECK(at["diagonal.yy"] == Approx((top - gamma) / 2).epsilon(1e-3));
    CHECK(at["diagonal.xy"] == Approx(-top).epsilon(1e-3));
    CHECK(at["n.xx"] == Approx(Q * h * stretch).epsilon(1e-3));
    CHECK(at["m.xx"] == Approx(-2 * D * bend).epsilon(1e-3));
    CHECK(at["m.yy"] == Approx(-2 * nu * D * bend).epsilon(1e-3));
    CHECK(at["m.xy"] == Approx(-(1 - nu) * D * twist).epsilon(1e-3));
    const double x = at["top.xx"], y = at["top.yy"], xy = at["top.xy"];
    CHECK(at["mises.mises"] == Approx(std::sqrt(x * x - x * y + y * y + 3 * xy * xy)));
  }
}

TEST_CASE("stress probes that are not defined are refused with the reason") {
  const auto said = [](const std::string& section, const std::string& probe) {
    return testing::complaint(
        "bodies:\n  plate:\n    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: "
        "[4, 2]}}\n    section: " +
            section +
            "\n    material: {E: 1e7, nu: 0.3, rho: 100}\n    reduction: {modes: 2}\nmotion: "
            "{end: 1, step: 0.1}\nprobes: {s: {" +
            probe + "}}\n",
        Formulation::vm_md);
  };
  const std::string node = "at: {body: plate, node: [0.5, 0.25, 0]}, ";
  using Catch::Matchers::Contains;
  CHECK(said("{thickness: 0.01}", node + "quantity: stress").empty());
  CHECK_THAT(said("{thickness: 0.01}", "at: plate.left, quantity: stress"), Contains("is a place of 3 nodes"));
  CHECK_THAT(said("{thickness: 0.01}", node + "quantity: stress, layer: 2"), Contains("the section there has 1 layer"));
  CHECK_THAT(said("{thickness: 0.01}", node + "quantity: stress, axis: [0, 0, 1]"), Contains("is normal to the shell"));
  CHECK_THAT(said("{thickness: 0.01}", node + "quantity: section_force"), Contains("no beam of body plate"));
}
