#include <catch2/catch.hpp>

#include "spatial_scene.h"

using namespace floe;
using testing::faults_of;
using testing::one_body;
using Faults = std::vector<std::string>;

namespace {

Faults of_shell(const std::string& section, const std::string& material = testing::metal) {
  return faults_of(one_body(testing::plate, "    section: {" + section + "}\n" + material));
}
Faults of_beam(const std::string& section, const std::string& material = testing::metal) {
  return faults_of(one_body(testing::line, "    section: {" + section + "}\n" + material));
}
Faults with_joint(const std::string& place) {
  return faults_of(one_body(testing::plate, testing::thickness + testing::metal,
                            "joints: {j: {type: fixed, between: [ground, " + place + "]}}\n"));
}

const std::string section = "s.yaml:4:5: bodies.b.section", material = "s.yaml:5:5: bodies.b.material";
const std::string number = "a number or a formula of the parameters";

}  // namespace

TEST_CASE("a section is of shells or of beams") {
  const Faults expected{
      section +
      ": is a section neither of shells nor of beams, or of both; expected thickness or plies (shells), or shape "
      "or A (beams)"};
  CHECK(of_shell("thickness: 0.01, A: 1") == expected);
  CHECK(of_shell("thickness: 0.01, plies: [[1, 0]]") == expected);
  CHECK(of_shell("offset: 0.01") == expected);
}

TEST_CASE("keys that do not belong to the kind of section are refused") {
  CHECK(of_shell("thickness: 0.01, radius: 3, orientation: [0, 1, 0]") ==
        Faults{"s.yaml:4:40: bodies.b.section.radius: does not apply to shells; expected one of thickness, plies, "
               "offset, axis",
               "s.yaml:4:56: bodies.b.section.orientation: does not apply to shells; expected one of thickness, plies, "
               "offset, axis"});
  CHECK(of_beam("shape: circle, radius: 1, wall: 0.1, orientation: [0, 1, 0]") ==
        Faults{"s.yaml:4:47: bodies.b.section.wall: does not apply to shape circle; expected one of shape, radius, "
               "orientation, centroid, shear_factor, wagner"});
  CHECK(of_beam("shape: tube, radius: 1, thickness: 0.1, orientation: [0, 1, 0]").back() ==
        "s.yaml:4:50: bodies.b.section.thickness: does not apply to shape tube; expected one of shape, radius, wall, "
        "orientation, centroid, shear_factor, wagner");
  CHECK(of_beam("A: 1, Iy: 1, Iz: 1, J: 1, height: 2, orientation: [0, 1, 0]").at(0) ==
        "s.yaml:4:49: bodies.b.section.height: does not apply to beams without shape; expected one of A, Iy, Iz, Iyz, "
        "J, fibres, orientation, centroid, shear_factor, wagner");
}

TEST_CASE("materials are complete, of one kind, and know what the section needs") {
  const auto shell = [](const std::string& keys) {
    return of_shell("thickness: 0.01", "    material: {" + keys + "}\n");
  };
  CHECK(shell("E: 7e10, rho: 1") == Faults{material + ": has no nu; expected E and nu for shells"});
  CHECK(shell("rho: 1") == Faults{material + ": has no E; expected E and nu, or E1, E2, nu12 and G12"});
  CHECK(shell("E1: 1, rho: 1") == Faults{material + ": is not complete; expected E1, E2, nu12 and G12, or E and nu"});
  CHECK(shell("E: 1, E1: 1, E2: 1, nu12: 0.1, G12: 1, rho: 1") ==
        Faults{material + ": has E besides E1; expected E and nu, or E1, E2, nu12 and G12"});
  CHECK(shell("E: 1, nu: 0.3") == Faults{material + ".rho: is missing; expected " + number});
  CHECK(shell("E: 1, nu: 0.6, rho: 1") ==
        Faults{"s.yaml:5:26: bodies.b.material.nu: is 0.6; expected a number -1 < value <= 0.5"});
  const auto beam = [](const std::string& keys) {
    return of_beam("shape: circle, radius: 0.1, orientation: [0, 1, 0]", "    material: {" + keys + "}\n");
  };
  CHECK(beam("E: 7e10, rho: 1") == Faults{material + ": has neither nu nor G; expected one of them for beams"});
  CHECK(beam("E1: 10, E2: 1, nu12: 0.1, G12: 1, rho: 1") ==
        Faults{material + ": has no E; expected E with nu or G for beams",
               material + ": has neither nu nor G; expected one of them for beams"});
}

TEST_CASE("plies are pairs of a thickness and an angle") {
  CHECK(of_shell("plies: [[0.1], [0.1, 0, 3]], axis: [1, 0, 0]") ==
        Faults{"s.yaml:4:23: bodies.b.section.plies[1]: has length 1; expected a list of numbers",
               "s.yaml:4:30: bodies.b.section.plies[2]: has length 3; expected a list of numbers"});
  CHECK(of_shell("plies: [0.1]") ==
        Faults{"s.yaml:4:23: bodies.b.section.plies[1]: is \"0.1\"; expected a list of numbers"});
  CHECK(of_shell("plies: []") == Faults{section + ": a shell needs a ply"});
  CHECK(of_shell("plies: [[-0.1, 0]]") == Faults{section + ": a shell's thickness must be positive"});
  CHECK(of_shell("plies: [[0.1, 0]]", "    material: {E1: 10, E2: 1, nu12: 0.1, G12: 1, rho: 1}\n") ==
        Faults{section + ": an orthotropic shell needs an axis"});
}

TEST_CASE("beams name their measures and an orientation") {
  CHECK(of_beam("shape: i, height: 0.02, orientation: [0, 1, 0]") ==
        Faults{section + ".width: is missing; expected " + number, section + ".wall: is missing; expected " + number,
               section + ".flange: is missing; expected " + number});
  CHECK(of_beam("A: 1, Iz: 1, J: 1, orientation: [0, 1, 0]") ==
        Faults{section + ".Iy: is missing; expected " + number});
  CHECK(of_beam("shape: rectagle, orientation: [0, 1, 0]") ==
        Faults{"s.yaml:4:22: bodies.b.section.shape: is \"rectagle\"; expected one of rectangle, circle, tube, box, i; "
               "did you mean \"rectangle\"?"});
  CHECK(of_beam("shape: circle, radius: 0.1") ==
        Faults{section + ": has no orientation; expected a vector that orients the section of beams"});
  CHECK(of_beam("shape: circle, radius: 0.1, orientation: [0, 1, 0], centroid: [1]") ==
        Faults{"s.yaml:4:77: bodies.b.section.centroid: does not have two numbers; expected [y, z]"});
  CHECK(
      of_beam("shape: tube, radius: 0.01, wall: 0.02, orientation: [0, 1, 0]").at(0).starts_with(section + ": tube: "));
}

TEST_CASE("an orientation along the line or zero turns no section") {
  CHECK(of_beam("shape: circle, radius: 0.1, orientation: [3, 0, 0]") ==
        Faults{"s.yaml:2:3: bodies.b: a beam's orientation vector is parallel to the beam"});
  CHECK(of_beam("shape: circle, radius: 0.1, orientation: [0, 0, 0]") ==
        Faults{"s.yaml:2:3: bodies.b: a beam's orientation vector is zero"});
}

TEST_CASE("sections fit the cells of the mesh") {
  const Faults expected{
      "s.yaml:2:3: bodies.b: the element at (0, 0, 0) has a section of another kind: lines are beams, triangles and "
      "quadrilaterals shells"};
  CHECK(faults_of(one_body(testing::line, testing::thickness + testing::metal)) == expected);
  CHECK(faults_of(one_body(testing::plate, testing::tube + testing::metal)) == expected);
}

TEST_CASE("parts have sections and materials, and the mesh has them") {
  const auto faults = [](const std::string& keys) { return faults_of(one_body(testing::plate, keys)); };
  CHECK(
      faults(testing::thickness + testing::metal + "    parts: {plat: {section: {thickness: 0.1}}}\n") ==
      Faults{"s.yaml:6:20: bodies.b.parts.plat.section: the mesh has no part \"plat\"; expected one of plate; did you "
             "mean \"plate\"?"});
  CHECK(faults(testing::metal + "    parts: {plate: {}}\n") ==
        Faults{"s.yaml:5:13: bodies.b.parts.plate: has no section; expected section, here or in the body"});
  CHECK(faults(testing::thickness + "    parts: {plate: {}}\n") ==
        Faults{"s.yaml:5:13: bodies.b.parts.plate: has no material; expected material, here or in the body"});
  CHECK(faults(testing::thickness) == Faults{section + ": has no material; expected material, here or in the body"});
  CHECK(faults("") == Faults{"s.yaml:2:3: bodies.b: no section for part \"plate\" of the mesh; expected section, or "
                             "parts: {plate: ...}"});
}

TEST_CASE("a place that the mesh lacks: the nearest name, or the nearest node") {
  CHECK(with_joint("b.lefty") ==
        Faults{"s.yaml:7:45: joints.j.between[2]: b has no place \"lefty\"; expected one of bottom, centre, left, p1, "
               "p2, p3, p4, right, top or coordinates; did you mean \"left\"?"});
  CHECK(with_joint("{body: b, node: [0.1, 0, 0]}") ==
        Faults{"s.yaml:7:45: joints.j.between[2]: no node of b at (0.1, 0, 0); the nearest node is at (0, 0, 0)"});
  CHECK(with_joint("{body: b, node: [0.5, 0, 0]}").empty());
  CHECK(with_joint("c.left").at(0).starts_with("s.yaml:7:45: joints.j.between[2]: there is no body \"c\""));
}

TEST_CASE("frames in space: what pinned needs") {
  const auto faults = [](const std::string& frame) {
    return faults_of(one_body(testing::plate, testing::thickness + testing::metal + "    frame: " + frame + "\n"));
  };
  CHECK(faults("{type: pinned, from: left, to: right}") ==
        Faults{"s.yaml:6:5: bodies.b.frame: a pinned frame is defined by two nodes; expected places of one node each"});
  CHECK(faults("{type: pinned, from: p1, to: p1}") ==
        Faults{"s.yaml:6:5: bodies.b.frame: from and to are the same node; expected two different nodes"});
  CHECK(faults("pinned").at(0).starts_with("s.yaml:6:12: bodies.b.frame.from: b has no place \"start\""));
  for (const char* good : {"mean-axis", "{type: pinned, from: p1, to: p3}", "{type: clamped, at: left}"})
    CHECK(faults(good).empty());
}

TEST_CASE("generated meshes: faults of their keys and of their shape") {
  const auto faults = [](const std::string& mesh) {
    return faults_of(one_body(mesh, testing::thickness + testing::metal));
  };
  CHECK(faults("plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [4]}") ==
        Faults{"s.yaml:3:67: bodies.b.mesh.plate.elements: has length 1; expected two integers [i, j]"});
  CHECK(faults("plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [4, 0]}") ==
        Faults{"s.yaml:3:71: bodies.b.mesh.plate.elements[2]: is 0; expected an integer 1 <= value <= 100000000"});
  CHECK(faults("plate: {along: [2, 0, 0], across: [1, 0, 0], elements: [4, 2]}") ==
        Faults{"s.yaml:3:5: bodies.b.mesh: plate: edges a and b are parallel"});
  CHECK(faults("plate: {along: [2, 0], across: [1, 0, 0], elements: [4, 2]}")
            .at(0)
            .starts_with("s.yaml:3:27: bodies.b.mesh.plate.along: has length 2; expected three numbers [x, y, z]"));
  CHECK(faults("plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [4, 2], cells: quads}") ==
        Faults{"s.yaml:3:82: bodies.b.mesh.plate.cells: is \"quads\"; expected one of triangles, quadrilaterals"});
  CHECK(
      faults("file: {path: a.msh}, " + testing::plate) ==
      Faults{"s.yaml:3:5: bodies.b.mesh: has 2 shapes; expected exactly one of line, polyline, segments, plate, file"});
}

TEST_CASE("mesh files: missing, of another kind, in pieces") {
  const testing::Folder folder;
  const std::string scene = (folder.path / "s.yaml").string();
  const auto faults = [&](const std::string& path) {
    return faults_of(one_body("file: {path: " + path + "}", testing::thickness + testing::metal), scene);
  };
  const std::string mesh = scene + ":3:5: bodies.b.mesh", none = (folder.path / "none").string();
  CHECK(faults("none.msh") == Faults{mesh + ".file.path: there is no file \"" + none +
                                     ".msh\"; expected one relative to the scene's folder"});
  CHECK(faults("none.inp") == Faults{mesh + ".file.path: there is no file \"" + none +
                                     ".inp\"; expected one relative to the scene's folder"});
  CHECK(faults("none.stl") == Faults{mesh + ".file.path: is \"" + none +
                                     ".stl\"; expected a file that ends in .msh, .inp, .bdf, .nas or .dat"});
  CHECK(faults("none.bdf, instance: A") ==
        Faults{mesh + ".file.instance: is \"A\"; only decks of Abaqus (.inp) have instances"});
  folder.write("pieces.inp",
               "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 5, 0, 0\n5, 6, 0, 0\n6, 6, 1, 0\n7, 5, 1, 0\n"
               "*ELEMENT, TYPE=S3, ELSET=a\n1, 1, 2, 3\n*ELEMENT, TYPE=S4, ELSET=a\n2, 4, 5, 6, 7\n"
               "*MATERIAL, NAME=m\n*ELASTIC\n1, 0.3\n*DENSITY\n1\n*SHELL SECTION, ELSET=a, MATERIAL=m\n0.1\n");
  CHECK(faults("pieces.inp") ==
        Faults{mesh +
               ": the mesh has 2 unconnected parts (4 nodes about node 4, 3 nodes about node 1), so that 6 rigid "
               "motions are free; expected one connected mesh (join them by common nodes)"});
}

TEST_CASE("keys of the plane in space, and of space in the plane") {
  const Faults space = faults_of(one_body(testing::line, "    section: {A: 1, I: 2}\n" + testing::metal));
  REQUIRE(space.size() == 5);
  CHECK(space.back().starts_with("s.yaml:4:21: bodies.b.section.I: unknown key; expected one of thickness, plies,"));
  const std::string flat = "line: {from: [0, 0], to: [2, 0], elements: 4}";
  const Faults plane = faults_of(one_body(flat, testing::thickness + "    material: {E: 1, rho: 1}\n"));
  REQUIRE(plane.size() == 3);
  CHECK(plane.back() ==
        "s.yaml:4:15: bodies.b.section.thickness: unknown key; expected one of shape, width, height, radius, wall, "
        "flange, A, I, fibre, EA, EI, rhoA, rhoI, GA");
  CHECK(faults_of(one_body(flat, "    section: {EA: 1, EI: 1, rhoA: 1}\n    parts: {a: {}}\n")) ==
        Faults{"s.yaml:5:5: bodies.b.parts: does not apply here; expected this key only in spatial scenes"});
  CHECK(faults_of(one_body(testing::line, testing::tube + testing::metal + "    frame: {type: clamped, at: [0, 0]}\n"))
            .at(0)
            .starts_with("s.yaml:6:32: bodies.b.frame.at: has length 2"));
}

TEST_CASE("what bodies and joints in space do not know is refused, not left aside") {
  const auto with = [](const std::string& key) {
    return faults_of(one_body(testing::plate, testing::thickness + testing::metal + "    " + key + "\n"));
  };
  CHECK(with("rotary_inertia: false") ==
        Faults{"s.yaml:6:21: bodies.b.rotary_inertia: does not apply here; expected this key only in planar scenes"});
  CHECK(with("frames: 2").empty());
  CHECK(with("initial: {angle: 1}").size() == 1);
  CHECK(with("initial: {rotation: [0, 0, 1], angular_velocity: [1, 2, 3]}").empty());
  const auto joint = [](const std::string& keys) {
    return faults_of(one_body(testing::plate, testing::thickness + testing::metal, "joints: {j: {" + keys + "}}\n"));
  };
  CHECK(joint("type: prismatic, between: [ground, b.left]") ==
        Faults{"s.yaml:7:10: joints.j.axis: is missing; expected three numbers [x, y, z]"});
  CHECK(joint("type: universal, between: [ground, b.left], axis: [0, 0, 1]") ==
        Faults{"s.yaml:7:10: joints.j.second_axis: is missing; expected three numbers [x, y, z]"});
  CHECK(joint("type: universal, between: [ground, b.left], axis: [0, 0, 1], second_axis: [1, 0, 1]") ==
        Faults{"s.yaml:7:10: joints.j.second_axis: is not normal to axis; expected two axes that cross at 90 deg"});
  CHECK(joint("type: bushing, between: [ground, b.left]") ==
        Faults{"s.yaml:7:20: joints.j.type: has no stiffness and no viscosity; expected one of translation, rotation, "
               "translation_viscosity, rotation_viscosity"});
  CHECK(joint("type: revolute, between: [ground, b.left]").empty());
  CHECK(joint("type: revolute, between: [ground, b.p1], axis: [1, 0, 0]").empty());
  CHECK(joint("type: revolute, between: [ground, b.p1]") ==
        Faults{"s.yaml:7:10: joints.j.axis: is missing, and the joint's places are not straight edges, which would "
               "define it; "
               "expected three numbers [x, y, z]"});
}

TEST_CASE("joints that are known in space only are refused in the plane") {
  CHECK(
      faults_of("bodies:\n  b:\n    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}\n    section: {EA: 1, EI: 1, "
                "rhoA: 1}\njoints: {j: {type: spherical, between: [ground, b.start]}}\n") ==
      Faults{"s.yaml:5:20: joints.j.type: is spherical; expected fixed, revolute, prismatic, driven or spring in a "
             "planar scene"});
}

TEST_CASE("the ground's point and a body's are compared in all three coordinates") {
  const auto at = [](const std::string& point) {
    return faults_of(one_body(testing::line, testing::tube + testing::metal,
                              "joints: {j: {type: fixed, between: [{body: ground, node: " + point + "}, b.start]}}\n"));
  };
  CHECK(at("[0, 0, 0]").empty());
  REQUIRE(at("[0, 0, 7]").size() == 1);
  CHECK(at("[0, 0, 7]")[0].find("its places are 7 apart at the start") != std::string::npos);
}

TEST_CASE("a body's point is where its initial deformation takes it") {
  const auto at = [](const std::string& point) {
    return faults_of(one_body(testing::line,
                              testing::tube + testing::metal +
                                  "    initial: {deformation: [0, 0, \"0.02 + 0.01*x\"], rotation: [pi/2, 0, 0]}\n",
                              "joints: {j: {type: fixed, between: [{body: ground, node: " + point + "}, b.start]}}\n"));
  };
  CHECK(at("[0, -0.02, 0]").empty());
  REQUIRE(at("[0, 0, 0]").size() == 1);
  CHECK(at("[0, 0, 0]")[0].find("its places are 0.02 apart at the start") != std::string::npos);
}
