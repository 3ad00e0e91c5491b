#include "schema_parts.h"
#include "schema_ranges.h"

namespace floe::scene {
namespace {

const SchemaSection plate_section{
    "plate",
    "A parallelogram of shells. Places: left, right (edges at the start and end of `along`), bottom, top (edges at the "
    "start and end of `across`), p1 to p4 (corners, counterclockwise).",
    "along: [2, 0, 0]\nacross: [0, 1, 0]\nelements: [40, 20]",
    {
        {"origin", Type::point, "m", "[0, 0, 0]", "corner p1"},
        {"along", Type::point, "m", required, "vector from p1 to p2"},
        {"across", Type::point, "m", required, "vector from p1 to p4"},
        {"elements", Type::pair, "", required, "number of elements along `along` and `across`", counts},
        {"cells",
         Type::choice,
         "",
         "triangles",
         "shape of the elements: two triangles per rectangle, or quadrilaterals",
         any,
         {"triangles", "quadrilaterals"}},
    }};

const SchemaSection file_section{
    "file",
    "A mesh from a file. Parts and places are physical groups (.msh), element and node sets (.inp), or properties and "
    "SPC sets (.bdf, .nas, .dat). A deck may "
    "contain its own sections and materials.",
    "path: wing.msh\nscale: 1e-3",
    {
        {"path", Type::text, "", required, "path of the file, relative to the folder of the scene"},
        {"scale", Type::number, "", "1",
         "factor on all coordinates and offsets of beams and masses, but not on sections, materials and masses of a "
         "deck",
         positive},
        {"ignore", Type::texts, "", "",
         "decks: types of elements that are left out with the nodes that only they use, as C3D20R or CTETRA"},
        {"instance", Type::text, "", "",
         "decks of Abaqus with several instances: name of the one that becomes the body"},
        {"refine",
         Type::integer,
         "",
         "0",
         "how many times all elements are halved, on the curves and surfaces that they form: 1 for elements half as "
         "long, four times as many shells",
         {0, 8}},
    }};

const SchemaSection part_section{"part",
                                 "A part of a spatial mesh, named by its key. Absent keys are taken from the body.",
                                 "section: {thickness: 2e-3}\nmaterial: {E: 7e10, nu: 0.33, rho: 2700}",
                                 {
                                     {"section",
                                      Type::section,
                                      "",
                                      "",
                                      "section of shells or beams; absent: that of the body",
                                      any,
                                      {},
                                      {},
                                      "spatial section"},
                                     {"material",
                                      Type::section,
                                      "",
                                      "",
                                      "linear elastic material; absent: that of the body",
                                      any,
                                      {},
                                      {},
                                      "spatial material"},
                                 }};

const SchemaSection spatial_section_section = with_shape(
    {"spatial section",
     "Section of a body or part in a spatial scene. Shells: thickness, or plies. Beams: a shape with its dimensions, "
     "or A, Iy, Iz and J.",
     "shape: rectangle\nwidth: 0.02\nheight: 0.04\norientation: [0, 1, 0]",
     {
         {"thickness", Type::number, "m", "", "shells: thickness", positive},
         {"plies", Type::pairs, "m, deg", "",
          "shells: [thickness, angle] of each ply from the bottom; all of the same material"},
         {"offset", Type::number, "m", "0", "shells: offset of the midsurface from the nodes along the normal"},
         {"axis", Type::point, "", "",
          "shells: direction of ply angle 0, projected onto each element; required for orthotropic materials"},
         {"A", Type::number, "m2", "", "cross-sectional area of beams without shape", positive},
         {"Iy", Type::number, "m4", "", "second moment of area, int z2 dA", positive},
         {"Iz", Type::number, "m4", "", "second moment of area, int y2 dA", positive},
         {"Iyz", Type::number, "m4", "0", "product moment of area, int y z dA"},
         {"J", Type::number, "m4", "", "torsion constant", positive},
         {"fibres", Type::pairs, "m", "",
          "beams without shape: [y, z] of the extreme fibres from the centroid, for stresses (floe stress)"},
         {"orientation", Type::point, "", "",
          "beams: the local y axis lies in the plane of the beam axis and this vector; required for beams"},
         {"centroid", Type::numbers, "m", "[0, 0]", "beams: [y, z] of the centroid relative to the line of the nodes"},
         {"shear_factor", Type::numbers, "", "",
          "beams: shear correction factors kappa of kappa G A (Timoshenko beam) along [y, z]; absent: no shear "
          "deformation"},
         {"wagner", Type::flag, "", "false", "beams: Wagner term, torsional stiffening by axial force"},
     }},
    "beams: shape of the section; width along y, height along z; absent: A, Iy, Iz and J are given");

const SchemaSection spatial_material_section{
    "spatial material",
    "Linear elastic material in a spatial scene. Isotropic: E and nu. Orthotropic shells: E1, E2, nu12 and G12.",
    "E: 7e10\nnu: 0.33\nrho: 2700",
    {
        {"E", Type::number, "N/m2", "", "Young's modulus", positive},
        {"nu", Type::number, "", "", "Poisson's ratio", {-1, 0.5, true, false}},
        {"G", Type::number, "N/m2", "", "shear modulus of beams; absent: E / (2 + 2 nu)", positive},
        {"E1", Type::number, "N/m2", "", "Young's modulus along axis 1", positive},
        {"E2", Type::number, "N/m2", "", "Young's modulus along axis 2", positive},
        {"nu12", Type::number, "", "", "Poisson's ratio, minus strain in 2 over strain in 1 for stress along 1", any},
        {"G12", Type::number, "N/m2", "", "in-plane shear modulus", positive},
        {"rho", Type::number, "kg/m3", required, "density", nonnegative},
    }};

}  // namespace

const std::vector<SchemaSection>& spatial_sections() {
  static const std::vector<SchemaSection> all{plate_section, file_section, part_section, spatial_section_section,
                                              spatial_material_section};
  return all;
}

}  // namespace floe::scene
