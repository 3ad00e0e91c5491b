#include <catch2/catch.hpp>

#include "estimated.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A strip of shells with strains of second order, whose derivatives have products with all; bent by a tenth of its
/// length.
std::string strip(const std::string& products) {
  return R"yaml(
bodies:
  strip:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.25, 0], elements: [8, 2]}}
    section: {thickness: 6e-3}
    strains: second_order
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 4, products: )yaml" +
         products + R"yaml(}
joints: {root: {type: fixed, between: [ground, strip.left]}}
loads: {tip: {type: force, at: strip.right, force: [0, 0, "40*sin(30*t)"]}}
motion: {end: 0.2, step: 1e-3}
probes: {tip: {at: strip.right}}
)yaml";
}

}  // namespace

TEST_CASE(
    "products: fewer of them leave the error against the full-order model as it is, and the estimate sees those "
    "omitted") {
  const History full = move(strip("all"), Formulation::nlffr);
  double before = 0;
  for (const std::string products : {"all", "0.3 %", "1 %", "30 %"}) {
    const Estimated reduced = move_and_estimate(strip(products), Formulation::vm_md);
    const double error = vector_error(reduced.history, full, "tip");
    const double estimate = reduced.estimate.probes[0];
    const assembly::BodyReport& body = reduced.history.model.bodies[0];
    INFO(fmt::format("products {}: {} of {}, error {:.3g}, estimate {:.3g}", products, body.products,
                     body.products + body.omitted_products, error, estimate));
    CHECK(body.products + body.omitted_products == 105);
    CHECK((body.omitted_products == 0) == (products == "all"));
    CHECK(estimate == Approx(error).epsilon(0.1));
    if (products == "all")
      before = error;
    else if (products != "30 %")
      CHECK(std::abs(error - before) < 3e-4);
    else
      CHECK(error > 2 * before);
  }
  CHECK(before < 5e-3);
}

// The stiffness that a rotating beam gains by the force along it comes with products of two modes, which at small
// deformations of their own do next to nothing.
TEST_CASE("products: a spinning beam keeps its stiffness by rotation, however few there are") {
  const auto beam = [](const std::string& products) {
    return R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [8, 0, 0], elements: 16}}
    section: {shape: rectangle, width: 0.05, height: 0.02, orientation: [0, 0, 1]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 5, products: )yaml" +
           products + R"yaml(}
joints: {hub: {type: driven, between: [ground, beam.start], axis: [0, 0, 1], angle: "t^2"}}
loads: {flap: {type: force, at: beam.end, force: [0, 0, 5]}}
motion: {end: 1.5, step: 2e-3}
probes: {tip: {at: beam.end, quantity: deflection}}
)yaml";
  };
  const History full = move(beam("all"), Formulation::nlffr);
  const double all = vector_error(move(beam("all"), Formulation::vm_md), full, "tip");
  const double few = vector_error(move(beam("50 %"), Formulation::vm_md), full, "tip");
  INFO(fmt::format("error with all {:.3g}, with few {:.3g}", all, few));
  CHECK(few < 1.2 * all + 1e-3);
}

// Of a plate of 162 dofs 110 vectors with 6,105 products take 80 ms a step, and the full-order model 2.7 ms.
TEST_CASE("products: bases that are slower than full-order models are reported") {
  const auto reported = [](const std::string& reduction) {
    const auto model = assembly::build(scene::parse_scene(fill(R"yaml(
bodies:
  p:
    mesh: {plate: {along: [0.8, 0, 0], across: [0, 0.2, 0], elements: [8, 2], cells: quadrilaterals}}
    section: {thickness: 0.003}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    strains: second_order
    frame: mean-axis
    reduction: {modes: 4, $reduction}
motion: {end: 1, step: 1e-3}
)yaml",
                                                               {{"reduction", reduction}}),
                                                          "scene"),
                                       Formulation::vm_md, PETSC_COMM_WORLD);
    return std::any_of(model.warnings.begin(), model.warnings.end(), [](const std::string& line) {
      return line.find("full-order models (nlffr, cfr) can be faster") != std::string::npos;
    });
  };
  CHECK(reported("derivatives: all, interface: [left, p3]"));
  CHECK_FALSE(reported("derivatives: all"));
}
