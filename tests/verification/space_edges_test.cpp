#include <catch2/catch.hpp>

#include "../../src/app/campbell.h"
#include "estimated.h"
#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// A shell's edge that is joined to another body is one rigid piece: clamped to a rigid hub that stands, or is heavy,
// the shell vibrates as if the ground clamped it.

namespace {

/// A plate of 1 m x 0.5 m on a rod of which nothing bends, beside its left edge.
std::string on_hub(const std::string& joints, const std::string& density = "1000", const std::string& rest = "",
                   const std::string& bodies = "") {
  return fill(R"yaml(
bodies:$bodies
  hub:
    rigid: true
    mesh: {line: {from: [-0.2, 0.25, 0], to: [0, 0.25, 0], elements: 1}}
    section: {shape: rectangle, width: 0.5, height: 0.5, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: $rho}
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [4, 3], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 8e9, nu: 0.3, rho: 1000}
    reduction: {modes: 8}
joints: {$joints}
$rest
)yaml",
              {{"rho", density}, {"joints", joints}, {"rest", rest}, {"bodies", bodies}});
}
const std::string constrained = "post: {type: driven, between: [ground, hub.end], axis: [0, 0, 1], angle: \"t\"}, ",
                  clamp = "root: {type: fixed, between: [hub.end, plate.left]}";

/// Frequencies at rest; those of rigid motions are zero but for round-off.
std::vector<double> frequencies(const std::string& text, Formulation formulation) {
  app::CampbellRequest request;
  request.speeds = "0", request.modes = 40;
  request.about = "0,0,1", request.through = "0,0.25,0";
  std::exception_ptr fault;
  const app::CampbellDiagram found =
      app::campbell(scene::parse_scene(text, "scene"), formulation, PETSC_COMM_WORLD, request, fault);
  if (fault) std::rethrow_exception(fault);
  REQUIRE(found.points.at(0).fault == "");
  std::vector<double> all;
  for (const auto& vibration : found.points[0].vibrations)
    if (vibration.omega > 10) all.push_back(vibration.omega);
  REQUIRE(all.size() >= 4);
  all.resize(4);
  return all;
}

/// Greatest relative difference of the lowest frequencies.
double off(const std::vector<double>& found, const std::vector<double>& expected) {
  double worst = 0;
  for (std::size_t i = 0; i < found.size(); ++i) worst = std::max(worst, std::abs(found[i] / expected[i] - 1));
  return worst;
}

}  // namespace

TEST_CASE("edges in space: a shell clamped to a hub by its edge vibrates as one clamped to the ground") {
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const std::string ground = "root: {type: driven, between: [ground, plate.left], axis: [0, 0, 1], angle: \"t\"}";
    const std::vector<double> clamped = frequencies(on_hub(constrained + ground), formulation);
    const double tolerance = formulation == Formulation::nlffr ? 1e-6 : 5e-3;
    CHECK(off(frequencies(on_hub(constrained + clamp), formulation), clamped) < tolerance);
    const std::string driven = "root: {type: driven, between: [hub.end, plate.left], axis: [1, 2, 3], angle: \"t\"}";
    CHECK(off(frequencies(on_hub(constrained + driven), formulation), clamped) < tolerance);
    const std::string mean = "root: {type: fixed, between: [hub.end, plate.left], edges: mean}";
    CHECK(off(frequencies(on_hub(constrained + mean), formulation), clamped) >
          0.02);  // what the mean alone would leave
  }
}

// A free hub of 5e7 kg stands as the ground does, and the shell of 5 kg moves as if clamped to it.
TEST_CASE("edges in space: a shell on a free and heavy hub") {
  const auto pushed = [](const std::string& joints, Formulation formulation) {
    return move(on_hub(joints, "1e9", R"yaml(
loads: {f: {type: force, at: plate.p3, force: [0, 0, "0.2*t"]}}
motion: {end: 0.3, step: 3e-3}
probes: {tip: {at: plate.p3}, side: {at: plate.p2}}
)yaml"),
                formulation);
  };
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const History ground = pushed("root: {type: fixed, between: [ground, plate.left]}", formulation),
                  free = pushed(clamp, formulation);
    for (const std::string probe : {"tip", "side"})
      CHECK(apart(free, ground, probe) < (formulation == Formulation::nlffr ? 1e-3 : 1e-2));
  }
}

// The left edge is clamped to a rigid hub and the bottom edge to a rigid bar: they share p1, and are one piece. Loads
// and probes at nodes of the piece act on it and move with it.
TEST_CASE("edges in space: two edges with a common corner, loads and probes at dependent nodes") {
  const auto moved = [](const std::string& load, Formulation formulation) {
    return move(on_hub("post: {type: revolute, between: [ground, hub.start], axis: [0, 1, 0]}, " + clamp +
                           ", bar: {type: fixed, between: [plate.bottom, bar.middle]}",
                       "1000", R"yaml(
motion: {end: 0.1, step: 2e-3}
probes: {corner: {at: plate.p1}, edge: {at: plate.left}, far: {at: plate.p2}, tip: {at: plate.p3}}
)yaml" + load,
                       R"yaml(
  bar:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 0.02, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 1000}
)yaml"),
                formulation);
  };
  const std::string at_corner = "loads: {f: {type: force, at: plate.p2, force: [0, 0, 800]}}",
                    at_bar = "loads: {f: {type: force, at: bar.end, force: [0, 0, 800]}}";
  const History full = moved(at_corner, Formulation::nlffr), bar = moved(at_bar, Formulation::nlffr),
                reduced = moved(at_corner, Formulation::vm_md);
  for (const std::string probe : {"corner", "edge", "far", "tip"}) {
    INFO(probe);
    CHECK(apart(full, bar, probe) <
          1e-3);  // one point of one rigid piece, to second order in its rotation in the frame
    CHECK(apart(reduced, full, probe) < 1e-2);
  }
  // the piece keeps its lengths, to second order in its rotation
  const std::size_t end = full.t.size() - 1;
  const Eigen::Vector3d p1 = vector_at(full, "corner", end), p2 = vector_at(full, "far", end);
  CHECK(p2.norm() > 1e-3);
  CHECK((Eigen::Vector3d(1, 0, 0) + p2 - p1).norm() == Approx(1).epsilon(1e-3));
}

// Two panels that unfold by a driven hinge along their common edge: reduced against full order.
TEST_CASE("edges in space: panels on driven hinges, reduced as full-order") {
  const std::string text = R"yaml(
bodies:
  inner:
    mesh: {plate: {along: [0.8, 0, 0], across: [0, 0.5, 0], elements: [4, 3]}}
    section: {thickness: 6e-3}
    material: {E: 2e9, nu: 0.3, rho: 600}
    reduction: {modes: 4}
  outer:
    mesh: {plate: {along: [0.8, 0, 0], across: [0, 0.5, 0], elements: [4, 3]}}
    section: {thickness: 6e-3}
    material: {E: 2e9, nu: 0.3, rho: 600}
    reduction: {modes: 4}
    initial: {position: [0, 0.5, 0]}
joints:
  root: {type: driven, between: [ground, inner.bottom], angle: "0.3*(1 - cos(4*t))"}
  fold: {type: driven, between: [inner.top, outer.bottom], angle: "-0.8*(1 - cos(4*t))"}
motion: {end: 0.4, step: 2e-3}
probes: {tip: {at: outer.p3, quantity: position}, bent: {at: outer.p3, quantity: deflection}}
)yaml";
  const History full = move(text, Formulation::nlffr), reduced = move(text, Formulation::vm_md);
  CHECK(apart(reduced, full, "tip") < 1e-3);
  CHECK(apart(reduced, full, "bent") < 2e-2);
}

namespace {

/// A square plate of 1 m, D = 1, mass 1 per area, quadrilaterals.
std::string square(int n, const std::string& joints, const std::string& bodies = "") {
  return fill(R"yaml(
bodies:$bodies
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [$n, $n], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 12*0.91*1e6, nu: 0.3, rho: 100}
    reduction: {modes: 5}
joints: {$joints}
)yaml",
              {{"n", std::to_string(n)}, {"joints", joints}, {"bodies", bodies}});
}
const std::string on_ground =
    "l: {type: revolute, between: [ground, plate.left]}, r: {type: revolute, between: [ground, plate.right]}";
const std::string on_posts =
    "post: {type: driven, between: [ground, hub.end], axis: [0, 0, 1], angle: \"t\"}, "
    "l: {type: revolute, between: [{body: hub, node: [0, 0.5, 0]}, plate.left], axis: [0, 1, 0]$edges}, "
    "r: {type: revolute, between: [{body: hub, node: [1, 0.5, 0]}, plate.right]$edges}";
const std::string rigid_hub = R"yaml(
  hub:
    rigid: true
    mesh: {line: {from: [-0.2, 0.25, 0], to: [0, 0.25, 0], elements: 1}}
    section: {shape: rectangle, width: 0.5, height: 0.5, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 1000}
)yaml";
std::string posts(const std::string& edges) { return fill(on_posts, {{"edges", edges}}); }

}  // namespace

// Two opposite edges simply supported, the others free, nu = 0.3: Levy's solution, in closed form up to a root.
TEST_CASE("edges in space: a plate hinged along two edges has Levy's frequencies, on the ground and on a body") {
  const std::vector<double> levy{9.631385, 16.134777, 36.725642, 38.944959, 46.738147};
  const auto coarse = omega_of(square(8, on_ground)), fine = omega_of(square(16, on_ground));
  REQUIRE(coarse.size() == 5);
  for (std::size_t i = 0; i < levy.size(); ++i) {
    INFO(i);
    CHECK((4 * fine[i] - coarse[i]) / 3 == Approx(levy[i]).epsilon(1e-3));
    CHECK(fine[i] == Approx(levy[i]).epsilon(1e-2));
  }
  // every node's displacements constrained, each node by itself: another way to the same limit
  const auto apart = omega_of(
      square(8,
             "l: {type: revolute, between: [ground, plate.left], edges: mean}, r: {type: revolute, between: [ground, "
             "plate.right], edges: mean}"));
  CHECK(off(apart, coarse) < 0.02);

  const auto small = omega_of(square(4, on_ground));
  const std::vector<double> first(small.begin(), small.begin() + 4);
  const auto with = [&](const std::string& edges) {
    std::vector<double> found;
    app::CampbellRequest request;
    request.speeds = "0", request.modes = 40, request.about = "0,0,1", request.through = "0,0.25,0";
    std::exception_ptr fault;
    const app::CampbellDiagram diagram = app::campbell(scene::parse_scene(square(4, posts(edges), rigid_hub), "scene"),
                                                       Formulation::nlffr, PETSC_COMM_WORLD, request, fault);
    if (fault) std::rethrow_exception(fault);
    REQUIRE(diagram.points.at(0).fault == "");
    for (const auto& vibration : diagram.points[0].vibrations)
      if (vibration.omega > 1) found.push_back(vibration.omega);
    REQUIRE(found.size() >= 4);
    found.resize(4);
    return found;
  };
  CHECK(off(with(""), first) < 1e-6);
  CHECK(off(with(", edges: line"), first) < 1e-6);
  CHECK(off(with(", edges: mean"), first) > 0.05);
  CHECK(off(with(", edges: rigid"), first) > 0.05);  // each edge clamped to a shaft that rotates freely
}

// Two panels that a free hinge joins along an oblique edge, in a rotated body, one of them on a hinge to a free hub.
TEST_CASE("edges in space: panels on free hinges, reduced as full-order, energy conserved") {
  const Rotated rotation;
  const std::string text = fill(R"yaml(
bodies:
  hub:
    rigid: true
    mesh: {line: {from: [-0.2, 0.2, 0], to: [0, 0.2, 0], elements: 1}}
    section: {shape: rectangle, width: 0.5, height: 0.5, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 100}
    initial: {rotation: $turn}
  inner:
    mesh: {plate: {along: [0.8, 0, 0], across: [0.1, 0.5, 0], elements: [4, 3]}}
    section: {thickness: 6e-3}
    material: {E: 2e9, nu: 0.3, rho: 600}
    reduction: {modes: 5}
    initial: {rotation: $turn}
  outer:
    mesh: {plate: {along: [0.6, 0, 0], across: [0.1, 0.5, 0], elements: [3, 3]}}
    section: {thickness: 6e-3}
    material: {E: 2e9, nu: 0.3, rho: 600}
    reduction: {modes: 5}
    initial: {position: $there, rotation: $turn}
joints:
  root: {type: revolute, between: [{body: hub, node: [0.05, 0.25, 0]}, inner.left]}
  fold: {type: revolute, between: [inner.right, outer.left]}
loads:
  push: {type: force, at: outer.p3, axes: body, force: [0, 0, "2*triangle(t, 0.05, 0.05)"]}
  twist: {type: force, at: outer.p2, axes: body, force: [0, 0, "-triangle(t, 0.05, 0.05)"]}
motion: {end: 0.3, step: 1e-3}
probes:
  tip: {at: outer.p3, quantity: position}
  edge: {at: outer.left, quantity: position}
  other: {at: inner.right, quantity: position}
  bent: {at: outer.p3, quantity: deflection}
)yaml",
                                {{"turn", rotation.text()}, {"there", rotation(0.8, 0)}});
  const History full = move(text, Formulation::nlffr), reduced = move(text, Formulation::vm_md);
  CHECK(apart(reduced, full, "tip") < 1e-3);
  CHECK(apart(reduced, full, "bent") < 5e-2);
  for (const History* at : {&full, &reduced}) {
    double open = 0;
    for (std::size_t i = 0; i < at->t.size(); ++i)
      open = std::max(open, (vector_at(*at, "edge", i) - vector_at(*at, "other", i)).norm());
    CHECK(open < 1e-9);
    const std::size_t begin = 110, end = at->energy.size() - 1;  // after the loads
    CHECK(total(at->energy[end]) == Approx(total(at->energy[begin])).epsilon(1e-2));
  }
}

namespace {

/// A plate whose mesh is rotated, anyhow in space or not at all, hinged to the ground.
std::string rotated_plate(const std::string& joints, bool rotated, const std::string& rest = "") {
  const Rotated rotation;
  const auto at = [&](double x, double y, double z = 0) {
    return rotated ? rotation(x, y, z) : fmt::format("[{}, {}, {}]", x, y, z);
  };
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: $along, across: $across, elements: [6, 4]}}
    section: {thickness: 0.01}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 5}
joints: {$joints}
loads: {wind: {type: pressure, body: plate, pressure: "3000*sin(80*t)"}}
motion: {end: 0.02, step: 1e-3}
probes: {corner: {at: plate.p3}, bent: {at: plate.p3, quantity: deflection}, inner: {at: {body: plate, node: $inner}}}
$rest
)yaml",
              {{"along", at(1, 0)},
               {"across", at(0.2, 0.8)},
               {"inner", at(0.6, 0.4)},
               {"joints", fill(joints, {{"left", at(0.2, 0.8)}, {"bottom", at(1, 0)}, {"normal", at(0, 0, 1)}})},
               {"rest", rest}});
}

const std::vector<std::string> holding_in_part{
    "l: {type: revolute, between: [ground, plate.left], axis: $left, edges: line}",
    "l: {type: revolute, between: [ground, plate.left]}, r: {type: revolute, between: [ground, plate.right]}",
    "l: {type: fixed, between: [ground, plate.left]}, b: {type: revolute, between: [ground, plate.bottom]}",
    "l: {type: revolute, between: [ground, plate.left]}, b: {type: revolute, between: [ground, plate.bottom]}",
    "l: {type: revolute, between: [ground, plate.left], axis: $left, edges: rigid}",
    "l: {type: prismatic, between: [ground, plate.left], axis: $left}",
    "p: {type: revolute, between: [ground, plate.p1], axis: $left}, "
    "q: {type: cylindrical, between: [ground, plate.p2], axis: $left}",
};

}  // namespace

// What the ground holds along oblique axes it holds as along the mesh's own: the frame has the joints' axes.
TEST_CASE("edges in space: a plate hinged to the ground, for any orientation of its mesh") {
  const Rotated rotation;
  for (const std::string& joints : holding_in_part) {
    INFO(joints);
    const std::string straight = rotated_plate(joints, false), oblique = rotated_plate(joints, true);
    CHECK(off(omega_of(oblique), omega_of(straight)) < 1e-9);
    for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
      INFO(name_of(formulation));
      const History as_is = move(straight, formulation), rotated = move(oblique, formulation);
      double worst = 0, size = 0;
      for (const std::string probe : {"corner", "bent", "inner"})
        for (std::size_t i = 0; i < as_is.t.size(); ++i) {
          const Eigen::Vector3d x = vector_at(as_is, probe, i);
          worst = std::max(worst, (rotation.Q.transpose() * vector_at(rotated, probe, i) - x).norm());
          size = std::max(size, x.norm());
        }
      CHECK(size > 1e-3);
      CHECK(worst < 1e-9 * size);
    }
  }
}

TEST_CASE("edges in space: equilibria and estimates of a plate on oblique hinges") {
  const Rotated rotation;
  const std::string straight = rotated_plate(holding_in_part[1], false),
                    oblique = rotated_plate(holding_in_part[1], true);
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const History as_is = rest(straight, formulation), rotated = rest(oblique, formulation);
    const Eigen::Vector3d x = vector_at(as_is, "inner", 0);
    CHECK(x.norm() > 1e-4);
    CHECK((rotation.Q.transpose() * vector_at(rotated, "inner", 0) - x).norm() < 1e-8 * x.norm());
  }
  const Estimated as_is = move_and_estimate(straight, Formulation::vm_md),
                  rotated = move_and_estimate(oblique, Formulation::vm_md);
  REQUIRE(as_is.estimate.none == "");
  REQUIRE(rotated.estimate.none == "");
  REQUIRE(as_is.estimate.probes.size() == 3);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(rotated.estimate.probes[i] == Approx(as_is.estimate.probes[i]).epsilon(1e-3).margin(1e-8));  // 0: constrained
}

TEST_CASE("edges in space: edges supported by the ground that meet are one rim without constraints") {
  for (const bool rotated : {false, true})
    for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
      const assembly::Model model =
          history_of(rotated_plate("l: {type: revolute, between: [ground, plate.left]}, "
                                   "b: {type: revolute, between: [ground, plate.bottom], edges: line}",
                                   rotated),
                     formulation)
              .model;
      CHECK(model.warnings.empty());
      CHECK(model.multipliers == 0);
    }
}

namespace {

/// Six by four cells between two edges at an angle, as a deck.
std::string trapezoid(const Eigen::Matrix3d& Q) {
  const int n = 6, m = 4;
  std::string nodes, cells, left, right;
  const auto id = [&](int i, int j) { return 1 + i + (n + 1) * j; };
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) {
      const double y = 0.8 * j / m, x = (1 - 0.4 * y) * i / n + 0.3 * y;
      const Eigen::Vector3d p = Q * Eigen::Vector3d(x, y, 0);
      nodes += fmt::format("{}, {:.17g}, {:.17g}, {:.17g}\n", id(i, j), p.x(), p.y(), p.z());
      if (i < n && j < m)
        cells +=
            fmt::format("{}, {}, {}, {}, {}\n", 1 + i + n * j, id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1));
    }
  for (int j = 0; j <= m; ++j) left += fmt::format("{},\n", id(0, j)), right += fmt::format("{},\n", id(n, j));
  return "*NODE\n" + nodes + "*ELEMENT, TYPE=S4, ELSET=skin\n" + cells + "*NSET, NSET=left\n" + left +
         "*NSET, NSET=right\n" + right + fmt::format("*NSET, NSET=inner\n{}\n", id(3, 2)) +
         "*MATERIAL, NAME=alloy\n*ELASTIC\n7e10, 0.3\n*DENSITY\n2700\n"
         "*SHELL SECTION, ELSET=skin, MATERIAL=alloy\n0.01\n";
}

}  // namespace

// No frame has the axes of both hinges along its own: one of them is constrained by the joint's rows.
TEST_CASE("edges in space: two hinges at an angle with one another") {
  const Rotated rotation;
  const Scratch folder;
  const auto scene = [&](const std::string& deck) {
    return fill(R"yaml(
bodies: {plate: {mesh: {file: {path: $deck}}, reduction: {modes: 6}}}
joints: {l: {type: revolute, between: [ground, plate.left]}, r: {type: revolute, between: [ground, plate.right]}}
loads: {wind: {type: pressure, body: plate, pressure: "20000*sin(100*t)"}}
motion: {end: 0.02, step: 4e-4}
probes: {inner: {at: plate.inner}}
)yaml",
                {{"deck", (folder.path / deck).string()}});
  };
  write_text((folder.path / "straight.inp").string(), trapezoid(Eigen::Matrix3d::Identity()));
  write_text((folder.path / "turned.inp").string(), trapezoid(rotation.Q));
  const History full = move(scene("straight.inp"), Formulation::nlffr),
                reduced = move(scene("straight.inp"), Formulation::vm_md),
                rotated = move(scene("turned.inp"), Formulation::nlffr);
  CHECK(apart(reduced, full, "inner") < 1e-2);
  double worst = 0, size = 0;
  for (std::size_t i = 0; i < full.t.size(); ++i) {
    const Eigen::Vector3d x = vector_at(full, "inner", i);
    worst = std::max(worst, (rotation.Q.transpose() * vector_at(rotated, "inner", i) - x).norm());
    size = std::max(size, x.norm());
  }
  CHECK(size > 1e-3);
  CHECK(worst < 1e-9 * size);
  const double first = omega_of(scene("straight.inp")).front();
  CHECK(omega_of(scene("turned.inp")).front() == Approx(first).epsilon(1e-9));
}

// A plate that slides along an edge, along the axes and rotated anyhow: static columns of forces and their derivatives
// are of its plane or across it in both, so that none is left of round-off.
TEST_CASE("a sliding plate moves the same for any orientation of its mesh") {
  const auto motion = [](const Eigen::Matrix3d& R) {
    const auto words = [](const Eigen::Vector3d& v) {
      return number(v.x()) + ", " + number(v.y()) + ", " + number(v.z());
    };
    const Eigen::Vector3d f = R * Eigen::Vector3d(3, 2, 5);
    const History history = move(fill(R"yaml(
bodies:
  p:
    mesh: {plate: {along: [$along], across: [$across], elements: [4, 3]}}
    section: {thickness: 5e-3}
    material: {E: 2.1e11, nu: 0.3, rho: 7850}
    reduction: {modes: 10}
joints: {j: {type: prismatic, between: [ground, p.left], axis: [$along]}}
loads: {f: {type: force, at: p.p3, force: ["$fx*sin(200*t)", "$fy*sin(200*t)", "$fz*sin(200*t)"]}}
motion: {end: 0.02, step: 5e-4}
probes: {t: {at: p.p3}}
)yaml",
                                      {{"along", words(R.col(0))},
                                       {"across", words(0.5 * R.col(1))},
                                       {"fx", number(f.x())},
                                       {"fy", number(f.y())},
                                       {"fz", number(f.z())}}),
                                 Formulation::vm_md);
    Eigen::MatrixXd tip(history.t.size(), 3);
    for (int i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < history.t.size(); ++k)
        tip(static_cast<Eigen::Index>(k), i) = history[std::string("t.") + "xyz"[i]][k];
    return Eigen::MatrixXd(tip * R);
  };
  const Eigen::MatrixXd along = motion(Eigen::Matrix3d::Identity());
  for (const Eigen::Vector3d& rotation :
       {Eigen::Vector3d(0.9, 1.2, -1.4), Eigen::Vector3d(0, 0, 0.3), Eigen::Vector3d(0.7, 0, 0)}) {
    INFO("turned by " << rotation.transpose());
    CHECK((motion(math::rotation(rotation)) - along).cwiseAbs().maxCoeff() < 1e-6 * along.cwiseAbs().maxCoeff());
  }
}
