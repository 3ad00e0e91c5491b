#include <algorithm>

#include "schema_parts.h"
#include "schema_ranges.h"

namespace floe::scene {
namespace {

const SchemaSection body_section{
    "body",
    "A flexible or rigid body (beams, in spatial scenes also shells) with one floating frame, named by its key (not "
    "`ground`).",
    "mesh: {line: {from: [0, 0], to: [L, 0], elements: 20}}\nsection: {A: 70, I: 585}\nmaterial: {E: 16000, rho: "
    "0.0078}\n"
    "frame: pinned\nreduction: {modes: 12}",
    {
        {"like", Type::text, "", "",
         "name of another body, all of whose keys this one has unless they are given here (a mapping or list as a "
         "whole). Bodies whose reduction is the same, also up to a rotation, are reduced once"},
        part("mesh", Type::section, "",
             "the undeformed shape in mesh axes; required except for rigid bodies with given mass", "mesh"),
        {"reduced", Type::text, "", "",
         "instead of all other keys except initial: a file written by `floe reduce`, relative to the folder of the "
         "scene; its places are those stored in the file"},
        part("section", Type::section, "",
             "cross-section, or stiffness and mass per length; in spatial scenes: of all parts not listed in `parts`",
             "section"),
        part("material", Type::section, "", "material; absent: the section has EA, EI and rhoA", "material"),
        in_space(part("parts", Type::named_sections, "",
                      "sections and materials of the mesh's parts by name; absent: section and material apply to all",
                      "part")),
        in_space(part("masses", Type::named_sections, "", "rigid masses at nodes by name; absent: none", "mass")),
        choice("strain", "averaged",
               "membrane strain of an element: averaged over its length (no membrane locking) or pointwise (locks)",
               {"averaged", "pointwise"}),
        choice(
            "strains", "",
            "terms of second order in the strains: von_karman (squares of slopes in the membrane strain) or "
            "second_order (beams: coupling of bending and torsion; shells: Green-Lagrange, in-plane gradients too, and "
            "second-order rotation of rigid regions); planar scenes have von_karman only; absent: von_karman in the "
            "plane, with strain: pointwise, and for flat, wide shells in space (floe check prints the numbers), else "
            "second_order",
            {"von_karman", "second_order"}),
        in_plane({"rotary_inertia", Type::flag, "", "true", "rotary inertia rhoI of the sections"}),
        part(
            "rigid", Type::rigid, "false",
            "rigid body: EA and EI may be absent; frame, reduction, damping and deformation have no effect. With mass, "
            "centre and inertia: these instead of those of the mesh, which may be absent together with section and "
            "material",
            "rigid"),
        part("frame", Type::frame, "",
             "conditions of the floating frame; absent: pinned from start to end in planar scenes; in spatial scenes "
             "mean-axis, but clamped for plates and meshes from files that a joint clamps to the ground or to a rigid "
             "body",
             "frame"),
        {"frames", Type::integer, "", "1",
         "number of floating frames into which the body is split, with rigid connections: a single line into equal "
         "parts, each with a frame of the kind given by `frame` (must divide the number of elements); in space any "
         "other "
         "mesh by planes across its longest extent, at existing nodes (unconnected parts of a slice have frames of "
         "their "
         "own)",
         counts},
        part("reduction", Type::section, "", "the reduced basis; absent: the defaults of `reduction`", "reduction"),
        part("damping", Type::section, "", "damping; absent: none", "damping"),
        part("initial", Type::section, "",
             "initial state; absent: at rest, undeformed, mesh axes parallel to world axes", "initial"),
    }};

const SchemaSection rigid_section{
    "rigid",
    "A rigid body by its mass, centre and inertia. Its places are `centre` and coordinates in mesh axes, and those of "
    "its mesh if it has one.",
    "mass: 12\ncentre: [0.1, 0, 0]\ninertia: [0.3, 0.4, 0.5]",
    {
        {"mass", Type::number, "kg", required, "mass", positive},
        {"centre", Type::point, "m", required, "centre of mass in mesh axes"},
        {"inertia", Type::inertia, "kg m2", required,
         "moment of inertia about the centre; in spatial scenes the tensor in mesh axes: Jxx, Jyy, Jzz, and where they "
         "are not zero Jxy, Jxz, Jyz (Jxy = -int rho x y)"},
    }};

const SchemaSection mass_section{
    "mass",
    "A rigid mass at a node of a body in a spatial scene, named by its key.",
    "at: end\nmass: 2\noffset: [0, 0, 0.1]",
    {
        {"at", Type::own_place, "", required, "place of one node, or a node's coordinates"},
        {"mass", Type::number, "kg", required, "mass", positive},
        {"inertia", Type::inertia, "kg m2", "",
         "inertia tensor about its centre in mesh axes: Jxx, Jyy, Jzz, and where they are not zero Jxy, Jxz, Jyz "
         "(Jxy = -int rho x y); absent: zero"},
        {"offset", Type::point, "m", "[0, 0, 0]", "of its centre from the node, mesh axes"},
    }};

const SchemaSection mesh_section{
    "mesh",
    "The shape of a body: exactly one of these keys.",
    "line: {from: [0, 0], to: [100, 0], elements: 20}",
    {
        part("line", Type::section, "", "one straight segment", "line"),
        part("polyline", Type::section, "", "consecutive straight segments", "polyline"),
        part("segments", Type::section, "", "a frame structure: points and the segments between them", "segments"),
        part("plate", Type::section, "", "a flat parallelogram of shells (spatial scenes)", "plate"),
        part("file", Type::section, "",
             "a mesh file (spatial scenes): Gmsh (.msh), a deck of CalculiX or Abaqus (.inp), or bulk data of Nastran "
             "(.bdf, .nas, .dat)",
             "file"),
    }};

const SchemaSection line_section{
    "line",
    "Places: start, end, middle.",
    "from: [0, 0]\nto: [L, 0]\nelements: 20",
    {
        {"from", Type::point, "m", required, "first point, place `start`"},
        {"to", Type::point, "m", required, "last point, place `end`"},
        {"elements", Type::integer, "", required, "number of elements of equal length", counts},
    }};

const SchemaSection polyline_section{
    "polyline",
    "Places: start, end, middle, p1, p2, ... in the order of the points.",
    "points: [[0, 0], [1, 0], [1, 1]]\nelements: [10, 10]",
    {
        {"points", Type::points, "m", required, "coordinates of at least two different points"},
        {"elements", Type::integers, "", required, "number of elements of each segment, or one number for all", counts},
    }};

const SchemaSection segments_section{
    "segments",
    "Places: start (first point), end (last point), p1, p2, ...; the segments must be connected.",
    "points: [[0, 0], [1, 0], [2, 0], [1, 1]]\njoin: [[1, 2], [2, 3], [2, 4]]\nelements: 10",
    {
        {"points", Type::points, "m", required, "coordinates of at least two different points"},
        {"join", Type::joins, "", required, "the two end points of each segment, numbered from 1", counts},
        {"elements", Type::integers, "", required, "number of elements of each segment, or one number for all", counts},
    }};

const SchemaSection section_section = with_shape(
    {"section",
     "Section of a beam in a planar scene. With `material`: shape, or A and I; without: EA, EI and rhoA.",
     "A: 70\nI: 585",
     {
         {"A", Type::number, "m2", "", "cross-sectional area; with material", positive},
         {"I", Type::number, "m4", "", "second moment of area; with material", positive},
         {"fibre", Type::number, "m", "",
          "distance of the extreme fibres from the line of centroids, for stresses (floe stress); with material",
          positive},
         {"EA", Type::number, "N", "", "axial stiffness; without material", positive},
         {"EI", Type::number, "N m2", "", "bending stiffness; without material", positive},
         {"rhoA", Type::number, "kg/m", "", "mass per length; without material", positive},
         {"rhoI", Type::number, "kg m", "", "rotary inertia per length; absent: rho I with material, 0 without",
          nonnegative},
         {"GA", Type::number, "N", "",
          "shear stiffness kappa G A (Timoshenko beam); absent: no shear deformation (Euler-Bernoulli beam)", positive},
     }},
    "shape of the section, its height in the plane; absent: A and I, or EA, EI and rhoA are given");

const SchemaSection material_section{"material",
                                     "Linear elastic material.",
                                     "E: 2.1e11\nrho: 7850",
                                     {
                                         {"E", Type::number, "N/m2", required, "Young's modulus", positive},
                                         {"rho", Type::number, "kg/m3", required, "density", positive},
                                     }};

const SchemaSection frame_section{
    "frame",
    "Conditions of the floating frame, which make the elastic displacement unique. The type may be given alone: "
    "`frame: clamped`.",
    "type: pinned\nfrom: start\nto: end",
    {
        choice("type", "pinned",
               "pinned: through two places; clamped: fixed to the section at one place; mean-axis: zero linear and "
               "angular momentum of the deformation",
               {"pinned", "clamped", "mean-axis"}),
        only({"pinned"}, {"from", Type::own_place, "", "start", "origin of the frame"}),
        only({"pinned"}, {"to", Type::own_place, "", "end", "place on the x axis of the frame"}),
        only({"clamped"},
             {"at", Type::own_place, "", "start", "origin of the frame, which rotates with the section there"}),
    }};

const SchemaSection reduction_section{
    "reduction",
    "The reduced basis.",
    "modes: {count: 12, of: joints}\nderivatives: [[1, 1], [1, 2], [2, 2]]\nderivative_type: static",
    {
        part("modes", Type::modes, "6",
             "vibration modes; an integer is their number; absent: 6, or the number of elastic dofs if that is smaller",
             "modes"),
        {"derivatives", Type::derivatives, "", "all",
         "modal derivatives: all, none, their number (selected by modal interaction), or a list of pairs of modes [i, "
         "j], i <= j"},
        choice("derivative_type", "static", "static: without inertia terms; full: with inertia terms",
               {"static", "full"}),
        choice("attachment", "joints", "places whose unit forces and moments give attachment modes",
               {"none", "joints", "loads", "all"}),
        {"interface", Type::own_places, "", "",
         "Craig-Bampton reduction: places that are fixed in the vibration modes, each a rigid region, with one "
         "constraint mode for each of its dofs; absent: none"},
        {"columns", Type::texts, "", "",
         "labels of the basis vectors to use, as in summary.json: mode 1, attachment pin.moment, \"derivative 1,2\" "
         "(in quotation marks); of a body in several frames of all its parts, or with # of one: \"#2 mode 1\"; not "
         "with derivatives; absent: all"},
        {"responses",
         Type::integer,
         "",
         "0",
         "number of residual responses in vm+md, beside the other basis vectors: static responses of the deformed body "
         "to the full-order residuals of a preliminary simulation of the scene's reduced model (see Choosing a model); "
         "needs motion",
         {0, 1e4}},
        choice("elastic_force", "von_karman",
               "elastic force of reduced models; linear: without quadratic and cubic terms, for small deflections",
               {"von_karman", "linear"}),
        {"products",
         Type::products,
         "",
         "",
         "products of two coordinates in the elastic force: all, or a share: products with a modal derivative are "
         "omitted as long as together they contribute at most this share of the displacement, at deformations of 5 % "
         "of "
         "the length of the body (see Choosing a model); absent: all",
         {0, 1, true, true}},
        {"interface_degree",
         Type::integer,
         "",
         "1",
         "of several frames: degree of the polynomials of the place that distribute three forces and three moments "
         "over "
         "the nodes of each cut (interface vectors); 0: resultants alone. Cuts of one node need none",
         {0, 6}},
        {"drop_tolerance",
         Type::number,
         "",
         "1e-7",
         "relative tolerance below which a basis vector is linearly dependent on the previous ones; such vectors are "
         "dropped and reported",
         {0, 1, false, true}},
    }};

const SchemaSection modes_section{
    "modes",
    "The vibration modes of the basis.",
    "count: 12\nof: joints\nalone: 17",
    {
        {"count",
         Type::integer,
         "",
         "6",
         "number of modes; the default is smaller for a mesh with fewer elastic dofs",
         {0, 1e5}},
        choice("of", "joints",
               "boundary conditions of the modes: joints: dofs constrained by the body's joints are fixed (better "
               "convergence); frame: only the conditions of its frame",
               {"joints", "frame"}),
        {"alone",
         Type::integer,
         "",
         "0",
         "number of modes in formulation vm; 0: the number of basis vectors of vm+md",
         {0, 1e5}},
    }};

const SchemaSection damping_section{
    "damping",
    "Damping of vibrations; free rigid-body motions are not damped.",
    "stiffness: 1e-4\nmodal: [0.01, 0.01]",
    {
        {"mass", Type::number, "1/s", "0",
         "alpha of Rayleigh damping: damping ratios alpha/(2 omega) of the modes of the body under its joints towards "
         "the ground (where no joint leads to the ground, towards a rigid body)",
         nonnegative},
        {"stiffness", Type::number, "s", "0",
         "beta of Rayleigh damping: Kelvin-Voigt damping of the strain rates, damping ratios beta omega/2",
         nonnegative},
        {"modal", Type::numbers, "", "[]",
         "damping ratios of the first modes of the body under its joints towards the ground (where no joint leads to "
         "the ground, towards a rigid body), which floe modes lists (with an interface: fixed-interface modes; with "
         "modes: {of: frame}: those); with several frames those of the body as a whole, which it lists with frames: 1",
         nonnegative},
    }};

const SchemaSection initial_section{
    "initial",
    "Initial position and velocity of the mesh axes, and deformation relative to them.",
    "position: [0, 1]\nangle: pi/2\nangular_velocity: 6\ndeformation: [0, \"0.01*sin(pi*x/L)\"]",
    {
        {"position", Type::point, "m", "", "position of the mesh origin, world axes; absent: zero"},
        in_plane({"angle", Type::number, "rad", "0", "rotation angle of the mesh axes, counterclockwise"}),
        in_space({"rotation", Type::point, "rad", "", "rotation vector of the mesh axes, world axes; absent: zero"}),
        {"velocity", Type::point, "m/s", "", "velocity of the mesh origin, world axes; absent: zero"},
        {"angular_velocity", Type::rotating, "rad/s", "0",
         "angular velocity of the mesh axes; in spatial scenes a vector in world axes"},
        {"deformation", Type::formula_of_place, "m", "",
         "initial displacement of the mesh in mesh axes, from which the position of the floating frame follows; beams "
         "in spatial scenes are not twisted by it; absent: undeformed"},
        {"deformation_rate", Type::formula_of_place, "m/s", "",
         "initial rate of the displacement, in mesh axes; absent: zero"},
    }};

}  // namespace

SchemaSection with_shape(SchemaSection section, const std::string& text) {
  const std::vector<Key> keys{
      {"shape", Type::choice, "", "", text, any, {"rectangle", "circle", "tube", "box", "i"}},
      {"width", Type::number, "m", "", "width of rectangle, box, i", positive},
      {"height", Type::number, "m", "", "height of rectangle, box, i", positive},
      {"radius", Type::number, "m", "", "radius of circle; outer radius of tube", positive},
      {"wall", Type::number, "m", "", "wall thickness of tube, box; web thickness of i", positive},
      {"flange", Type::number, "m", "", "flange thickness of i", positive}};
  const auto A = std::find_if(section.keys.begin(), section.keys.end(), [](const Key& key) { return key.name == "A"; });
  section.keys.insert(A, keys.begin(), keys.end());
  return section;
}

const std::vector<SchemaSection>& body_sections() {
  static const std::vector<SchemaSection> all{body_section,     rigid_section,    mass_section,      mesh_section,
                                              line_section,     polyline_section, segments_section,  section_section,
                                              material_section, frame_section,    reduction_section, modes_section,
                                              damping_section,  initial_section};
  return all;
}

}  // namespace floe::scene
