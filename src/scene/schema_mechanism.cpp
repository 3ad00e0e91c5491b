#include "schema_parts.h"
#include "schema_ranges.h"

namespace floe::scene {
namespace {

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
             in_space(choice(
                 "edges", "",
                 "rigid: a place of many nodes moves as one rigid piece; line: as a rigid line, about which "
                 "each node turns by itself (a hinge along a straight edge); mean: the weighted mean of its nodes is "
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
        only({"force", "moment"},
             {"at", Type::place, "", required,
              "where it acts; a place of many nodes shares it: edges by lengths, areas by areas, points alike"}),
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
         "polynomials; at least a hundredth of step",
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

const std::vector<SchemaSection>& mechanism_sections() {
  static const std::vector<SchemaSection> all{joint_section,  limits_section, load_section, place_section,
                                              motion_section, probe_section,  event_section};
  return all;
}

}  // namespace floe::scene
