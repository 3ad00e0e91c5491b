#include "floe/scene/schema.h"

#include <cmath>

#include "schema_ranges.h"
#include "schema_spatial.h"

namespace floe::scene {
namespace {

Key part(const char* name, Type type, const char* fallback, const char* text, const char* section) {
  return {name, type, "", fallback, text, any, {}, {}, section};
}
Key choice(const char* name, const char* fallback, const char* text, std::vector<std::string> choices) {
  return {name, Type::choice, "", fallback, text, any, std::move(choices)};
}
Key in_plane(Key key) {
  key.dimension = 2;
  return key;
}
Key in_space(Key key) {
  key.dimension = 3;
  return key;
}
Key only(std::vector<std::string> kinds, Key key) {
  key.kinds = std::move(kinds);
  return key;
}

const SchemaSection scene_section{
    "scene",
    "The file: one mapping with these keys.",
    "title: Cantilever\nparameters: {L: 100, F: 2500}\ngravity: [0, -9.81]\nbodies: {...}\njoints: {...}\nloads: "
    "{...}\n"
    "motion: {...}\nprobes: {...}\nevents: {...}",
    {
        {"title", Type::text, "", "", "what the scene shows"},
        {"parameters", Type::parameters, "", "",
         "numbers by name, for use in every number and formula below; each may use those above it"},
        {"gravity", Type::formulas, "m/s2", "", "acceleration of gravity, world axes; absent: none"},
        part("ground", Type::section, "", "how the ground moves; absent: it stands", "ground"),
        {"share_frames", Type::flag, "", "true",
         "in space: a body that a fixed joint makes one with a rigid body has its frame, without coordinates and "
         "multipliers of its own; false: never"},
        part("bodies", Type::named_sections, required, "the bodies by name", "body"),
        part("joints", Type::named_sections, "", "the joints by name; absent: the bodies are free", "joint"),
        part("loads", Type::named_sections, "", "the loads by name", "load"),
        part("motion", Type::section, "", "how long and how finely; only commands that move nothing do without",
             "motion"),
        {"accuracy",
         Type::share,
         "",
         "",
         "greatest error of the probes against the full order of the same mesh, each as a vector, root mean square: "
         "floe run chooses columns, elastic force and step for it; absent: as the scene says",
         {0, 1, true, true}},
        part("probes", Type::named_sections, "", "what to record, by name", "probe"),
        part("events", Type::named_sections, "", "what happens once in the motion, by name", "event"),
    }};

const SchemaSection ground_section{
    "ground",
    "A ground that shakes without turning. The world's axes go with it: positions and velocities are those that one "
    "sees "
    "who stands on it, and all that has mass feels the opposite acceleration.",
    "acceleration: [0, \"3*sin(20*t)\"]",
    {
        {"acceleration", Type::formulas, "m/s2", "", "of the ground, along the world's axes; absent: none"},
    }};

const SchemaSection limits_section{
    "limits",
    "Stops: beyond a limit a spring pushes back. Its force sets in like a parabola over the width and is linear "
    "behind; "
    "the damping sets in likewise.",
    "lower: -pi/4\nupper: pi/4\nstiffness: 1e4",
    {
        {"lower", Type::number, "rad; m", "", "since the start; absent: none"},
        {"upper", Type::number, "rad; m", "", "since the start; absent: none"},
        {"stiffness", Type::number, "N m/rad; N/m", required, "behind the width", positive},
        {"damping", Type::number, "N m s/rad; N s/m", "0", "behind the width", nonnegative},
        {"width", Type::number, "rad; m", "",
         "over which the force sets in; absent: a thousandth of a radian, or of the scene's extent", positive},
    }};

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
        in_plane({"rotary_inertia", Type::flag, "", "true", "whether sections resist turning by rhoI"}),
        {"rigid", Type::flag, "", "false",
         "undeformable: EA and EI may be absent; frame, reduction, damping and deformation count nothing"},
        part("frame", Type::frame, "",
             "where the floating frame is attached; absent: pinned from start to end; in space clamped where the "
             "ground holds the body, else mean-axis",
             "frame"),
        {"frames", Type::integer, "", "1",
         "split a straight line into so many floating frames, joined rigidly; divides the elements. In space they are "
         "pinned ones unless `frame` says otherwise",
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
         "1e-9",
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
    "Linear, of the elastic coordinates.",
    "stiffness: 1e-4\nmodal: [0.01, 0.01]",
    {
        {"mass", Type::number, "1/s", "0", "Rayleigh alpha", nonnegative},
        {"stiffness", Type::number, "s", "0", "Rayleigh beta", nonnegative},
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
         "displacements of the mesh, in its axes; absent: undeformed; the frame goes along. Beams in space do not twist"},
        {"deformation_rate", Type::formula_of_place, "m/s", "", "their rates; absent: 0"},
    }};

const SchemaSection joint_section{
    "joint",
    "Holds two places together, named by its key. In the plane: fixed, revolute, prismatic, driven, spring.",
    "type: revolute\nbetween: [ground, arm.start]\naxis: [0, 0, 1]",
    {
        choice("type", required,
               "fixed: clamp; revolute: hinge; prismatic: slides along axis; driven: hinge with given angle; spring: "
               "with dampers; cylindrical: slides along axis and turns about it; spherical: ball; universal: two "
               "crossing axes; planar: slides across axis and turns about it; distance: keeps its length; "
               "driven_slide: prismatic with given position; bushing: springs along and about three axes",
               {"fixed", "revolute", "prismatic", "driven", "spring", "cylindrical", "spherical", "universal", "planar",
                "distance", "driven_slide", "bushing"}),
        {"between", Type::places, "", required,
         "`ground` alone is the point of the ground that meets the other place at the start"},
        only({"fixed", "revolute", "prismatic", "driven", "cylindrical", "spherical", "universal", "planar",
              "driven_slide"},
             in_space(choice("edges", "",
                             "rigid: a place of many nodes moves as one rigid piece; line: as a rigid line, about which "
                             "each node turns by itself (a hinge along a straight edge); mean: the mean of its nodes is "
                             "held. Absent: rigid where the joint holds all rotations, line at revolute and cylindrical "
                             "joints along a straight edge, else mean. To the ground, fixed and driven joints hold every "
                             "node, and a hinge with edges: mean the displacements of its edge",
                             {"rigid", "mean", "line"}))),
        only({"driven"}, {"angle", Type::formula, "rad", "",
                          "turn of the second place against the first since the start; 0 at t = 0"}),
        only({"driven_slide"}, {"position", Type::formula, "m", "",
                                "of the second place from the first along axis since the start; 0 at t = 0"}),
        only({"driven", "driven_slide"},
             {"speed", Type::formula, "rad/s; m/s", "", "in place of angle or position: its rate, of any formula"}),
        only({"revolute", "prismatic", "cylindrical"},
             part("limits", Type::section, "", "stops, of the slide where there is one, else of the turn", "limits")),
        only({"cylindrical"}, in_space(part("turn_limits", Type::section, "", "stops of the turn", "limits"))),
        only({"prismatic", "revolute", "driven", "cylindrical", "universal", "planar", "driven_slide", "spring"},
             {"axis", Type::point, "", "",
              "at the start, world axes; turns with the first place. Absent: of prismatic x, of a hinge in space the "
              "line of its nodes. Of a spring in space: about which it is torsional"}),
        only({"universal"}, in_space({"second_axis", Type::point, "", "",
                                      "at the start, world axes; turns with the second place; required"})),
        only({"spring"}, {"stiffness", Type::number, "N/m", "0", "along the line between the places", nonnegative}),
        only({"spring"}, {"viscosity", Type::number, "N s/m", "0", "along the line between the places", nonnegative}),
        only({"spring"},
             {"length", Type::number, "m", "", "unstretched; absent: the distance at the start", nonnegative}),
        only({"spring"},
             {"torsional_stiffness", Type::number, "N m/rad", "0", "against turning from the start", nonnegative}),
        only({"spring"}, {"torsional_viscosity", Type::number, "N m s/rad", "0", "against turning", nonnegative}),
        only({"bushing"}, {"translation", Type::numbers, "N/m", "[0, 0, 0]",
                           "along x, y, z, unstretched at the start; axes as at the start in the "
                           "world, carried by the first place",
                           nonnegative}),
        only({"bushing"},
             {"rotation", Type::numbers, "N m/rad", "[0, 0, 0]", "about x, y, z, by less than a turn", nonnegative}),
        only({"bushing"}, {"translation_viscosity", Type::numbers, "N s/m", "[0, 0, 0]", "along x, y, z", nonnegative}),
        only({"bushing"},
             {"rotation_viscosity", Type::numbers, "N m s/rad", "[0, 0, 0]", "about x, y, z", nonnegative}),
    }};

const SchemaSection load_section{
    "load",
    "A force or moment that depends on time, named by its key.",
    "type: force\nat: beam.end\nforce: [0, \"F*sin(9.5*t)\"]",
    {
        choice("type", required, "at a place, distributed along all segments of a body, or pressure on its shells",
               {"force", "moment", "distributed", "pressure"}),
        only({"force", "moment"}, {"at", Type::place, "", required, "where it acts"}),
        only({"distributed", "pressure"}, {"body", Type::body, "", required, "on which it acts"}),
        only({"pressure"}, in_space({"part", Type::text, "", "", "of the mesh, on which it acts; absent: all shells"})),
        only({"pressure"},
             in_space({"pressure", Type::formula, "N/m2", required, "positive along the shells' normals"})),
        only({"pressure"}, in_space({"follower", Type::flag, "", "true",
                                     "whether it stays normal to the shells as they bend and move, or keeps the "
                                     "direction that it has at the start"})),
        only({"force", "distributed"},
             {"force", Type::formulas, "N; N/m", required, "components, per length if distributed"}),
        only({"moment"}, {"moment", Type::moment, "N m", required, "anticlockwise; in space about x, y, z"}),
        only({"force", "moment", "distributed"},
             choice("axes", "world",
                    "of the components; body: they turn with the floating frame; place: with the place (in space)",
                    {"world", "body", "place"})),
    }};

const SchemaSection motion_section{
    "motion",
    "From t = 0.",
    "end: 3\nstep: 1e-3",
    {
        {"end", Type::number, "s", required, "last time", positive},
        {"step", Type::number, "s", required, "time step (the first one, with tolerance); at most end", positive},
        {"spectral_radius", Type::number, "", "0.8", "at infinite frequency; 0 damps most", {0, 1, false, true}},
        {"tolerance",
         Type::number,
         "",
         "",
         "relative error a step, by which the step is adapted; absent: steps are equal",
         {0, 1, true, true}},
        {"every", Type::integer, "", "1", "store each so many steps", counts},
        {"output", Type::number, "s", "",
         "store at multiples of this time instead, whatever the steps: between them by the integrator's cubic "
         "polynomials",
         positive},
    }};

const SchemaSection probe_section{
    "probe",
    "What is recorded at a place, named by its key.",
    "at: beam.end\nquantity: displacement",
    {
        {"at", Type::place, "", required, "where"},
        choice("quantity", "displacement",
               "position, displacement since the start, velocity: world axes; deflection: in "
               "the floating frame; rotation of the section (in space a rotation vector, of half a turn at most)",
               {"position", "displacement", "deflection", "velocity", "rotation"}),
        {"relative_to", Type::place, "", "",
         "measured from this place, in axes that turn with its section; absent: world"},
    }};

const SchemaSection event_section{
    "event",
    "Exactly one of unlock, lock, stop, and exactly one of at, when, probe.",
    "unlock: clamp\nat: 1.5",
    {
        {"unlock", Type::text, "", "", "a joint that lets go; of one that an event locks: the lock alone"},
        {"lock", Type::text, "", "",
         "a joint whose places are held as they are then; velocities go to the nearest ones that fit, in kinetic "
         "energy (a plastic impact), and its impulses are reported"},
        {"stop", Type::flag, "", "false", "the motion ends"},
        {"at", Type::number, "s", "", "when it happens", nonnegative},
        {"when", Type::formula, "", "", "it happens where this formula of t first changes sign"},
        {"probe", Type::text, "", "", "it happens where this column of probes.csv, as tip.y, passes `crosses`"},
        {"crosses", Type::number, "", "0", "in the unit of the probe"},
    }};

const SchemaSection place_section{
    "place",
    "A node: `beam.end` (body.name; names under line, polyline and segments), `ground`, or this mapping.",
    "body: beam\nnode: [50, 0]",
    {
        {"body", Type::body, "", required, "or ground"},
        {"node", Type::point, "m", required,
         "a node's coordinates in mesh axes, any point's of a rigid body; world axes on the ground"},
    }};

}  // namespace

const std::vector<SchemaSection>& schema() {
  static const std::vector<SchemaSection> all = [] {
    std::vector<SchemaSection> sections{
        scene_section,    ground_section,  body_section,     mesh_section,   line_section,      polyline_section,
        segments_section, section_section, material_section, frame_section,  reduction_section, modes_section,
        damping_section,  initial_section, joint_section,    limits_section, load_section,      place_section,
        motion_section,   probe_section,   event_section};
    for (const SchemaSection& section : spatial_sections()) sections.push_back(section);
    return sections;
  }();
  return all;
}

}  // namespace floe::scene
