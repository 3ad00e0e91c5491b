#include <catch2/catch.hpp>

#include "estimated.h"
#include "floe/assess/validity.h"
#include "paper_cantilever.h"

using namespace floe;
using namespace floe::test;

namespace {

std::vector<assess::OutOfRange> judged(const std::string& text, Formulation formulation) {
  const scene::Scene scene = scene::parse_scene(text, "scene");
  const assembly::Model model = assembly::build(scene, formulation, PETSC_COMM_WORLD, true);
  assess::KeptMotion kept(model, 100);
  solve::simulate(*model.system, {scene.motion.end, scene.motion.step, scene.motion.spectral_radius, {}}, model.U,
                  model.V, [&](const solve::Instant& at) { kept.keep(at); });
  std::string unchecked;
  const auto found = assess::out_of_range(scene, model, kept, PETSC_COMM_WORLD, unchecked);
  CHECK(unchecked.empty());
  return found;
}

/// What the lines are about, with their number.
std::map<std::string, double> said(const std::vector<assess::OutOfRange>& lines) {
  std::map<std::string, double> all;
  for (const auto& line : lines) {
    CHECK(line.value > line.limit);
    CHECK(line.text.find(line.of) != std::string::npos);
    all[line.what] = line.value;
  }
  return all;
}

/// A beam on a hub that rotates at constant speed; its first frequency is 3.516 rad/s.
std::string rotating(const std::string& speed, const std::string& reduction) {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    frame: {type: clamped, at: start}
    reduction: $reduction
    initial: {angular_velocity: $speed}
joints: {hub: {type: driven, between: [ground, beam.start], angle: $speed*t}}
motion: {end: 1, step: 1e-2}
probes: {tip: {at: beam.end, quantity: deflection}}
)yaml",
              {{"speed", speed}, {"reduction", reduction}});
}

/// A cantilever whose tip force grows to bend it by slopes of about F/2.
std::string bent(const std::string& frame, const std::string& force, const std::string& step = "2e-2") {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 10}}
    section: {EA: 1e5, EI: 1, rhoA: 1e-2}
    frame: $frame
    reduction: {modes: 5}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "$force*(1 - cos(pi*t/2))/2"]}}
motion: {end: 2, step: $step}
probes: {tip: {at: beam.end}}
)yaml",
              {{"frame", frame}, {"force", force}, {"step", step}});
}

}  // namespace

TEST_CASE("validity: spin relative to the first frequency, without centrifugal stiffening") {
  const auto vm = said(judged(rotating("1.5", "{modes: {count: 2, alone: 2}}"), Formulation::vm));
  REQUIRE(vm.count("spin"));
  CHECK(vm.at("spin") == Approx(1.5 / 3.516).epsilon(1e-2));
  CHECK(said(judged(rotating("1.5", "{modes: 2}"), Formulation::lffr)).count("spin"));
  CHECK_FALSE(said(judged(rotating("1.5", "{modes: 2}"), Formulation::vm_md)).count("spin"));
  CHECK_FALSE(said(judged(rotating("0.5", "{modes: {count: 2, alone: 2}}"), Formulation::vm)).count("spin"));
}

TEST_CASE("validity: slopes relative to their frame") {
  const std::string tangent = "{type: clamped, at: start}";
  const auto lines = said(judged(bent(tangent, "1.6"), Formulation::vm_md));
  REQUIRE(lines.count("slope"));
  CHECK(lines.at("slope") == Approx(0.11).epsilon(0.4));  // .424 for .533 of the length at rest (elastica)
  CHECK_FALSE(
      said(judged(bent("pinned", "1.6"), Formulation::vm_md)).count("slope"));  // half of it in the chord's frame
  CHECK_FALSE(said(judged(bent(tangent, "0.5"), Formulation::vm_md)).count("slope"));
}

TEST_CASE("validity: a linear elastic force has no foreshortening, and modes alone stretch the body") {
  const auto linear = said(judged(bent("{type: clamped, at: start}", "1.6"), Formulation::lffr));
  REQUIRE(linear.count("shortening"));
  CHECK(linear.at("shortening") == Approx(0.32).epsilon(0.2));
  CHECK(said(judged(bent("{type: clamped, at: start}", "1.6"), Formulation::vm)).count("membrane"));
  CHECK_FALSE(said(judged(bent("{type: clamped, at: start}", "1.6"), Formulation::vm_md)).count("membrane"));
}

// Tension strains a bar linearly: no locking, whatever its ratio to the bending energy.
// Clamped at both ends and of two elements: three modes are all there is, and derivatives are within their span.
TEST_CASE("validity: derivatives within the span of the modes are not missing") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}
    section: {EA: 1e5, EI: 1, rhoA: 1e-2}
    reduction: {modes: 3, derivatives: $derivatives}
joints:
  a: {type: fixed, between: [ground, beam.start]}
  b: {type: fixed, between: [ground, beam.end]}
loads: {f: {type: force, at: beam.middle, force: [0, "20*smooth(t, 0, 1)"]}}
motion: {end: 1, step: 2e-2}
probes: {middle: {at: beam.middle}}
)yaml";
  CHECK(said(judged(fill(text, {{"derivatives", "none"}}), Formulation::vm_md)).count("membrane"));
  CHECK_FALSE(said(judged(fill(text, {{"derivatives", "all"}}), Formulation::vm_md)).count("membrane"));
}

TEST_CASE("validity: tension of a body of modes alone is no membrane locking") {
  std::string text = bent("pinned", "100");
  const std::string across = "force: [0, \"100*(1 - cos(pi*t/2))/2\"]";
  REQUIRE(text.find(across) != std::string::npos);
  text.replace(text.find(across), across.size(), "force: [\"100*(1 - cos(pi*t/2))/2\", 1e-3]");
  const auto lines = said(judged(text, Formulation::vm));
  CHECK_FALSE(lines.count("membrane"));
}

TEST_CASE("validity: load frequencies relative to those of the modes, and the step relative to the periods") {
  const auto fast =
      said(judged(text_of({.end = "0.5", .reduction = "{modes: 2, derivatives: all}"}), Formulation::vm_md));
  REQUIRE(fast.count("load"));  // cos(9.5 t) under modes to 9.0 rad/s
  CHECK(fast.at("load") == Approx(9.5 / 9.0).epsilon(0.15));
  CHECK_FALSE(fast.count("step"));
  CHECK(said(judged(text_of({.end = "1.5", .step = "5e-2"}), Formulation::vm_md)).count("step"));
}

// A plate that falls freely does not deform: what its nodes move by in its frame is round-off.
TEST_CASE("validity: no warning of deformations that are round-off") {
  const std::string text = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [8, 4]}}
    section: {thickness: 1e-3}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 3}
motion: {end: 0.1, step: 1e-3}
probes: {tip: {at: plate.p3}}
)yaml";
  for (const auto formulation : {Formulation::nlffr, Formulation::vm_md}) CHECK(judged(text, formulation).empty());
}

TEST_CASE("validity: gravity, ground acceleration and pressure have spectra as loads have") {
  // Two modes of a cantilever, to 22.0 rad/s; the excitation at 60 rad/s.
  const auto shaken = [](const std::string& excitation) {
    return said(judged(excitation + R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: 2}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
motion: {end: 0.5, step: 1e-3}
)yaml",
                       Formulation::vm_md));
  };
  for (const char* key : {"gravity: ", "ground:\n  acceleration: "}) {
    const auto lines = shaken(key + std::string("[0, 9.81*sin(60*t)]\n"));
    REQUIRE(lines.count("load"));
    CHECK(lines.at("load") == Approx(60 / 22.03).epsilon(0.05));
  }
  CHECK_FALSE(shaken("gravity: [0, -9.81]\n").count("load"));
  // The ratio of root mean squares: a constant part counts as what it is.
  CHECK_FALSE(shaken("gravity: [0, -9.81 + 0.1*sin(60*t)]\n").count("load"));

  const auto blown = said(judged(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [8, 4]}}
    section: {thickness: 0.02}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 1}
joints: {root: {type: fixed, between: [ground, plate.left]}}
loads: {gust: {type: pressure, body: plate, pressure: 10*sin(200*t)}}
motion: {end: 0.1, step: 1e-3}
)yaml",
                                 Formulation::vm_md));
  REQUIRE(blown.count("load"));
  CHECK(blown.at("load") == Approx(200 / 26.5).epsilon(0.1));  // f1 = 4.217 Hz (Leissa's plate, converged)
}

TEST_CASE("validity: a load without a finite rate between steps is excluded from the spectra") {
  const auto lines = said(judged(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: 2}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads:
  kink: {type: force, at: beam.end, force: [0, "sqrt(abs(t - 0.25/2000))"]}  # the first time that is looked at
  fast: {type: force, at: beam.end, force: [0, "0.01*sin(60*t)"]}
motion: {end: 0.5, step: 1e-3}
)yaml",
                                 Formulation::vm_md));
  CHECK(lines.count("load"));
}

namespace {

/// A plate of 12 by 4 cells, 1 m long and so wide, under its weight. nu = 0: it bends as a beam of unit stiffness.
std::string wide(double width) {
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, $width, 0], elements: [12, 4]}}
    section: {thickness: 1e-3}
    material: {E: 12e9, nu: 0, rho: 1e3}
    reduction: {modes: 3}
joints: {root: {type: fixed, between: [ground, plate.left]}}
gravity: [0, 0, "1e-3*t"]
motion: {end: 1, step: 2e-2}
probes: {tip: {at: plate.p3}}
)yaml",
              {{"width", fmt::format("{}", width)}});
}

}  // namespace

TEST_CASE("elements wider than their plate is long: warnings in simulations, equilibria and modes", "[range]") {
  for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr}) {
    CHECK(said(judged(wide(1), formulation)).count("mesh") == 0);
    CHECK(said(judged(wide(20), formulation)).at("mesh") > 0.3);
  }
  for (const double width : {1, 20}) {
    const scene::Scene scene = scene::parse_scene(wide(width), "scene");
    const auto reports = assembly::body_modes(scene, PETSC_COMM_WORLD);
    CHECK((reports[0].intra_deflection[0] > assembly::max_intra_deflection_of_modes) == (width > 1));
    const assembly::Model model = assembly::build(scene, Formulation::vm_md, PETSC_COMM_WORLD);
    const bool told = std::any_of(model.warnings.begin(), model.warnings.end(), [](const std::string& line) {
      return line.find("mode 1") != std::string::npos && line.find("intra-element deflection") != std::string::npos;
    });
    CHECK(told == (width > 1));
  }
}
