#include <fmt/format.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "floe/scene/places.h"
#include "floe/scene/scene.h"

using namespace floe::scene;

namespace {

/// Formulas of time at t = 0.
Point at_start(const std::array<floe::math::Formula, 3>& f) { return {f[0](0), f[1](0), f[2](0)}; }

// Every key once, none at its default.
const char* full = R"yaml(
title: Everything
parameters: {L: 4, half: L/2, F: 2.5e3}
gravity: [0, -9.81]
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [L, 0], elements: 2*6}}
    section: {A: 70, I: 585}
    material: {E: 16000, rho: 0.0078}
    strain: pointwise
    rotary_inertia: false
    frame: {type: pinned, from: middle, to: [L, 0]}
    reduction:
      modes: {count: 5, of: frame, alone: 7}
      derivatives: [[1, 1], [1, 5]]
      derivative_type: full
      attachment: all
      drop_tolerance: 1e-5
      products: 2 %
    damping: {mass: 0.1, stiffness: 0.2, modal: [0.01, 0.02]}
    initial:
      position: [1, half]
      angle: pi/2
      velocity: [3, 4]
      angular_velocity: 5
      deformation: [0, "0.01*sin(pi*x/L)"]
      deformation_rate: [x*y, 1]
  arm:
    mesh: {segments: {points: [[0, 0], [1, 0], [1, 1]], join: [[2, 1], [2, 3]], elements: [3, 4]}}
    section: {EA: 1, EI: 2, rhoA: 3, rhoI: 4}
    frame: {type: clamped, at: p2}
    reduction: {modes: 3, derivatives: 4}
  stone:
    rigid: true
    mesh: {polyline: {points: [[0, 0], [1, 0], [1, 1]], elements: 2}}
    section: {rhoA: 3}
joints:
  a: {type: prismatic, between: [ground, beam.start], axis: [0, 1]}
  b: {type: spring, between: [beam.end, {body: arm, node: [1, 0]}], stiffness: 1, viscosity: 2, length: 3,
      torsional_stiffness: 4, torsional_viscosity: 5}
  c: {type: driven, between: [{body: ground, node: [0, 0]}, stone.start], angle: F*t}
loads:
  a: {type: force, at: beam.end, force: [0, "F*sin(9.5*t)"], axes: body}
  b: {type: moment, at: beam.start, moment: "triangle(t, 1, 1)"}
  c: {type: distributed, body: arm, force: [t, 2]}
motion: {end: 3, step: 1e-3, spectral_radius: 0.5, tolerance: 1e-4, every: 10}
probes:
  tip: {at: beam.end, quantity: velocity}
)yaml";

const char* small = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1, EI: 1, rhoA: 1}
motion: {end: 1, step: 0.1}
)yaml";

}  // namespace

TEST_CASE("a body is read as it stands") {
  const Scene scene = parse_scene(full, "full.yaml");
  REQUIRE(scene.bodies.size() == 3);
  const Body& beam = scene.bodies[0];
  CHECK(scene.title == "Everything");
  CHECK(scene.parameters.at("half") == 2);
  CHECK(at_start(scene.gravity) == Point{0, -9.81, 0});
  CHECK(scene.text == full);
  CHECK(beam.name == "beam");
  CHECK(beam.mesh.points == std::vector<Point>{{0, 0, 0}, {4, 0, 0}});
  CHECK(beam.mesh.elements == std::vector<int>{12});
  CHECK(beam.section.EA == 16000.0 * 70);
  CHECK(beam.section.EI == 16000.0 * 585);
  CHECK(beam.section.rhoA == 0.0078 * 70);
  CHECK(beam.section.rhoI == 0.0078 * 585);
  CHECK(beam.strain == Strain::pointwise);
  CHECK_FALSE(beam.rotary_inertia);
  CHECK(beam.frame.kind == FrameSpec::Kind::pinned);
  CHECK(place_point(beam.mesh, beam.frame.from) == Point{2, 0, 0});
  CHECK(place_point(beam.mesh, beam.frame.to) == Point{4, 0, 0});
  CHECK(beam.damping.modal == std::vector<double>{0.01, 0.02});
  CHECK(beam.initial.position == Point{1, 2, 0});
  CHECK(beam.initial.angle == Approx(1.5707963267948966).epsilon(1e-15));
  CHECK((*beam.initial.deformation)[1](2, 0) == Approx(0.01));
  CHECK((*beam.initial.deformation_rate)[0](2, 3) == 6);
  CHECK(beam.where.text() == "full.yaml:6:3: bodies.beam");
}

TEST_CASE("reductions, other meshes and rigid bodies are read as they stand") {
  const Scene scene = parse_scene(full, "full.yaml");
  const ReductionSpec& reduction = scene.bodies[0].reduction;
  CHECK(reduction.modes.count == 5);
  CHECK(reduction.modes.of == ModesSpec::Of::frame);
  CHECK(reduction.modes.alone == 7);
  CHECK(reduction.derivatives.choice == DerivativesSpec::Choice::pairs);
  CHECK(reduction.derivatives.pairs == std::vector<std::array<int, 2>>{{1, 1}, {1, 5}});
  CHECK(reduction.derivatives.full);
  CHECK(reduction.attachment == ReductionSpec::Attachment::all);
  CHECK(reduction.drop_tolerance == 1e-5);
  CHECK(reduction.products == 0.02);
  const Body& arm = scene.bodies[1];
  CHECK(arm.mesh.segments == std::vector<std::array<int, 2>>{{1, 0}, {1, 2}});
  CHECK(arm.mesh.elements == std::vector<int>{3, 4});
  CHECK(arm.section.rhoI == 4);
  CHECK(arm.frame.kind == FrameSpec::Kind::clamped);
  CHECK(arm.frame.at.name == "p2");
  CHECK(arm.reduction.modes.count == 3);
  CHECK(arm.reduction.derivatives.choice == DerivativesSpec::Choice::count);
  CHECK(arm.reduction.derivatives.count == 4);
  CHECK(scene.bodies[2].rigid);
  CHECK(scene.bodies[2].mesh.elements == std::vector<int>{2, 2});
  CHECK(scene.bodies[2].section.EA == 0);
}

TEST_CASE("joints, loads, motion and probes are read as they stand") {
  const Scene scene = parse_scene(full, "full.yaml");
  CHECK(scene.joints[0].kind == Joint::Kind::prismatic);
  CHECK(scene.joints[0].first.ground());
  CHECK_FALSE(scene.joints[0].first.point);
  CHECK(scene.joints[0].axis == Point{0, 1, 0});
  CHECK(scene.joints[1].stiffness == 1);
  CHECK(scene.joints[1].viscosity == 2);
  CHECK(scene.joints[1].length == 3.0);
  CHECK(scene.joints[1].torsional_stiffness == 4);
  CHECK(scene.joints[1].torsional_viscosity == 5);
  CHECK(scene.joints[1].second.point == Point{1, 0, 0});
  CHECK(scene.joints[2].first.point == Point{0, 0, 0});
  CHECK(scene.joints[2].angle(2) == 5000);
  CHECK(scene.loads[0].force[1](0.1) == Approx(2500 * std::sin(0.95)).epsilon(1e-15));
  CHECK(scene.loads[0].axes == Load::Axes::body);
  CHECK(scene.loads[1].moment[2](0.5) == 0.5);
  CHECK(scene.loads[2].body == "arm");
  CHECK(scene.motion.spectral_radius == 0.5);
  CHECK(scene.motion.tolerance == 1e-4);
  CHECK(scene.motion.every == 10);
  CHECK(scene.probes[0].quantity == Probe::Quantity::velocity);
  CHECK(scene.probes[0].at.where.text() == "full.yaml:48:13: probes.tip.at");
}

// The grammar's defaults and those of the plain data agree, so that a Scene made in code is one read from a file.
TEST_CASE("what is absent takes the defaults of the data") {
  const Scene scene = parse_scene(small, "small.yaml"), fresh;
  const Body &beam = scene.bodies[0], none;
  CHECK(at_start(scene.gravity) == at_start(fresh.gravity));
  CHECK(beam.strain == none.strain);
  CHECK(beam.rotary_inertia == none.rotary_inertia);
  CHECK(beam.rigid == none.rigid);
  CHECK(beam.frames == none.frames);
  CHECK(beam.frame.kind == none.frame.kind);
  CHECK(beam.frame.from.name == "start");
  CHECK(beam.frame.to.name == "end");
  CHECK(beam.section.rhoI == 0);
  CHECK(beam.reduction.modes.count == none.reduction.modes.count);
  CHECK(beam.reduction.modes.of == none.reduction.modes.of);
  CHECK(beam.reduction.modes.alone == none.reduction.modes.alone);
  CHECK(beam.reduction.derivatives.choice == none.reduction.derivatives.choice);
  CHECK(beam.reduction.attachment == none.reduction.attachment);
  CHECK(beam.reduction.drop_tolerance == none.reduction.drop_tolerance);
  CHECK_FALSE(beam.reduction.products);
  CHECK(beam.damping.stiffness == none.damping.stiffness);
  CHECK(beam.initial.position == none.initial.position);
  CHECK_FALSE(beam.initial.deformation);
  CHECK(scene.motion.spectral_radius == fresh.motion.spectral_radius);
  CHECK_FALSE(scene.motion.tolerance);
  CHECK(scene.motion.every == fresh.motion.every);
}

TEST_CASE("the default count of modes is no more than the mesh has elastic dofs") {
  std::string text = small;
  text.replace(text.find("elements: 4"), 11, "elements: 1");
  CHECK(parse_scene(text, "one.yaml").bodies[0].reduction.modes.count == 3);
}

TEST_CASE("an alias stands for the value that it names") {
  std::string text = small;
  text.replace(text.find("EA: 1"), 5, "EA: &stiff 7");
  text.replace(text.find("EI: 1"), 5, "EI: *stiff");
  CHECK(parse_scene(text, "alias.yaml").bodies[0].section.EI == 7);
}

// Values of the paper's cantilever: EA, EI, rhoA, rhoI from L=100 A=70 I=585 E=16000 rho=0.0078.
TEST_CASE("the examples are read") {
  const Scene cantilever = read_scene("examples/cantilever/scene.yaml");
  CHECK(cantilever.bodies[0].section.EA == Approx(1.12e6));
  CHECK(cantilever.bodies[0].section.EI == Approx(9.36e6));
  CHECK(cantilever.bodies[0].section.rhoA == Approx(0.546));
  CHECK(cantilever.bodies[0].section.rhoI == Approx(4.563));
  CHECK(cantilever.loads[0].force[1](0.2) == Approx(2500 * std::sin(1.9)));
  const Scene arm = read_scene("examples/robot_arm/scene.yaml");
  CHECK(arm.loads[0].moment[2](2.5) == 80);
  CHECK(arm.loads[0].moment[2](7) == 0);
  CHECK(arm.bodies[0].section.rhoI == 1.0 / 48);
  CHECK(read_scene("examples/blade/scene.yaml").dimension == 3);
  const Scene spin = read_scene("examples/spin_up/scene.yaml");
  CHECK(spin.joints[0].angle(15) == Approx(45));  // Om Ts/2
  CHECK(spin.joints[0].angle.derivative(20) == Approx(6));
  CHECK(spin.joints[0].angle.derivative(7.5) == Approx(3));  // Om/Ts (t - Ts/(2 pi) sin(2 pi t/Ts))
  CHECK(read_scene("examples/pendulum/scene.yaml").gravity[1](0) == -9.81);
  const Scene crank = read_scene("examples/slider_crank/scene.yaml");
  CHECK(crank.bodies.size() == 3);
  CHECK(crank.bodies[2].section.rhoA * total_length(crank.bodies[2].mesh) == Approx(0.033378));
  CHECK(crank.bodies[1].initial.angular_velocity[2] == Approx(-75));
}

TEST_CASE("drives by speed, limits, gravity of time and a ground that shakes") {
  const Scene scene = parse_scene(R"yaml(
gravity: [0, "-9.81*(1 + t)"]
ground: {acceleration: ["2*t", 0]}
bodies: {arm: {mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}, section: {EA: 1, EI: 1, rhoA: 1}}}
joints:
  motor: {type: driven, between: [ground, arm.start], speed: "3*t"}
  stop: {type: revolute, between: [{body: ground, node: [1, 0]}, arm.end], limits: {upper: 0.5, stiffness: 4, damping: 2}}
)yaml",
                                  "new.yaml");
  CHECK(scene.gravity[1](1) == Approx(-19.62));
  CHECK(scene.ground_acceleration[0](2) == 4);
  REQUIRE(scene.joints[0].speed);
  CHECK((*scene.joints[0].speed)(2) == 6);
  REQUIRE(scene.joints[1].limits);
  const LimitsSpec& limits = *scene.joints[1].limits;
  CHECK(limits.upper == 0.5);
  CHECK(limits.lower == -INFINITY);
  CHECK(limits.stiffness == 4);
  CHECK(limits.damping == 2);
  CHECK_FALSE(limits.width);
  CHECK_FALSE(scene.joints[0].limits);
}

TEST_CASE("accuracy: of the total, or of the reduction alone") {
  const auto read = [](const std::string& accuracy) {
    return parse_scene("accuracy: " + accuracy + R"yaml(
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
motion: {end: 1, step: 1e-3}
probes: {tip: {at: rod.end}}
)yaml",
                       "scene")
        .accuracy;
  };
  CHECK(read("1 %")->share == Approx(0.01));
  CHECK(read("1 %")->total);
  CHECK(read("{reduction: 2 %}")->share == Approx(0.02));
  CHECK_FALSE(read("{reduction: 2 %}")->total);
  CHECK_THROWS_WITH(read("{reduce: 2 %}"), Catch::Contains("reduction"));
  CHECK_THROWS_WITH(read("{reduction: 200 %}"), Catch::Contains("0 < value < 1"));
  CHECK(accuracy_of("reduction: 1%").share == Approx(0.01));
  CHECK_FALSE(accuracy_of("reduction:1%").total);
  CHECK(accuracy_of("0.01").total);
}

TEST_CASE("periodic tables whose ends differ by round-off are closed") {
  const auto table = [](const std::string& last) {
    return parse_scene(
        "functions: {f: {t: [0, 1, 2], values: [0, 3, " + last +
            "], periodic: true}}\n"
            "bodies: {b: {mesh: {line: {from: [0, 0], to: [1, 0], elements: 1}}, section: {EA: 1, EI: 1, rhoA: 1}}}\n"
            "loads: {l: {type: force, at: b.end, force: [0, f(t)]}}\nmotion: {end: 2, step: 0.1}\n",
        "s.yaml");
  };
  CHECK(table("-7e-16").loads[0].force[1](2) == 0);
  CHECK_THROWS_WITH(table("1e-9"), Catch::Contains("expected equal values at both ends of a period"));
}

TEST_CASE("functions of a scene: formulas and tables, from the scene and from a file") {
  const std::filesystem::path scratch =
      std::filesystem::temp_directory_path() / fmt::format("floe-functions-{}", getpid());
  std::filesystem::create_directories(scratch);
  std::ofstream(scratch / "gust.csv") << "# station 3\nt [s]; ignored; gust\n0; 7; 1\n\n0.5; 7; +2e0\n1 ; 8; 4\r\n";
  const std::string text = R"yaml(
parameters: {F: 10}
functions:
  start: smooth(t, 0, 1)
  gust: {file: gust.csv, column: 3}
  both: F*gust(t)*start(t)
bodies: {beam: {mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}, section: {EA: 1e4, EI: 10, rhoA: 1}}}
loads: {tip: {type: force, at: beam.end, force: [0, both(t)]}}
motion: {end: 2, step: 0.1}
)yaml";
  const Scene scene = parse_scene(text, (scratch / "scene.yaml").string());
  const auto& force = scene.loads[0].force[1];
  CHECK(force(0.5) == Approx(10 * 2 * 0.5));
  CHECK(force(0.75) == Approx(10 * 3 * (6 * std::pow(0.75, 5) - 15 * std::pow(0.75, 4) + 10 * std::pow(0.75, 3))));
  CHECK(force(2) == 40);
  CHECK(force.derivative(1.5) == 0);
  // a mark of UTF-8 is no header, and nothing that looks like data is skipped
  const auto written = [&](const std::string& file) {
    std::ofstream(scratch / "gust.csv") << file;
    return parse_scene(text, (scratch / "scene.yaml").string()).loads[0].force[1](2);
  };
  CHECK(written("\xef\xbb\xbf"
                "0, 1, 100\n1, 1, 200\n") == 2000);
  CHECK_THROWS_WITH(written("0,5;1,2;3\n1,5;2,2;4\n"), Catch::Contains("line 1: column 1 is \"0,5\""));
  CHECK_THROWS_WITH(written("t,a,b\n0,1,\n1,1,7\n"), Catch::Contains("line 2: column 3 is \"\""));
  CHECK_THROWS_WITH(written("0,1,nan\n1,1,7\n"), Catch::Contains("line 1: column 3 is \"nan\""));
  CHECK_THROWS_WITH(written("t b\nseconds m\n1 1 7\n"), Catch::Contains("line 2"));
  std::filesystem::remove_all(scratch);
}
