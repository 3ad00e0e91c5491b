#include "schema_parts.h"
#include "schema_ranges.h"

namespace floe::scene {
namespace {

const SchemaSection body_section{
    "body",
    "A structure of beams in one floating frame, named by its key (not `ground`).",
    "mesh: {line: {from: [0, 0], to: [L, 0], elements: 20}}\nsection: {A: 70, I: 585}\nmaterial: {E: 16000, rho: "
    "0.0078}\n"
    "frame: pinned\nreduction: {modes: 12}",
    {
        part("mesh", Type::section, required, "the undeformed shape, in the axes of the mesh", "mesh"),
        {"reduced", Type::text, "", "",
         "instead of all other keys but initial: a file that `floe reduce` wrote, relative to the folder of the "
         "scene; its places are those of the file"},
        part("section", Type::section, "",
             "cross-section, or stiffness and mass per length; in space: of all parts that `parts` does not name",
             "section"),
        part("material", Type::section, "", "absent: section gives EA, EI and rhoA", "material"),
        in_space(
            part("parts", Type::named_sections, "", "sections and materials of the mesh's parts, by name", "part")),
        choice("strain", "averaged",
               "membrane strain in an element: averaged over it (free of locking) or pointwise (locks)",
               {"averaged", "pointwise"}),
        choice("strains", "",
               "terms of second order in the strains: von_karman (squares of slopes in the membrane strain) or "
               "second_order (all of them: bending with torsion); in the plane and for shells von_karman alone; absent: "
               "von_karman",
               {"von_karman", "second_order"}),
        in_plane({"rotary_inertia", Type::flag, "", "true", "whether sections resist turning by rhoI"}),
        {"rigid", Type::flag, "", "false",
         "undeformable: EA and EI may be absent; frame, reduction, damping and deformation count nothing"},
        part("frame", Type::frame, "",
             "where the floating frame is attached; absent: in the plane pinned from start to end; in space mean-axis, "
             "but clamped for plates and meshes from files where a joint clamps them to the ground or to a rigid body",
             "frame"),
        {"frames", Type::integer, "", "1",
         "split a straight line into so many floating frames of the kind that `frame` says, joined rigidly; divides "
         "the "
         "elements",
         counts},
        part("reduction", Type::section, "", "the reduced basis", "reduction"),
        part("damping", Type::section, "", "absent: none", "damping"),
        part("initial", Type::section, "", "absent: at rest, undeformed, mesh axes on world axes", "initial"),
    }};

const SchemaSection mesh_section{
    "mesh",
    "The shape of a body: exactly one of these keys.",
    "line: {from: [0, 0], to: [100, 0], elements: 20}",
    {
        part("line", Type::section, "", "one straight line", "line"),
        part("polyline", Type::section, "", "straight segments, one after another", "polyline"),
        part("segments", Type::section, "", "a frame: points and the segments between them", "segments"),
        part("plate", Type::section, "", "a flat rectangle of shells, in space", "plate"),
        part("file", Type::section, "", "a mesh file, in space: Gmsh 4.1 (.msh) or a CalculiX/Abaqus deck (.inp)",
             "file"),
    }};

const SchemaSection line_section{"line",
                                 "Places: start, end, middle.",
                                 "from: [0, 0]\nto: [L, 0]\nelements: 20",
                                 {
                                     {"from", Type::point, "m", required, "place `start`"},
                                     {"to", Type::point, "m", required, "place `end`"},
                                     {"elements", Type::integer, "", required, "of equal length", counts},
                                 }};

const SchemaSection polyline_section{
    "polyline",
    "Places: start, end, middle, p1, p2, ... in the order of the points.",
    "points: [[0, 0], [1, 0], [1, 1]]\nelements: [10, 10]",
    {
        {"points", Type::points, "m", required, "at least two, all different"},
        {"elements", Type::integers, "", required, "of each segment, or one number for all", counts},
    }};

const SchemaSection segments_section{
    "segments",
    "Places: start (first point), end (last point), p1, p2, ...; all segments hang together.",
    "points: [[0, 0], [1, 0], [2, 0], [1, 1]]\njoin: [[1, 2], [2, 3], [2, 4]]\nelements: 10",
    {
        {"points", Type::points, "m", required, "at least two, all different"},
        {"join", Type::joins, "", required, "the two points of each segment, numbered from 1", counts},
        {"elements", Type::integers, "", required, "of each segment, or one number for all", counts},
    }};

const SchemaSection section_section{
    "section",
    "With `material`: A and I. Without: EA, EI and rhoA.",
    "A: 70\nI: 585",
    {
        {"A", Type::number, "m2", "", "area; with material", positive},
        {"I", Type::number, "m4", "", "second moment of area; with material", positive},
        {"EA", Type::number, "N", "", "axial stiffness; without material", positive},
        {"EI", Type::number, "N m2", "", "bending stiffness; without material", positive},
        {"rhoA", Type::number, "kg/m", "", "mass per length; without material", positive},
        {"rhoI", Type::number, "kg m", "", "rotary inertia per length; absent: rho I, or 0 without material",
         nonnegative},
        {"GA", Type::number, "N", "", "shear stiffness kappa G A (Timoshenko); absent: sections stay normal", positive},
    }};

const SchemaSection material_section{"material",
                                     "Linearly elastic.",
                                     "E: 2.1e11\nrho: 7850",
                                     {
                                         {"E", Type::number, "N/m2", required, "Young's modulus", positive},
                                         {"rho", Type::number, "kg/m3", required, "density", positive},
                                     }};

const SchemaSection frame_section{
    "frame",
    "What makes the elastic displacement unique. The type alone may stand for the section: `frame: clamped`.",
    "type: pinned\nfrom: start\nto: end",
    {
        choice("type", "pinned",
               "pinned: through two places; clamped: tangent at one; mean-axis: without momentum of the deformation",
               {"pinned", "clamped", "mean-axis"}),
        only({"pinned"}, {"from", Type::own_place, "", "start", "origin of the frame"}),
        only({"pinned"}, {"to", Type::own_place, "", "end", "a place on the x axis of the frame"}),
        only({"clamped"},
             {"at", Type::own_place, "", "start", "origin of the frame, which turns with the section there"}),
    }};

const SchemaSection reduction_section{
    "reduction",
    "The columns of the reduced basis.",
    "modes: {count: 12, of: joints}\nderivatives: [[1, 1], [1, 2], [2, 2]]\nderivative_type: static",
    {
        part("modes", Type::modes, "6", "vibration modes; an integer is their count", "modes"),
        {"derivatives", Type::derivatives, "", "all",
         "modal derivatives: all, none, so many (chosen by modal interaction), or pairs of modes [i, j], i <= j"},
        choice("derivative_type", "static", "static: inertia neglected; full: with inertia", {"static", "full"}),
        choice("attachment", "joints", "where static columns for unit forces are added",
               {"none", "joints", "loads", "all"}),
        {"interface", Type::own_places, "", "",
         "Craig-Bampton: places that the modes hold, each as one rigid piece, with a static column for each of its "
         "dofs"},
        {"columns", Type::texts, "", "",
         "only these of the columns and their derivatives, as summary.json names them: mode 1, attachment pin.moment, "
         "\"derivative 1,2\" (in quotation marks); not with derivatives"},
        choice("elastic_force", "von_karman",
               "of reduced models; linear: without the quadratic and cubic part, for motions that hardly bend",
               {"von_karman", "linear"}),
        {"drop_tolerance",
         Type::number,
         "",
         "1e-7",
         "columns that add less than this (relative) are dropped and reported",
         {0, 1, false, true}},
    }};

const SchemaSection modes_section{
    "modes",
    "Which vibration modes.",
    "count: 12\nof: joints\nalone: 17",
    {
        {"count", Type::integer, "", "6", "how many; the default is less for a mesh with fewer elastic dofs", {0, 1e5}},
        choice("of", "joints",
               "of the body as its joints hold it (converges), or under the conditions of its frame alone",
               {"joints", "frame"}),
        {"alone", Type::integer, "", "0", "how many in formulation vm; 0: as many as vm+md has columns", {0, 1e5}},
    }};

const SchemaSection damping_section{
    "damping",
    "Of vibrations: rigid motions that the joints leave free are not damped.",
    "stiffness: 1e-4\nmodal: [0.01, 0.01]",
    {
        {"mass", Type::number, "1/s", "0",
         "alpha: ratios alpha/(2 omega) of the modes of the body as its joints hold it", nonnegative},
        {"stiffness", Type::number, "s", "0", "beta: Kelvin-Voigt damping of the strain rates, ratios beta omega/2",
         nonnegative},
        {"modal", Type::numbers, "", "[]", "damping ratios of the first modes, with an interface those that hold it",
         nonnegative},
    }};

const SchemaSection initial_section{
    "initial",
    "Position and velocity of the axes of the mesh, deformation in them.",
    "position: [0, 1]\nangle: pi/2\nangular_velocity: 6\ndeformation: [0, \"0.01*sin(pi*x/L)\"]",
    {
        {"position", Type::point, "m", "", "of the mesh's origin, world axes; absent: 0"},
        in_plane({"angle", Type::number, "rad", "0", "of the mesh's axes, anticlockwise"}),
        in_space({"rotation", Type::point, "rad", "", "rotation vector of the mesh's axes, world axes; absent: 0"}),
        {"velocity", Type::point, "m/s", "", "of the mesh's origin, world axes; absent: 0"},
        {"angular_velocity", Type::turning, "rad/s", "0", "of the mesh's axes; in space a vector in world axes"},
        {"deformation", Type::formula_of_place, "m", "",
         "displacements of the mesh, in its axes; absent: undeformed; the frame goes along. Beams in space do not "
         "twist"},
        {"deformation_rate", Type::formula_of_place, "m/s", "", "their rates; absent: 0"},
    }};

}  // namespace

const std::vector<SchemaSection>& body_sections() {
  static const std::vector<SchemaSection> all{body_section,      mesh_section,    line_section,     polyline_section,
                                              segments_section,  section_section, material_section, frame_section,
                                              reduction_section, modes_section,   damping_section,  initial_section};
  return all;
}

}  // namespace floe::scene
