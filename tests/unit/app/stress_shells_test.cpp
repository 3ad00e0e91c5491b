#include <map>

#include "../../../src/app/equilibrium.h"
#include "../../../src/app/run.h"
#include "../../../src/app/stress.h"
#include "command_tests.h"

namespace {

/// A strip of 1 x 0.3 x 0.01, nu = 0, clamped at one end, under 10 N/m along it and a bending moment of -0.2 N.
std::string strip(const std::string& cells, const std::string& body = "") {
  return "bodies:\n  strip:\n    mesh: {plate: {along: [1, 0, 0], across: [0, 0.3, 0], elements: [6, 3], cells: " +
         cells +
         "}}\n    section: {thickness: 0.01}\n    material: {E: 7e10, nu: 0, rho: 2700}\n"
         "    reduction: {modes: 4, attachment: all}\n" +
         body +
         "joints: {clamp: {type: fixed, between: [ground, strip.left]}}\n"
         "loads:\n  pull: {type: force, at: strip.right, force: [3, 0, 0]}\n"
         "  end: {type: moment, at: strip.right, moment: [0, -0.06, 0]}\nmotion: {end: 1, step: 1}\n";
}

/// Last values of the history at one place, by what follows `strip.1.`.
std::map<std::string, double> history(const OwnFolder& own, const std::string& folder, const std::string& place) {
  app::StressRequest request;
  request.folder = own.path / folder, request.histories = {place}, request.force = true;
  printed([&] { app::stress(request, PETSC_COMM_WORLD); });
  const std::string prefix = place.substr(0, place.find(':')) + ".1.";
  std::map<std::string, double> last;
  for (const auto& [name, values] : columns_of(own.path / folder / "stress.csv"))
    if (name.starts_with(prefix))
      last[name.substr(prefix.size(), name.find(" [") - prefix.size())] = std::stod(values.back());
  return last;
}

std::map<std::string, double> at_rest(const OwnFolder& own, const std::string& text, Formulation formulation,
                                      const std::string& place) {
  const std::string file = own.write("scene.yaml", text), folder = "out";
  const auto results = output::prepare_folder(PETSC_COMM_WORLD, own.path / folder, true);
  printed([&] { app::solve_static(scene::read_scene(file), formulation, PETSC_COMM_WORLD, {1, 1}, results, false); });
  return history(own, folder, place);
}

}  // namespace

TEST_CASE("stress: a strip under a force along it and a bending moment, in every formulation: N / h + 6 M / h^2") {
  for (const std::string cells : {"triangles", "quadrilaterals"})
    for (const auto formulation : {Formulation::nlffr, Formulation::lffr, Formulation::vm_md, Formulation::cfr}) {
      INFO(cells << " " << scene::name_of(formulation));
      const OwnFolder own;
      auto at = at_rest(own, strip(cells), formulation, "strip:0.6,0.15,0");
      const double along = 10 / 0.01, bent = 6 * 0.2 / 1e-4, slack = 3e-3 * bent;
      CHECK(at["membrane_force.xx"] == Approx(10).epsilon(3e-3));
      CHECK(at["bending_moment.xx"] == Approx(-0.2).epsilon(3e-3));
      CHECK(at["stress_top.xx"] == Approx(along - bent).margin(slack));
      CHECK(at["stress_middle.xx"] == Approx(along).margin(slack));
      CHECK(at["stress_bottom.xx"] == Approx(along + bent).margin(slack));
      CHECK(at["strain_top.xx"] == Approx((along - bent) / 7e10).margin(slack / 7e10));
      CHECK(at["strain_bottom.xx"] == Approx((along + bent) / 7e10).margin(slack / 7e10));
      CHECK(std::abs(at["stress_top.yy"]) < slack);
      CHECK(std::abs(at["stress_top.xy"]) < slack);
      CHECK(at["von_mises_bottom"] == Approx(along + bent).margin(slack));
      CHECK(at["von_mises"] == Approx(along + bent).margin(slack));
      CHECK(at["stress_max"] == Approx(along + bent).margin(slack));
      CHECK(at["stress_min"] == Approx(along - bent).margin(slack));
    }
}

TEST_CASE("stress: shells of second order, whole and in several frames") {
  const OwnFolder own;
  for (const std::string body : {"    strains: second_order\n", "    frames: 3\n"}) {
    INFO(body);
    auto at = at_rest(own, strip("quadrilaterals", body), Formulation::nlffr,
                      body.find("frames") == std::string::npos ? "strip:0.6,0.15,0" : "strip#2:0.6,0.15,0");
    CHECK(at["stress_bottom.xx"] == Approx(1000 + 12000).epsilon(3e-3));
    CHECK(at["membrane_force.xx"] == Approx(10).epsilon(3e-3));
  }
}

// Two layers of 5 mm, E = 2e9 below and 6e9 above, nu = 0, stretched by e = N / 4e7: what E says of each.
TEST_CASE("stress: the layers of a laminate, of elements of first and second order") {
  const OwnFolder own;
  for (const std::string kind : {"S4", "S8R"}) {
    INFO(kind);
    const bool quadratic = kind == "S8R";
    // nodes (i, j) of a grid of half elements over 2 x 1
    const auto number = [](int i, int j) { return std::to_string(100 * j + i + 1); };
    std::string deck = "*NODE\n";
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 8; ++i)
        if (quadratic ? (i % 2 == 0 || j % 2 == 0) : (i % 2 == 0 && j % 2 == 0))
          deck += number(i, j) + ", " + std::to_string(0.25 * i) + ", " + std::to_string(0.25 * j) + ", 0\n";
    deck += "*ELEMENT, TYPE=" + kind + ", ELSET=skin\n";
    int element = 0;
    for (int j = 0; j < 4; j += 2)
      for (int i = 0; i < 8; i += 2) {
        deck += std::to_string(++element);
        for (const auto& [a, b] : {std::pair{0, 0}, {2, 0}, {2, 2}, {0, 2}}) deck += ", " + number(i + a, j + b);
        if (quadratic)
          for (const auto& [a, b] : {std::pair{1, 0}, {2, 1}, {1, 2}, {0, 1}}) deck += ", " + number(i + a, j + b);
        deck += "\n";
      }
    const auto edge = [&](const std::string& name, int i) {
      deck += "*NSET, NSET=" + name + "\n";
      for (int j = 0; j <= 4; j += quadratic ? 1 : 2) deck += number(i, j) + (j < 4 ? ", " : "\n");
    };
    edge("root", 0), edge("tip", 8);
    deck +=
        "*MATERIAL, NAME=SOFT\n*ELASTIC\n2e9, 0\n*DENSITY\n1000,\n*MATERIAL, NAME=HARD\n*ELASTIC\n6e9, "
        "0\n*DENSITY\n1000,\n"
        "*SHELL SECTION, ELSET=skin, COMPOSITE\n0.005, , SOFT\n0.005, , HARD\n";
    own.write("deck.inp", deck);
    // the neutral plane is (6 - 2)/(6 + 2) h/4 above the middle: a force there does not bend
    auto at =
        at_rest(own,
                "bodies:\n  strip:\n    mesh: {file: {path: deck.inp}}\n    reduction: {modes: 4, attachment: all}\n"
                "joints: {clamp: {type: fixed, between: [ground, strip.root]}}\nloads:\n"
                "  pull: {type: force, at: strip.tip, force: [10, 0, 0]}\n"
                "  end: {type: moment, at: strip.tip, moment: [0, 0.0125, 0]}\nmotion: {end: 1, step: 1}\n",
                Formulation::lffr, "strip:1.1,0.5,0");
    const double stretch = 10 / (0.005 * 8e9);
    CHECK(at["membrane_force.xx"] == Approx(10).epsilon(1e-3));
    CHECK(at["stress_layer_1.xx"] == Approx(2e9 * stretch).epsilon(2e-3));
    CHECK(at["stress_layer_2.xx"] == Approx(6e9 * stretch).epsilon(2e-3));
    CHECK(at["stress_top.xx"] == Approx(6e9 * stretch).epsilon(2e-3));
    CHECK(at["stress_bottom.xx"] == Approx(2e9 * stretch).epsilon(2e-3));
    CHECK(at["von_mises"] == Approx(6e9 * stretch).epsilon(2e-3));
    CHECK(at["stress_min"] == Approx(0).margin(2e-3 * 6e9 * stretch));
  }
}

// 0.02 x 0.04: A = 8e-4, I = b h^3/12 = 1.0667e-7 about the axis across: N / A + M c / I.
TEST_CASE("stress: a beam in space and in the plane, at any attitude of formulation cfr") {
  const double I = 0.02 * std::pow(0.04, 3) / 12, bend = 0.03 * 1.1 * 0.02 / I, along = 5 / 8e-4;
  for (const auto formulation : {Formulation::cfr, Formulation::lffr, Formulation::vm_md}) {
    INFO(scene::name_of(formulation));
    const OwnFolder own;
    const std::string rest =
        "    reduction: {modes: 4, attachment: all}\n"
        "joints: {root: {type: fixed, between: [ground, beam.start]}}\nmotion: {end: 1, step: 1}\n";
    auto at = at_rest(own,
                      "bodies:\n  beam:\n    mesh: {line: {from: [0, 0, 0], to: [2, 0, 0], elements: 10}}\n"
                      "    section: {shape: rectangle, width: 0.02, height: 0.04, orientation: [0, 1, 0]}\n"
                      "    material: {E: 2e11, nu: 0.3, rho: 7800}\n" +
                          rest + "loads: {tip: {type: force, at: beam.end, force: [5, 0, -0.03]}}\n",
                      formulation, "beam:0.9,0,0");
    CHECK(at["section_force.N"] == Approx(5).epsilon(1e-3));
    CHECK(at["section_force.Vz"] == Approx(-0.03).epsilon(5e-3));
    CHECK(std::abs(at["section_moment_start.My"]) == Approx(0.03 * 1.2).epsilon(5e-3));
    CHECK(std::abs(at["section_moment_end.My"]) == Approx(0.03).epsilon(5e-3));
    CHECK(at["stress_max"] == Approx(along + 1.2 / 1.1 * bend).epsilon(5e-3));
    CHECK(at["stress_min"] == Approx(along - 1.2 / 1.1 * bend).margin(5e-3 * along));
    // up along y in the plane
    at = at_rest(own,
                 "bodies:\n  beam:\n    mesh: {line: {from: [0, 0], to: [2, 0], elements: 10}}\n"
                 "    section: {A: 8e-4, I: 1.0666666667e-7, fibre: 0.02}\n    material: {E: 2e11, rho: 7800}\n    "
                 "initial: {angle: pi/2}\n" +
                     rest + "loads: {tip: {type: force, at: beam.end, force: [0.03, 5]}}\n",
                 formulation, "beam:0.9,0,0");
    CHECK(at["section_force.N"] == Approx(5).epsilon(1e-3));
    CHECK(std::abs(at["section_moment_start.Mz"]) == Approx(0.03 * 1.2).epsilon(5e-3));
    CHECK(at["stress_max"] == Approx(along + 1.2 / 1.1 * bend).epsilon(5e-3));
  }
}

TEST_CASE("stress: corners, ends of clamped edges and points of loads are remarked beside the regular maximum") {
  const OwnFolder own;
  const std::string file =
      own.write("scene.yaml",
                "bodies:\n  plate:\n    mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [6, 6]}}\n"
                "    section: {thickness: 0.01}\n    material: {E: 7e10, nu: 0.3, rho: 2700}\n"
                "joints: {clamp: {type: fixed, between: [ground, plate.left]}}\n"
                "loads: {push: {type: force, at: {body: plate, node: [1, 1, 0]}, force: [0, 0, 5]}}\nmotion: {end: 1, "
                "step: 1}\n");
  const auto folder = own.results("out");
  printed([&] {
    app::solve_static(scene::read_scene(file), Formulation::lffr, PETSC_COMM_WORLD, {1, 1}, folder, false);
  });
  app::StressRequest request;
  request.folder = folder.path;
  const std::string said = printed([&] { app::stress(request, PETSC_COMM_WORLD); });
  CHECK_THAT(said, Contains("maximum") && Contains("elsewhere"));
  request.force = true;
  for (const auto& [place, why] :
       std::map<std::string, std::string>{{"plate", "names no body with stresses"},
                                          {"plate:1", "coordinates in the axes of its mesh"},
                                          {"plate:1,x,0", "coordinates in the axes of its mesh"},
                                          {"plate:1,0;0", "coordinates in the axes of its mesh"},
                                          {"plate:1,0,nan", "coordinates in the axes of its mesh"},
                                          {"plate:1,0,0,0", "has more than three coordinates"}}) {
    INFO(place);
    request.histories = {place};
    CHECK_THROWS_WITH(printed([&] { app::stress(request, PETSC_COMM_WORLD); }), Contains(why));
  }
  request.histories = {"plate:0.5,0.5"};  // two coordinates are enough
  CHECK_NOTHROW(printed([&] { app::stress(request, PETSC_COMM_WORLD); }));
}
