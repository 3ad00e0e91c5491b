#include <catch2/catch.hpp>

#include "floe/assembly/reduced_bodies_file.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// L = EI = rhoA = 1, hinged, plucked into its first mode with an amplitude that is linear: omega = pi^2.
History plucked(Formulation formulation, const std::string& damping) {
  return move(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    reduction: {modes: 3, derivatives: all}
    damping: {$damping}
    initial: {deformation: [0, "1e-5*sin(pi*x)"]}
joints:
  left: {type: revolute, between: [ground, beam.start]}
  right: {type: revolute, between: [ground, beam.end]}
motion: {end: 2, step: 1e-3, spectral_radius: 0.99}
probes: {middle: {at: beam.middle}}
)yaml",
                   {{"damping", damping}}),
              formulation);
}

/// L = EI = rhoA = 1, clamped at the left by a joint and let go from the shape of a tip force 1e-3 that has grown
/// slowly: the first mode, almost alone.
History let_go(const std::string& frame) {
  return move(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 12}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    frame: $frame
    reduction: {modes: 1, derivatives: none, attachment: none}
    damping: {modal: [0.02]}
joints: {root: {type: fixed, between: [ground, beam.start]}}
loads: {pull: {type: force, at: beam.end, force: [0, "t < 0.5 ? 1e-3 : 0"]}}
motion: {end: 10, step: 5e-3, spectral_radius: 0.99}
probes: {tip: {at: beam.end}}
)yaml",
                   {{"frame", frame}}),
              Formulation::vm_md);
}

/// ln(x_0 / x_n) / sqrt((n pi)^2 + ln^2) over the extremes of `x` after a time: the ratio of a decaying oscillation.
double ratio_of_decay(const std::vector<double>& t, const std::vector<double>& x, double from = 1) {
  std::vector<double> extremes;
  for (std::size_t i = 1; i + 1 < x.size(); ++i)
    if (t[i] > from && std::abs(x[i]) > std::abs(x[i - 1]) && std::abs(x[i]) >= std::abs(x[i + 1]))
      extremes.push_back(std::abs(x[i]));
  REQUIRE(extremes.size() > 4);
  const double logarithm = std::log(extremes.front() / extremes.back());
  return logarithm / std::hypot(logarithm, M_PI * double(extremes.size() - 1));
}

/// x(t)/x(0) = e^(-z w t) (cos wd t + z w/wd sin wd t), wd = w sqrt(1 - z^2).
void check_decay(const History& at, double ratio) {
  const double w = M_PI * M_PI, wd = w * std::sqrt(1 - ratio * ratio);
  double worst = 0;
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    const double t = at.t[i];
    const double x = std::exp(-ratio * w * t) * (std::cos(wd * t) + ratio * w / wd * std::sin(wd * t));
    worst = std::max(worst, std::abs((at["middle.y"][i] + 1e-5) / 1e-5 - x));
  }
  CHECK(worst < 5e-4);
}

/// A beam with L = EI = rhoA = 1 in the plane, or in space (a rectangle that bends in x, y).
std::string unit_beam(int dimension, const std::string& rest) {
  const double height = 0.04, E = 12 / std::pow(height, 4), rho = 1 / (height * height);
  const bool space = dimension == 3;
  return fill(
      R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0$z], to: [1, 0$z], elements: 20}}
    $section$rest)yaml",
      {{"rest", rest},
       {"section", space ? fmt::format("section: {{shape: rectangle, width: {}, height: {}, orientation: [0, 0, "
                                       "1]}}\n    material: {{E: {}, nu: 0.3, rho: {}}}",
                                       height, height, number(E), number(rho))
                         : "section: {EA: 7500, EI: 1, rhoA: 1}"},
       {"z", space ? ", 0" : ""}});
}

struct Held {
  std::string name, shape, joint;  ///< its first mode, amplitude about 1
  double omega;
};

/// First modes of beams of unit constants (Blevins, Formulas for natural frequency and mode shape, table 8-1).
std::vector<Held> ways_to_hold(int dimension) {
  const std::string axis = dimension == 3 ? ", axis: [0, 0, 1]" : "";
  const double b = 1.875104068711961, c = 3.926602312047919, f = 4.730040744862704;
  const double s_b = (std::cosh(b) + std::cos(b)) / (std::sinh(b) + std::sin(b)),
               s_f = (std::cosh(f) - std::cos(f)) / (std::sinh(f) - std::sin(f));
  const auto shape = [](const std::string& text, double k, double s) {
    return fill(text, {{"k", number(k)}, {"s", number(s)}});
  };
  return {{"clamped", shape("cosh($k*x) - cos($k*x) - $s*(sinh($k*x) - sin($k*x))", b, s_b),
           "{type: fixed, between: [ground, beam.start]}", b * b},
          {"hinged", shape("sin($k*x) + $s*sinh($k*x)", c, std::sin(c) / std::sinh(c)),
           "{type: revolute, between: [ground, beam.start]" + axis + "}", c * c},
          {"free", shape("cosh($k*x) + cos($k*x) - $s*(sinh($k*x) + sin($k*x))", f, s_f), "", f * f}};
}

/// Some ten half periods of the first mode, with alpha = 0.1 omega or modal ratios. @param rest  more of the body
History vibrating(int dimension, const Held& constrained, const std::string& frame, Formulation formulation,
                  const std::string& rest = "", const std::string& ratios = "") {
  const std::string z = dimension == 3 ? ", 0" : "";
  return move(unit_beam(dimension,
                        fill(R"yaml(
    frame: $frame
    $rest
    damping: {$damping}
    reduction: {modes: $modes, derivatives: none, attachment: none}
    initial: {deformation: [0, "1e-5*($shape)"$z]}
$joints
motion: {end: $end, step: $step, spectral_radius: 0.99}
probes: {tip: {at: beam.end, quantity: position}}
)yaml",
                             {{"frame", frame},
                              {"rest", rest},
                              {"damping", ratios.empty() ? "mass: " + number(0.1 * constrained.omega) : ratios},
                              {"modes", dimension == 3 ? "6" : "3"},
                              {"shape", constrained.shape},
                              {"z", z},
                              {"joints", constrained.joint.empty() ? "" : "joints: {root: " + constrained.joint + "}"},
                              {"end", number(33 / constrained.omega)},
                              {"step", number(0.02 / constrained.omega)}})),
              formulation);
}

/// Of a cantilever with EI = 1.67, bent to a third of its length and let go: the last extreme of its tip, a mean over
/// the times when frames differ little.
double last_extreme(const std::string& frames, const std::string& modes, Formulation formulation,
                    const std::string& frame = "pinned") {
  const History at = move(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 20}}
    section: {EA: 2e4, EI: 1.67, rhoA: 0.16}
    damping: {stiffness: 1e-3}
    frame: $condition
    frames: $frames
    reduction: {modes: $modes, derivatives: all}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "t < 1 ? 2*(1 - cos(pi*t))/2 : 0"]}}
motion: {end: 3, step: 2e-3}
probes: {tip: {at: beam.end}}
)yaml",
                               {{"condition", frame}, {"frames", frames}, {"modes", modes}}),
                          formulation);
  const std::vector<double>& y = at["tip.y"];
  double last = 0;
  for (std::size_t i = 1; i + 1 < y.size(); ++i)
    if (y[i] < y[i - 1] && y[i] <= y[i + 1]) last = -y[i];
  return last;
}

}  // namespace

TEST_CASE("damping: decay of one mode, modal") {
  for (const Formulation formulation : {Formulation::vm_md, Formulation::vm, Formulation::nlffr, Formulation::lffr}) {
    INFO(name_of(formulation));
    check_decay(plucked(formulation, "modal: [0.03]"), 0.03);
  }
}

TEST_CASE("damping: ratios of other modes do not affect the first") {
  for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr})
    check_decay(plucked(formulation, "modal: [0, 0.5, 0.5]"), 0);
}

// A mode of the body as its joints hold it has the frame's rigid motion in it, another one in each frame.
TEST_CASE("damping: a mode's ratio is the same in every frame") {
  for (const std::string frame : {"{type: clamped, at: start}", "pinned", "mean-axis"}) {
    INFO(frame);
    const History tip = let_go(frame);
    CHECK(ratio_of_decay(tip.t, tip["tip.y"]) == Approx(0.02).epsilon(0.01));
  }
}

// In space two modes have the same frequency: both are damped.
TEST_CASE("damping: modal, in full-order models as in reduced ones") {
  const int dimension = GENERATE(2, 3);
  for (const Held& constrained : ways_to_hold(dimension))
    for (const std::string frame : {"pinned", "{type: clamped, at: start}", "mean-axis"})
      for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr}) {
        INFO(dimension << " " << constrained.name << " " << frame << " " << name_of(formulation));
        const History at = vibrating(dimension, constrained, frame, formulation, "", "modal: [0.05, 0.05]");
        CHECK(ratio_of_decay(at.t, at["tip.y"], 0) == Approx(0.05).epsilon(0.005));
      }
}

TEST_CASE("damping: modal, the same in any number of frames") {
  const int dimension = GENERATE(2, 3);
  const std::string frames = GENERATE("2", "4");
  for (const Held& constrained : ways_to_hold(dimension))
    for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr}) {
      INFO(dimension << " " << constrained.name << " " << frames << " frames, " << name_of(formulation));
      const History at =
          vibrating(dimension, constrained, "pinned", formulation, "frames: " + frames, "modal: [0.05, 0.05]");
      CHECK(ratio_of_decay(at.t, at["tip.y"], 0) == Approx(0.05).epsilon(0.005));
    }
}

// Ratios in axes that accompany the body; a rigid rotation on the side is not damped.
TEST_CASE("damping: modal, in corotational elements") {
  const int dimension = GENERATE(2, 3);
  for (const Held& constrained : ways_to_hold(dimension)) {
    INFO(dimension << " " << constrained.name);
    const History at = vibrating(dimension, constrained, "pinned", Formulation::cfr, "", "modal: [0.05, 0.05]");
    // in space frequencies and modal masses are low by the square of the element's length
    CHECK(ratio_of_decay(at.t, at["tip.y"], 0) == Approx(0.05).epsilon(dimension == 3 ? 0.01 : 0.005));
  }
}

TEST_CASE("damping: modal, no rigid motion is damped in corotational elements") {
  const int dimension = GENERATE(2, 3);
  const History at = move(
      unit_beam(dimension, fill(R"yaml(
    damping: {modal: [0.5, 0.5, 0.5]}
    reduction: {modes: 6}
    initial: {$start}
motion: {end: 20, step: 1e-2, spectral_radius: 0.99}
probes: {tip: {at: beam.end, quantity: position}}
)yaml",
                                {{"start", dimension == 3 ? "velocity: [0.01, 0, 0.02], angular_velocity: [0, 0.1, 0.2]"
                                                          : "velocity: [0.01, 0.02], angular_velocity: 0.2"}})),
      Formulation::cfr);
  const auto total = [](const dynamics::Energy& e) { return e.kinetic + e.elastic + e.potential; };
  CHECK(total(at.energy.back()) == Approx(total(at.energy.front())).epsilon(1e-5));
}

// z = alpha / (2 w) of the modes of the body as its joints hold it, whatever frame measures the deformation.
TEST_CASE("damping: mass-proportional, the same in every frame and formulation") {
  const int dimension = GENERATE(2, 3);
  for (const Held& constrained : ways_to_hold(dimension))
    for (const std::string frame : {"pinned", "{type: clamped, at: start}", "mean-axis"})
      for (const Formulation formulation :
           {Formulation::vm_md, Formulation::vm, Formulation::nlffr, Formulation::lffr}) {
        INFO(dimension << " " << constrained.name << " " << frame << " " << name_of(formulation));
        const History at = vibrating(dimension, constrained, frame, formulation);
        CHECK(ratio_of_decay(at.t, at["tip.y"], 0) == Approx(0.05).epsilon(0.004));
      }
}

// Without a frame, and in several, it is the motion of the whole body less its rigid part that is damped.
TEST_CASE("damping: mass-proportional, in corotational elements") {
  const int dimension = GENERATE(2, 3);
  for (const Held& constrained : ways_to_hold(dimension)) {
    INFO(dimension << " " << constrained.name);
    const History at = vibrating(dimension, constrained, "pinned", Formulation::cfr);
    // in space nodes carry their mass rigidly: frequencies are low by the square of the element's length, 0.6 % here
    CHECK(ratio_of_decay(at.t, at["tip.y"], 0) == Approx(0.05).epsilon(dimension == 3 ? 0.008 : 0.001));
  }
}

TEST_CASE("damping: mass-proportional, the same in any number of frames") {
  const int dimension = GENERATE(2, 3);
  const std::string frames = GENERATE("2", "4", "10");
  for (const Held& constrained : ways_to_hold(dimension))
    for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr}) {
      INFO(dimension << " " << constrained.name << " " << frames << " frames, " << name_of(formulation));
      const History at = vibrating(dimension, constrained, "pinned", formulation, "frames: " + frames);
      CHECK(ratio_of_decay(at.t, at["tip.y"], 0) == Approx(0.05).epsilon(0.005));
    }
}

// The hub weighs a million times the beam: as if it were the ground.
TEST_CASE("damping: mass-proportional, of a beam on a moving body") {
  const Held constrained = ways_to_hold(2).front();
  const Formulation formulation = GENERATE(Formulation::vm_md, Formulation::nlffr, Formulation::cfr);
  const std::string frame = GENERATE("pinned", "mean-axis", "pinned\n    frames: 2");
  const History at = move(unit_beam(2, fill(R"yaml(
    frame: $frame
    damping: {mass: 0.35}
    reduction: {modes: 6, derivatives: all}
    initial: {velocity: [3, 0], deformation: [0, "1e-5*($shape)"]}
  hub:
    rigid: true
    mesh: {line: {from: [-1, 0], to: [0, 0], elements: 1}}
    section: {EA: 1, EI: 1, rhoA: 1e6}
    initial: {velocity: [3, 0]}
joints: {root: {type: fixed, between: [hub.end, beam.start]}}
motion: {end: 9, step: 5e-3, spectral_radius: 0.99}
probes: {tip: {at: beam.end, quantity: position}}
)yaml",
                                            {{"frame", frame}, {"shape", constrained.shape}})),
                          formulation);
  CHECK(ratio_of_decay(at.t, at["tip.y"], 0) == Approx(0.35 / (2 * constrained.omega)).epsilon(0.01));
  CHECK(at["tip.x"].back() == Approx(1 + 3 * 9).epsilon(1e-6));  // the flight is not damped
}

// On a slide across the beam its modes are those guided at one end, beta = 2.3650 / L, whatever the frame; those of the
// free beam damped them by 0.006. Of a fixed joint, by 0.003.
TEST_CASE("damping: modal, of a beam on a moving body") {
  const auto [joint, omega] = GENERATE(std::pair("fixed", 3.51602), std::pair("prismatic, axis: [0, 1]", 5.59332));
  const Formulation formulation = GENERATE(Formulation::vm_md, Formulation::nlffr, Formulation::cfr);
  const std::string frame = GENERATE("pinned", "clamped", "mean-axis", "pinned\n    frames: 2");
  CAPTURE(joint, name_of(formulation), frame);
  const History at = move(unit_beam(2, fill(R"yaml(
    frame: $frame
    damping: {modal: [0.05, 0.3, 0.3, 0.3, 0.3, 0.3]}
    reduction: {modes: 6, derivatives: all}
    initial: {velocity: [3, 0], deformation_rate: ["0", "1e-4*x^2"]}
  hub:
    rigid: true
    mesh: {line: {from: [-1, 0], to: [0, 0], elements: 1}}
    section: {EA: 1, EI: 1, rhoA: 1e6}
    initial: {velocity: [3, 0]}
joints: {root: {type: $joint, between: [hub.end, beam.start]}}
motion: {end: 9, step: 5e-3, spectral_radius: 0.99}
probes: {tip: {at: beam.end, quantity: position}, root: {at: beam.start, quantity: position}}
)yaml",
                                            {{"frame", frame}, {"joint", joint}})),
                          formulation);
  if (const auto& beam = at.model.bodies[0]; formulation == Formulation::vm_md && beam.whole == beam.name)
    CHECK((beam.damped.empty() ? beam.omega : beam.damped).at(0) == Approx(omega).epsilon(1e-3));
  std::vector<double> bent = at["tip.y"];
  for (std::size_t i = 0; i < bent.size(); ++i) bent[i] -= at["root.y"][i];
  CHECK(ratio_of_decay(at.t, bent) == Approx(0.05).epsilon(0.02));
  CHECK(std::abs(at["tip.x"].back() - 1 - 3 * 9) < 1e-5);
}

// With a probe of the moment the joint has equations, and the beam a frame of its own: its modes were those of the free
// beam, and the damping of a plate 0.003 for 0.05.
TEST_CASE("damping: modal, a probe of a joint's moment does not change it") {
  const auto tip = [](const std::string& probe) {
    return move(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 6}}
    section: {shape: rectangle, width: 0.02, height: 0.005, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    damping: {modal: [0.05, 0.05, 0.3, 0.3]}
    frame: clamped
    reduction: {modes: 4, derivatives: all}
    initial: {deformation_rate: ["0", "0", "1e-2*x^2"]}
joints: {j: {type: fixed, between: [ground, beam.start]}}
motion: {end: 0.5, step: 1e-3}
probes: {tip: {at: beam.end}$probe}
)yaml",
                     {{"probe", probe}}),
                Formulation::vm_md);
  };
  const History with = tip(", root: {joint: j, quantity: moment}"), without = tip("");
  REQUIRE(with.model.multipliers > without.model.multipliers);
  CHECK(relative_error(with, without, "tip.z") < 1e-3);
}

// The second beam is a copy, and joined to the first: they do not have the modal damping of one.
TEST_CASE("damping: modal, of copies that other bodies hold") {
  const History at = move(fill(R"yaml(
bodies:
  a: &beam
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    reduction: {modes: 4, derivatives: all}
    damping: {modal: [0.05, 0.3, 0.3]}
  b:
    like: a
    initial: {position: [1.5, 0], deformation_rate: ["0", "1e-4*x^2"]}
  hub: {rigid: {mass: 1e6, centre: [0, 0], inertia: 1e6}, initial: {position: [1.5, 0]}}
joints: {j: {type: fixed, between: [hub.centre, b.start]}}
motion: {end: 9, step: 5e-3, spectral_radius: 0.99}
probes: {tip: {at: b.end}}
)yaml",
                               {}),
                          Formulation::vm_md);
  CHECK(at.model.bodies[1].reduction_of.empty());
  CHECK(ratio_of_decay(at.t, at["tip.y"], 0.5) == Approx(0.05).epsilon(0.02));
}

TEST_CASE("damping: modal, copies that are constrained alike share their reduction") {
  for (const std::string reduction : {"modes: 4", "modes: 4, interface: [start]"}) {
    CAPTURE(reduction);
    const auto model = assembly::build(scene::parse_scene(fill(R"yaml(
bodies:
  hub: {rigid: {mass: 1, centre: [0, 0], inertia: 1}}
  a:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    reduction: {$reduction}
    damping: {modal: [0.05]}
  b: {like: a, initial: {angle: 2}}
joints:
  g: {type: revolute, between: [ground, hub.centre]}
  j: {type: fixed, between: [hub.centre, a.start]}
  k: {type: fixed, between: [hub.centre, b.start]}
motion: {end: 1, step: 0.1}
)yaml",
                                                               {{"reduction", reduction}}),
                                                          "scene"),
                                       Formulation::vm_md, PETSC_COMM_WORLD);
    CHECK(model.bodies[2].reduction_of == "a");
  }
}

// alpha = 20/s would stop these motions within a tenth of a second.
TEST_CASE("damping: rigid-body motions permitted by joints are not damped") {
  const int dimension = GENERATE(2, 3);
  const std::string frame = GENERATE("pinned", "mean-axis", "pinned\n    frames: 2");
  const Formulation formulation = GENERATE(Formulation::vm_md, Formulation::nlffr, Formulation::cfr);
  const bool space = dimension == 3;
  const std::string tail = R"yaml(
    frame: $frame
    damping: {mass: 20}
    initial: {$start}
    reduction: {modes: 4, derivatives: none}
$more
motion: {end: 1, step: 2e-3, spectral_radius: 0.99}
probes: {tip: {at: beam.end, quantity: position}}
)yaml";
  INFO(dimension << " " << frame << " " << name_of(formulation));
  const auto total = [](const dynamics::Energy& e) { return e.kinetic + e.elastic + e.potential; };
  const History thrown =
      move(unit_beam(dimension, fill(tail, {{"frame", frame},
                                            {"start", space ? "velocity: [1, 2, 3], angular_velocity: [0, 0.01, 0.02]"
                                                            : "velocity: [1, 2], angular_velocity: 0.02"},
                                            {"more", ""}})),
           formulation);
  CHECK(total(thrown.energy.back()) == Approx(total(thrown.energy.front())).epsilon(1e-5));
  const History swing = move(
      unit_beam(dimension, fill(tail, {{"frame", frame},
                                       {"start", space ? "angular_velocity: [0, 0, 0.1]" : "angular_velocity: 0.1"},
                                       {"more", std::string("joints: {root: {type: revolute, between: [ground, "
                                                            "beam.start]") +
                                                    (space ? ", axis: [0, 0, 1]}}" : "}}")}})),
      formulation);
  CHECK(swing["tip.y"].back() == Approx(std::sin(0.1)).epsilon(1e-3));
  CHECK(total(swing.energy.back()) == Approx(total(swing.energy.front())).epsilon(1e-3));
}

// A blade whose frame is that of the rigid hub at its root: alpha = 20/s would stop it within a tenth of a second.
TEST_CASE("damping: mass-proportional, a blade on a free rigid hub keeps its spin") {
  const std::string frame = GENERATE("{type: clamped, at: start}", "mean-axis");
  const Formulation formulation = GENERATE(Formulation::vm_md, Formulation::nlffr, Formulation::cfr);
  INFO(frame << " " << name_of(formulation));
  const History at = move(fill(R"yaml(
bodies:
  hub: {rigid: {mass: 1, centre: [0, 0, 0], inertia: [0.01, 0.01, 0.01]}, initial: {angular_velocity: [0, 0, 20]}}
  blade:
    mesh: {line: {from: [0.2, 0, 0], to: [1.2, 0, 0], elements: 6}}
    section: {shape: rectangle, width: 0.03, height: 0.006, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    frame: $frame
    damping: {mass: 20}
    reduction: {modes: 4}
    initial: {angular_velocity: [0, 0, 20]}
joints:
  shaft: {type: revolute, axis: [0, 0, 1], between: [ground, hub.centre]}
  root: {type: fixed, between: [{body: hub, node: [0.2, 0, 0]}, blade.start]}
motion: {end: 0.2, step: 5e-4}
probes: {spin: {at: blade.start, quantity: angular_velocity}}
)yaml",
                               {{"frame", frame}}),
                          formulation);
  CHECK(at["spin.z"].back() == Approx(20).epsilon(1e-3));
}

// A plate of 0.18 kg that a joint holds by an edge on a carriage, which goes at 1 m/s: nothing is deflected, and no
// force alpha m v = 0.9 N acts. The probe of the force gives the plate a frame of its own; nodes of its edge follow
// one.
TEST_CASE("damping: a plate moved by its edge is not braked by the ground") {
  const std::string damping = GENERATE("mass: 5", "modal: [0.05, 0.05]");
  const auto moved = [&](Formulation formulation) {
    return move(fill(R"yaml(
bodies:
  car: {rigid: {mass: 5, centre: [0, 0.05, 0], inertia: [0.1, 0.1, 0.1]}}
  p:
    mesh: {plate: {along: [0.4, 0, 0], across: [0, 0.1, 0], elements: [4, 2], cells: quadrilaterals}}
    section: {thickness: 3e-3}
    material: {E: 7e9, nu: 0.3, rho: 1500}
    reduction: {modes: 2}
    damping: {stiffness: 1e-2, $damping}
joints:
  s: {type: driven_slide, between: [ground, car.centre], axis: [0, 0, 1], speed: "smooth(t, 0, 0.2)"}
  h: {type: fixed, between: [{body: car, node: [0, 0.05, 0]}, p.left]}
motion: {end: 1.2, step: 5e-3}
probes: {u: {at: p.right, relative_to: p.left}, F: {joint: h, quantity: force}}
)yaml",
                     {{"damping", damping}}),
                formulation);
  };
  const History full = moved(Formulation::nlffr);
  const double greatest = *std::min_element(full["u.z"].begin(), full["u.z"].end());
  CHECK(greatest < -5e-3);
  for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
    INFO(damping << " " << name_of(formulation));
    const History at = moved(formulation);
    CHECK(std::abs(at["F.z"].back()) < 1e-3);
    CHECK(std::abs(at["u.z"].back()) < 1e-5);
    CHECK(*std::min_element(at["u.z"].begin(), at["u.z"].end()) == Approx(greatest).epsilon(0.03));
  }
}

// Foreshortening is no strain and not damped: with C = beta K one frame gave a third of what four gave. The decay is
// that of the linear mode, beta omega^2 / 2.
TEST_CASE("damping: decay of a large deflection is the same in one frame and in several, reduced and full-order") {
  const double one = last_extreme("1", "6", Formulation::vm_md), two = last_extreme("2", "4", Formulation::vm_md),
               four = last_extreme("4", "3", Formulation::vm_md), full = last_extreme("1", "6", Formulation::nlffr);
  CHECK(one == Approx(four).epsilon(0.01));
  CHECK(two == Approx(four).epsilon(0.01));
  CHECK(full == Approx(one).epsilon(0.002));
  const double omega_squared = std::pow(1.875104068711961, 4) * 1.67 / 0.16;
  CHECK(four == Approx(0.3648 * std::exp(-1e-3 * omega_squared / 2 * 1.93)).epsilon(0.03));
}

TEST_CASE(
    "damping: decay of a large deflection in four and ten frames of every kind is that of corotational elements") {
  const double exact = last_extreme("1", "6", Formulation::cfr);
  const std::string frame = GENERATE("pinned", "{type: clamped, at: start}", "mean-axis");
  for (const auto& [frames, modes] : {std::pair("4", "3"), {"10", "2"}}) {
    INFO(frame << ", " << frames << " frames");
    CHECK(last_extreme(frames, modes, Formulation::vm_md, frame) == Approx(exact).epsilon(5e-3));
  }
}

// alpha M + beta K: z = alpha / (2 w) + beta w / 2.
TEST_CASE("damping: decay of one mode, Rayleigh") {
  const double w = M_PI * M_PI;
  for (const Formulation formulation : {Formulation::vm_md, Formulation::vm, Formulation::nlffr}) {
    INFO(name_of(formulation));
    check_decay(plucked(formulation, "mass: 0.4"), 0.4 / (2 * w));
    check_decay(plucked(formulation, "stiffness: 0.005"), 0.005 * w / 2);
  }
}

// The axes that accompany a corotational body have neither mass nor stiffness: the end of a sudden load once gave them
// velocities of 1e8 m/s, and results that differed between ranks.
TEST_CASE("damping: modal damping of corotational beams passes the end of a sudden load") {
  const std::string text = R"yaml(
bodies:
  a:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    damping: {modal: [0.05, 0.05]$more}
joints: {r: {type: fixed, between: [ground, a.start]}}
loads: {p: {type: force, at: a.end, force: [0, "t < 0.3 ? 0.2 : 0"]}}
motion: {end: 0.5, step: 4e-3, spectral_radius: 0.99}
probes: {tip: {at: a.end}}
)yaml";
  for (const char* more : {"", ", mass: 0.3"}) {
    const History history = move(fill(text, {{"more", more}}), Formulation::cfr),
                  other = move(fill(text, {{"more", more}}), Formulation::nlffr);
    INFO(more);
    CHECK(history.model.system->constraint_violation(0.5, history.model.U, history.model.V,
                                                     dynamics::ConstraintLevel::velocity) < 1e-3);
    CHECK(relative_error(history, other, "tip.y") < 0.01);
  }
}

TEST_CASE("damping: modal, of joints that dofs cannot hold, or that lead nowhere, is reported", "[verification]") {
  const Formulation formulation = GENERATE(Formulation::vm_md, Formulation::nlffr, Formulation::cfr);
  const std::string frames = GENERATE("1", "2");
  CAPTURE(name_of(formulation), frames);
  const auto reported = [&](const std::string& bodies, const std::string& joint) {
    const auto model =
        assembly::build(scene::parse_scene(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    reduction: {modes: 3}
    frames: $frames
    damping: {modal: [0.01]}
  $bodies
joints: {j: {type: $joint, between: [beam.start, $other]}}
motion: {end: 1, step: 0.1}
)yaml",
                                                {{"bodies", bodies},
                                                 {"joint", joint},
                                                 {"frames", frames},
                                                 {"other", bodies.starts_with("hub") ? "hub.centre" : "other.end"}}),
                                           "scene"),
                        formulation, PETSC_COMM_WORLD);
    return std::count_if(model.warnings.begin(), model.warnings.end(), [](const std::string& warning) {
      return warning.find("the modes of damping.modal do not satisfy joint j to") != std::string::npos;
    });
  };
  const std::string hub = "hub: {rigid: {mass: 1, centre: [0, 0], inertia: 1}}",
                    other =
                        "other: {mesh: {line: {from: [-1, 0], to: [0, 0], elements: 8}}, section: {EA: 1e4, EI: 1, "
                        "rhoA: 1}, reduction: {modes: 3}}";
  CHECK(reported(hub, "prismatic, axis: [0, 1]") == 0);
  CHECK(reported(hub, "revolute") == 0);
  CHECK(reported(hub, "prismatic, axis: [1, 1]") == 1);
  CHECK(reported(other, "fixed") == 1);
}

// A beam on a hub on the ground, damping that a file has of the beam alone: a twentieth here.
TEST_CASE("damping: what a joint to another body does not enter is named", "[verification]") {
  const Scratch scratch;
  const std::string file = (scratch.path / "beam.h5").string();
  const auto mesh = [](const std::string& damping) {
    return fill(
        "{mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}, section: {EA: 1e4, EI: 1, rhoA: 1}, "
        "reduction: {modes: 3}, damping: {$damping}}",
        {{"damping", damping}});
  };
  const auto text = [](const std::string& beam, const std::string& joint) {
    return "bodies: {hub: {rigid: {mass: 1, centre: [0, 0], inertia: 1}}, beam: " + beam +
           "}\njoints: {g: {type: fixed, between: [ground, hub.centre]}, j: {type: " + joint +
           ", between: [hub.centre, beam.start]}}\nmotion: {end: 1, step: 0.1}\n";
  };
  const auto named = [&](const std::string& beam, const std::string& joint) {
    const auto model =
        assembly::build(scene::parse_scene(text(beam, joint), "scene"), Formulation::vm_md, PETSC_COMM_WORLD);
    return std::any_of(model.warnings.begin(), model.warnings.end(), [](const std::string& warning) {
      return warning.find("is that of the free body, without joint j") != std::string::npos;
    });
  };
  CHECK_FALSE(named(mesh("modal: [0.01], mass: 1, stiffness: 1e-4"), "fixed"));
  for (const bool mass : {true, false}) {
    std::vector<std::string> warnings;
    const std::string damping = mass ? "mass: 1, modal: [0.1], stiffness: 1e-4" : "stiffness: 1e-4";
    assembly::reduce_body(scene::parse_scene(text(mesh(damping), "fixed"), "scene"), "beam", PETSC_COMM_WORLD, file,
                          true, warnings);
    CHECK(named("{reduced: " + file + "}", "fixed") == mass);
    CHECK(named("{reduced: " + file + "}", "revolute") == mass);
  }
}
