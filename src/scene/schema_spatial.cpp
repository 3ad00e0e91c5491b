#include "schema_parts.h"
#include "schema_ranges.h"

namespace floe::scene {
namespace {

const SchemaSection plate_section{
    "plate",
    "A parallelogram of shells. Places: left, right (the edges where `along` begins and ends), bottom, top (where "
    "`across` does), p1 to p4 (its corners, around).",
    "along: [2, 0, 0]\nacross: [0, 1, 0]\nelements: [40, 20]",
    {
        {"origin", Type::point, "m", "[0, 0, 0]", "the corner p1"},
        {"along", Type::point, "m", required, "from p1 to p2"},
        {"across", Type::point, "m", required, "from p1 to p4"},
        {"elements", Type::pair, "", required, "along and across", counts},
        {"cells",
         Type::choice,
         "",
         "triangles",
         "two triangles to each rectangle, or quadrilaterals",
         any,
         {"triangles", "quadrilaterals"}},
    }};

const SchemaSection file_section{
    "file",
    "Parts and places are physical groups (.msh) or element and node sets (.inp). A deck "
    "may bring its own sections and "
    "materials.",
    "path: wing.msh\nscale: 1e-3",
    {
        {"path", Type::text, "", required, "relative to the folder of the scene"},
        {"scale", Type::number, "", "1", "factor on all coordinates; not on what a deck says besides", positive},
    }};

const SchemaSection part_section{
    "part",
    "A part of a mesh in space, named by its key. What is absent comes from the body.",
    "section: {thickness: 2e-3}\nmaterial: {E: 7e10, nu: 0.33, rho: 2700}",
    {
        {"section", Type::section, "", "", "of shells or beams", any, {}, {}, "spatial section"},
        {"material", Type::section, "", "", "linearly elastic", any, {}, {}, "spatial material"},
    }};

const SchemaSection spatial_section_section{
    "spatial section",
    "Of a body or part in space. Shells: thickness, or plies. Beams: a shape with its measures, or A, Iy, Iz and J.",
    "shape: rectangle\nwidth: 0.02\nheight: 0.04\norientation: [0, 1, 0]",
    {
        {"thickness", Type::number, "m", "", "shells", positive},
        {"plies", Type::points, "m, deg", "", "shells: [thickness, angle] of each ply, from below; one material"},
        {"offset", Type::number, "m", "0", "shells: height of the middle above the nodes, along the normal"},
        {"axis", Type::point, "", "", "shells: direction of angle 0, projected on each element"},
        {"shape",
         Type::choice,
         "",
         "",
         "beams: width is along y, height along z",
         any,
         {"rectangle", "circle", "tube", "box", "i"}},
        {"width", Type::number, "m", "", "rectangle, box, i", positive},
        {"height", Type::number, "m", "", "rectangle, box, i", positive},
        {"radius", Type::number, "m", "", "circle; tube: outer", positive},
        {"wall", Type::number, "m", "", "tube, box; i: the web", positive},
        {"flange", Type::number, "m", "", "i", positive},
        {"A", Type::number, "m2", "", "beams without shape", positive},
        {"Iy", Type::number, "m4", "", "int z2", positive},
        {"Iz", Type::number, "m4", "", "int y2", positive},
        {"Iyz", Type::number, "m4", "0", "int y z"},
        {"J", Type::number, "m4", "", "torsion constant", positive},
        {"orientation", Type::point, "", "", "beams: the local y axis lies in the plane of the line and this vector"},
        {"centroid", Type::numbers, "m", "[0, 0]", "beams: [y, z] of the centroid from the line of the nodes"},
        {"shear_factor", Type::numbers, "", "",
         "beams: kappa of kappa G A (Timoshenko) along [y, z]; absent: sections stay normal"},
        {"wagner", Type::flag, "", "false", "beams: tension stiffens torsion"},
    }};

const SchemaSection spatial_material_section{
    "spatial material",
    "Isotropic: E and nu. Orthotropic shells: E1, E2, nu12 and G12.",
    "E: 7e10\nnu: 0.33\nrho: 2700",
    {
        {"E", Type::number, "N/m2", "", "Young's modulus", positive},
        {"nu", Type::number, "", "", "Poisson's ratio", {-1, 0.5, true, false}},
        {"G", Type::number, "N/m2", "", "shear modulus of beams; absent: E / (2 + 2 nu)", positive},
        {"E1", Type::number, "N/m2", "", "along axis 1", positive},
        {"E2", Type::number, "N/m2", "", "along axis 2", positive},
        {"nu12", Type::number, "", "", "strain in 2 to strain in 1", any},
        {"G12", Type::number, "N/m2", "", "in the plane", positive},
        {"rho", Type::number, "kg/m3", required, "density", nonnegative},
    }};

}  // namespace

const std::vector<SchemaSection>& spatial_sections() {
  static const std::vector<SchemaSection> all{plate_section, file_section, part_section, spatial_section_section,
                                              spatial_material_section};
  return all;
}

}  // namespace floe::scene
