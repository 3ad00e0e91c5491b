#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <catch2/catch.hpp>

#include "floe/error.h"
#include "floe/math/rotation.h"
#include "floe/scene/copies.h"
#include "floe/scene/variation.h"

using namespace floe;
using scene::parse_scene;

namespace {

const std::string plane = R"yaml(
parameters: {a: pi/2}
bodies:
  upper:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1e5, EI: 20, rhoA: 1, rhoI: 1e-4}
    initial: {position: [0.3, 0], velocity: [0, 2]}
  fore: {like: upper, initial: {position: [1.3, 0], angle: 0.4}}
  base: {rigid: {mass: 1, centre: [0, 0], inertia: 1}, initial: {position: [0.1, 0.2], angle: pi/2}}
joints:
  shoulder: {type: revolute, between: [{body: ground, node: [0.3, 0]}, upper.start]}
  elbow: {type: revolute, between: [upper.end, fore.start]}
  slide: {type: prismatic, between: [ground, fore.end]}
  rope: {type: spring, between: [{body: base, node: [1, 0]}, {body: fore, node: [0.5, 0]}], stiffness: 3}
  alone: {type: spring, between: [ground, base.centre], stiffness: 3}
loads:
  motor: {type: moment, joint: elbow, moment: "-20*elbow.angle - 2e3*v.y"}
  push: {type: force, at: fore.end, force: ["v.y - 0.5*p.x", "5*t"]}
  own: {type: force, at: fore.end, axes: body, force: [1, 2]}
  weight: {type: distributed, body: upper, force: [0, "-t"]}
motion: {end: 1, step: 2e-3}
probes:
  v: {at: fore.end, quantity: velocity}
  p: {at: fore.end, quantity: position}
  r: {joint: shoulder, quantity: force}
  u: {body: fore, quantity: strain_energy}
  e: {formula: "elbow.angle - v.x"}
  base: {at: base.centre}
copies:
  two: {like: [upper, fore], angle: a, position: [0.5, 0.25], without: [own]}
)yaml";

/// Of a name in a list of the scene.
template <class Part>
const Part& named(const std::vector<Part>& parts, const std::string& name) {
  for (const Part& part : parts)
    if (part.name == name) return part;
  throw std::runtime_error("no " + name);
}

void check_point(const scene::Point& point, double x, double y, double z = 0) {
  CHECK(point[0] == Approx(x).margin(1e-14));
  CHECK(point[1] == Approx(y).margin(1e-14));
  CHECK(point[2] == Approx(z).margin(1e-14));
}

std::string fault_of(const std::string& text) {
  try {
    parse_scene(text, "scene");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string with(const std::string& text, const std::string& replaced, const std::string& by) {
  std::string other = text;
  other.replace(other.find(replaced), replaced.size(), by);
  return other;
}

}  // namespace

// By hand: (x, y) -> (0.5 - y, 0.25 + x).
TEST_CASE("copies of groups: bodies, joints, loads and probes rotate and move with the group") {
  const scene::Scene scene = parse_scene(plane, "scene");
  CHECK(scene.bodies.size() == 5);
  const scene::Body& fore = named(scene.bodies, "two_fore");
  CHECK(fore.section.EI == 20);
  check_point(named(scene.bodies, "two_upper").initial.position, 0.5, 0.55);
  check_point(named(scene.bodies, "two_upper").initial.velocity, -2, 0);
  check_point(fore.initial.position, 0.5, 1.55);
  CHECK(fore.initial.angle == Approx(0.4 + M_PI / 2));

  CHECK(scene.joints.size() == 9);
  const scene::Joint& rope = named(scene.joints, "two_rope");
  check_point(*named(scene.joints, "two_shoulder").first.point, 0.5, 0.55);
  CHECK(named(scene.joints, "two_elbow").first.body == "two_upper");
  check_point(named(scene.joints, "two_slide").axis, 0, 1);
  // (1, 0) of the base is (0.1, 1.2) of the world, then (-0.7, 0.35), which is (0.15, 0.8) in axes of the base
  CHECK(rope.first.body == "base");
  check_point(*rope.first.point, 0.15, 0.8);
  CHECK(rope.second.body == "two_fore");
  check_point(*rope.second.point, 0.5, 0);

  CHECK(scene.loads.size() == 7);
  const math::Formula &x = named(scene.loads, "two_push").force[0], &y = named(scene.loads, "two_push").force[1];
  CHECK(x(2.) == -10);
  // v.y of the original is -v.x of the copy, p.x is p.y - 0.25
  REQUIRE(y.variables() == std::vector<std::string>{"t", "two_v.x", "two_p.y"});
  CHECK(y.value(std::vector<double>{0, 7, 3}) == Approx(-7 - 0.5 * 2.75));
  const math::Formula& motor = named(scene.loads, "two_motor").on_joint;
  REQUIRE(motor.variables() == std::vector<std::string>{"t", "two_elbow.angle", "two_v.x"});
  CHECK(motor.value(std::vector<double>{0, 1, 1}) == Approx(-20 + 2000));
  CHECK(named(scene.loads, "two_weight").body == "two_upper");
  CHECK(named(scene.loads, "two_weight").force[0](3.) == 3);

  CHECK(scene.probes.size() == 11);
  CHECK(named(scene.probes, "two_r").joint == "two_shoulder");
  CHECK(named(scene.probes, "two_u").body == "two_fore");
  CHECK(named(scene.probes, "two_e").formula.variables() ==
        std::vector<std::string>{"t", "two_elbow.angle", "two_v.y"});
}

TEST_CASE("copies of groups in space: rotations are composed, axes and places of other bodies rotated") {
  const std::string beam =
      "{mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}, section: {A: 1, Iy: 1, Iz: 1, J: 1, orientation: "
      "[0, 1, 0]}, material: {E: 1, nu: 0, rho: 1}, initial: {rotation: [0, 0, 1.2], position: [0, 0, 1]}}";
  const std::string text = "bodies:\n  b: " + beam + "\n  c: " + beam +
                           R"yaml(
joints:
  j: {type: revolute, between: [{body: ground, node: [0, 0, 1]}, b.start], axis: [0, 0, 2]}
  k: {type: bushing, between: [ground, b.end], translation: [1, 2, 3], rotation: [4, 5, 5]}
copies:
  one: {like: [b], rotation: [pi/2, 0, 0]}
  two: {like: [one_b], rotation: [0.3, -0.5, 0.7], position: [1, 2, 3], without: [one_k]}
motion: {end: 1, step: 1}
)yaml";
  const scene::Scene scene = parse_scene(text, "scene");
  const Eigen::Matrix3d first = math::rotation({M_PI / 2, 0, 0}), second = math::rotation({0.3, -0.5, 0.7});
  const scene::Body& copy = named(scene.bodies, "two_one_b");
  const Eigen::Matrix3d rotation = math::rotation(Eigen::Vector3d(copy.initial.rotation.data()));
  CHECK((rotation - second * first * math::rotation({0, 0, 1.2})).norm() < 1e-14);
  const Eigen::Vector3d at = second * first * Eigen::Vector3d(0, 0, 1) + Eigen::Vector3d(1, 2, 3);
  check_point(copy.initial.position, at.x(), at.y(), at.z());
  check_point(*named(scene.joints, "two_one_j").first.point, at.x(), at.y(), at.z());
  const Eigen::Vector3d axis = second * Eigen::Vector3d(0, -2, 0);
  const Eigen::Vector3d found(named(scene.joints, "two_one_j").axis.data());
  CHECK(found.cross(axis).norm() < 1e-14);
  CHECK(found.dot(axis) > 0);
  // axes y and z of the bushing become z and -y
  CHECK(named(scene.joints, "one_k").translation == std::array<double, 3>{1, 3, 2});
  CHECK(scene.joints.size() == 5);
  CHECK_THAT(
      fault_of(with(text, "without: [one_k]", "without: [one_j]")),
      Catch::Contains("joints.one_k.translation: has axes that are not world axes after the rotation of copies.two"));
}

// x -> 0.5 - y, y -> 0.25 + x: the copy is at y' = 0.25 + c where the original is at x = c.
TEST_CASE("copies of groups: events of copied joints and probes") {
  const std::string events = R"yaml(events:
  drop: {unlock: shoulder, at: 0.5}
  hold: {lock: elbow, probe: p.x, crosses: 2}
  back: {lock: elbow, when: "t - 0.7"}
  fast: {stop: true, probe: v.y, crosses: 3}
  high: {stop: true, probe: p.y}
  error: {stop: true, probe: e.value, crosses: 9}
  end: {stop: true, at: 0.9}
  other: {unlock: alone2, probe: base.x, crosses: 1}
)yaml";
  const std::string text =
      with(plane, "  alone:", "  alone2: {type: revolute, between: [ground, base.centre]}\n  alone:") + events;
  const auto copy_of = [](const scene::Scene& scene, const std::string& name) {
    return named(scene.events, "two_" + name);
  };
  const std::string start = with(text, "position: [0.1, 0.2], angle: pi/2", "angle: 0");
  const scene::Scene scene = parse_scene(start, "scene");
  CHECK(scene.events.size() == 14);
  CHECK(copy_of(scene, "drop").joint == "two_shoulder");
  CHECK(copy_of(scene, "drop").at == 0.5);
  CHECK(copy_of(scene, "hold").joint == "two_elbow");
  CHECK(copy_of(scene, "hold").probe == "two_p.y");
  CHECK(copy_of(scene, "hold").crosses == Approx(2.25));
  CHECK(copy_of(scene, "back").when.has_value());
  CHECK(copy_of(scene, "fast").probe == "two_v.x");
  CHECK(copy_of(scene, "fast").crosses == Approx(-3));
  CHECK(copy_of(scene, "high").probe == "two_p.x");
  CHECK(copy_of(scene, "high").crosses == Approx(0.5));
  CHECK(copy_of(scene, "error").probe == "two_e.value");
  CHECK(copy_of(scene, "error").crosses == 9);
  const scene::Scene own = parse_scene(with(with(start, "without: [own]", "without: [own, drop, fast]"), "events:\n",
                                            "events:\n  two_hold: {lock: two_elbow, at: 0.1}\n"),
                                       "scene");
  CHECK(own.events.size() == 12);
  CHECK(copy_of(own, "hold").at == 0.1);
  CHECK_THAT(
      fault_of(with(start, "a: pi/2", "a: 0.5")),
      Catch::Contains("scene:34:30: events.hold.probe: is \"p.x\", which is the sum of several components after "
                      "the rotation of copies.two; expected a rotation by right angles, an entry two_hold beside "
                      "hold, which replaces its copy; or hold in copies.two.without"));
  CHECK_THAT(fault_of(with(start, "probe: base.x", "probe: p.x")),
             Catch::Contains("events.other.probe: is \"p.x\", of the group of copies.two, and joint alone2 is not; "
                             "expected an entry two_other beside other"));
}

TEST_CASE("copies of groups: basis vectors of joints and loads have the names of the copies") {
  const std::string reduction = R"yaml(
    reduction:
      modes: 2
      attachment: all
      interface: [start]
      columns: [mode 1, "derivative 1,2", "derivative 1,push.fx", "derivative push/2.fy,push-.fx", attachment elbow.fx,
                attachment start.x, "#2 attachment shoulder.moment", attachment own.fx])yaml";
  const std::string text = with(
      with(plane, "  base: {rigid",
           "  third:\n    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}\n    section: {EA: 1, EI: 1, rhoA: 1, "
           "rhoI: 0}" +
               reduction + "\n  base: {rigid"),
      "like: [upper, fore]", "like: [upper, fore, third]");
  const scene::Scene scene = parse_scene(text, "scene");
  CHECK(named(scene.bodies, "two_third").reduction.columns ==
        std::vector<std::string>{"mode 1", "derivative 1,2", "derivative 1,two_push.fx",
                                 "derivative two_push/2.fy,two_push-.fx", "attachment two_elbow.fx",
                                 "attachment start.x", "#2 attachment two_shoulder.moment", "attachment own.fx"});
  CHECK(named(scene.bodies, "third").reduction.columns[2] == "derivative 1,push.fx");
}

TEST_CASE("copies of groups: an entry of the scene replaces its copy; values follow the originals") {
  const std::string text =
      with(with(plane, "  alone:", "  two_rope: {like: rope, stiffness: 4}\n  alone:"),
           "rope: {type: spring, between: [{body: base, node: [1, 0]}", "rope: {type: spring, between: [base.centre");
  const scene::Scene scene = parse_scene(text, "scene", {{"bodies.upper.section.EI", 15}, {"a", 0}});
  CHECK(scene.joints.size() == 9);
  CHECK(named(scene.joints, "two_rope").stiffness == 4);
  CHECK(named(scene.joints, "two_rope").first.body == "base");
  CHECK(named(scene.bodies, "two_fore").section.EI == 15);
  check_point(named(scene.bodies, "two_upper").initial.position, 0.8, 0.25);
  CHECK(scene::offline_inputs(text, "scene", {{"a", 0.1}}) != scene::offline_inputs(text, "scene", {{"a", 0.2}}));
}

// d is seen from the frame of the group, so that of the copy records the same; w is seen from another body.
TEST_CASE("copies of groups in the plane: sensors in axes of the group are not rotated back") {
  const std::string text =
      with(with(plane, "p: {at",
                "d: {at: fore.end, relative_to: upper.start}\n  w: {at: fore.end, relative_to: {body: "
                "base, node: [0, 0]}}\n  p: {at"),
           "v.y - 0.5*p.x", "d.x + 9*w.x");
  const scene::Scene scene = parse_scene(text, "scene");
  CHECK(named(scene.loads, "two_push").force[0](1.) == -5);
  REQUIRE(named(scene.loads, "two_push").force[1].variables() == std::vector<std::string>{"t", "two_d.x", "two_w.y"});
  CHECK(named(scene.loads, "two_push").force[1].value(std::vector<double>{0, 2, 7}) == Approx(2 + 63));
}

TEST_CASE("copies of groups: names that formulas can read, of entries that exist once") {
  for (const std::string name : {"two-b", "2", "\"\"", "two.x", "t wo"})
    CHECK_THAT(
        fault_of(with(plane, "two: {like", name + ": {like")),
        Catch::Contains("is not a valid name in formulas; expected letters, digits and _, not starting with a digit"));
  CHECK_THAT(fault_of(with(plane, "two: {like", "2: {like")), Catch::Contains("scene:30:3: copies.2: is not"));
  // a_ of b_alone is a_b_alone, as a_b_ of alone
  const std::string both =
      with(plane, "  two: {like: [upper, fore], angle: a, position: [0.5, 0.25], without: [own]}\n",
           "  a: {like: [c]}\n  a_b: {like: [base], without: [rope]}\n");
  const auto clash = [&](const std::string& at, const std::string& entry) {
    return fault_of(
        with(with(both, "  base: {rigid", "  c: {rigid: {mass: 1, centre: [0, 0], inertia: 1}}\n  base: {rigid"), at,
             at + entry));
  };
  CHECK(clash("copies:\n", "") == "");
  CHECK_THAT(clash("joints:\n", "  b_alone: {type: spring, between: [ground, c.centre], stiffness: 3}\n"),
             Catch::Contains("copies.a_b: copies joint alone to a_b_alone, which exists; expected another name"));
  CHECK_THAT(clash("probes:\n", "  b_base: {at: c.centre}\n"),
             Catch::Contains("copies.a_b: copies probe base to a_b_base, which exists"));
  CHECK_THAT(clash("loads:\n",
                   "  b_k: {type: force, at: c.centre, force: [1, 1]}\n  k: {type: force, at: base.centre, "
                   "force: [1, 1]}\n"),
             Catch::Contains("copies.a_b: copies load k to a_b_k, which exists"));
}

TEST_CASE("copies of groups: written out, with nodes of their own") {
  const scene::Scene scene = parse_scene(plane, "scene");
  YAML::Node root = scene::load_resolved(scene);
  CHECK(!root["copies"]);
  root["bodies"]["two_upper"]["section"]["EI"] = 99;
  CHECK(root["bodies"]["upper"]["section"]["EI"].as<double>() == 20);
  YAML::Emitter out;
  out << root;
  const scene::Scene again = parse_scene(out.c_str(), "scene");
  CHECK(again.bodies.size() == 5);
  CHECK(named(again.bodies, "two_upper").section.EI == 99);
  check_point(named(again.bodies, "two_fore").initial.position, 0.5, 1.55);
}

TEST_CASE("copies of groups: keys by `like` are copied as those of the entry") {
  const std::string parts = R"yaml(
bodies:
  a: {rigid: {mass: 1, centre: [0, 0], inertia: 1}, initial: {position: [1, 0], angle: 0.3, velocity: [0.1, 0], angular_velocity: 3}}
  b: {$b}
joints:
  p: {type: spring, between: [{body: ground, node: [2, 0]}, b.centre], stiffness: 10}
  q: {$q, stiffness: 20}
loads:
  f: {type: force, at: b.centre, force: [1, 0]}
  g: {$g, force: [5, "-2*y.y"]}
motion: {end: 1, step: 1e-2}
probes:
  x: {at: b.centre, relative_to: a.centre}
  y: {$y, quantity: velocity}
copies: {k: {like: [a, b], position: [0, 5], angle: pi}}
)yaml";
  const auto as_written = [](const std::string& text) {
    YAML::Emitter out;
    out << scene::load_resolved(parse_scene(text, "scene"));
    return std::string(out.c_str());
  };
  const auto of = [&](const std::string& b, const std::string& q, const std::string& g, const std::string& y) {
    return as_written(with(with(with(with(parts, "$b", b), "$q", q), "$g", g), "$y", y));
  };
  const std::string body =
      "rigid: {mass: 1, centre: [0, 0], inertia: 1}, "
      "initial: {position: [1, 0], angle: 0.3, velocity: [0.1, 0], angular_velocity: 3}";
  const auto lines = [](std::string text) {  // inherited keys are the last ones of an entry
    std::sort(text.begin(), text.end());
    return text;
  };
  const std::string found = of("like: a", "like: p", "like: f", "like: x"),
                    wanted = of(body, "type: spring, between: [{body: ground, node: [2, 0]}, b.centre]",
                                "type: force, at: b.centre", "at: b.centre, relative_to: a.centre");
  INFO(found << "\n\n" << wanted);
  CHECK(lines(found) == lines(wanted));
  const scene::Scene scene = parse_scene(found, "scene");
  CHECK(scene.joints.size() == 4);
  CHECK(scene.loads.size() == 4);
  CHECK(scene.probes.size() == 4);
  check_point(named(scene.bodies, "k_b").initial.position, -1, 5);
}

TEST_CASE("copies of groups: faults of values are reported once, at their own lines") {
  CHECK_THAT(fault_of(with(plane, "rhoA: 1", "rhoA: x")),
             Catch::Contains("scene:6:38: bodies.upper.section.rhoA") && !Catch::Contains("two_upper"));
  CHECK_THAT(fault_of(with(plane, "[upper.end, fore.start]", "[upper.end, fore.stat]")),
             Catch::Contains("scene:12:48: joints.elbow.between[2]: fore has no place") &&
                 Catch::Contains("did you mean \"start\"?"));
  // texts and columns of copies differ: the copies' faults are reported once the originals are mended
  const auto once = [](const std::string& text, const std::string& fault) {
    const std::string found = fault_of(text);
    CHECK_THAT(found, Catch::StartsWith(fault) && !Catch::Contains("two_") && !Catch::Contains("\n"));
  };
  once(with(plane, "at: fore.end, force", "at: fore.ende, force"), "scene:18:27: loads.push.at: fore has no place");
  once(with(plane, "5*t", "5*tt"), "scene:18:62: loads.push.force[2]: \"tt\" at character 3 of \"5*tt\"");
  once(with(plane, "{joint: shoulder, quantity: force}", "{joint: shoulder, quantity: travel}"),
       "scene:25:3: probes.r.formula: depends on \"shoulder.travel\"");
  once(with(plane, "node: [0.3, 0]}", "node: [0.3, 1]}"), "scene:11:3: joints.shoulder: its places are 1 apart");
  CHECK_THAT(fault_of(with(plane, "{body: base, node: [1, 0]}", "base.centre")),
             Catch::Contains("scene:14:34: joints.rope.between: is \"base.centre\", on a body that copies.two does not "
                             "copy; expected coordinates of the place, as {body: base, node: [..]}; an entry "
                             "two_rope beside rope, which replaces its copy; or rope in copies.two.without"));
  CHECK_THAT(fault_of(with(plane, "{body: base, node: [1, 0]}", "{body: bas, node: [1, 0]}")),
             Catch::Contains("scene:14:34: joints.rope.between: there is no body \"bas\"; expected one of base, fore, "
                             "upper, ground; did you mean \"base\"?"));
  CHECK_THAT(fault_of(with(plane, "like: [upper, fore]", "like: [upper, for]")),
             Catch::Contains("scene:30:15: copies.two.like: has \"for\"; expected names of bodies: upper, fore, base; "
                             "did you mean \"fore\"?"));
  CHECK_THAT(fault_of(with(plane, "base: {rigid", "two_fore: {rigid")),
             Catch::Contains("copies body fore to two_fore, which exists"));
  std::string many = with(plane, "copies:\n", "copies:\n  c0: {like: [upper], without: [elbow]}\n"),
              all = "upper, c0_upper";
  for (int i = 1; i < 12; ++i) {
    many += fmt::format("  c{}: {{like: [{}], without: [elbow]}}\n", i, all);
    std::string copies;
    for (std::size_t at = 0, end; at < all.size(); at = end + 2) {
      end = std::min(all.find(", ", at), all.size());
      copies += fmt::format(", c{}_{}", i, all.substr(at, end - at));
    }
    all += copies;
  }
  CHECK_THAT(fault_of(many), Catch::Contains("copies.c9: makes more than 1000 bodies"));
}
