#include "schema_parts.h"
#include "schema_ranges.h"

namespace floe::scene {
namespace {

const SchemaSection limits_section{
    "limits",
    "Elastic end stops: beyond a limit a spring force acts. Over the width it grows quadratically, beyond it linearly; "
    "the damping constant grows over the width to its value, at a share s of it by s^2 (3 - 2 s).",
    "lower: -pi/4\nupper: pi/4\nstiffness: 1e4",
    {
        {"lower", Type::number, "rad; m", "", "relative to the initial configuration; absent: none"},
        {"upper", Type::number, "rad; m", "", "relative to the initial configuration; absent: none"},
        {"stiffness", Type::number, "N m/rad; N/m", required, "stiffness beyond the width", positive},
        {"damping", Type::number, "N m s/rad; N s/m", "0", "viscous damping beyond the width", nonnegative},
        {"width", Type::number, "rad; m", "",
         "range over which the force grows quadratically; absent: 0.001 rad, or 0.001 of the scene's overall size",
         positive},
    }};

const SchemaSection friction_section{
    "friction",
    "Dry friction, regularised, and viscous friction, opposite to the rate of the joint: level tanh(rate / speed) + "
    "viscosity rate. Its level does not depend on the joint's reactions.",
    "level: 0.4\nspeed: 1e-3",
    {
        {"level", Type::number, "N m; N", "0", "moment or force of dry friction", nonnegative},
        {"speed", Type::number, "rad/s; m/s", required,
         "rate at which 76 % of the level is reached; a joint that sticks creeps below it", positive},
        {"viscosity", Type::number, "N m s/rad; N s/m", "0", "viscous friction", nonnegative},
    }};

const SchemaSection joint_section{
    "joint",
    "Connects two places, named by its key. Types in planar scenes: fixed, revolute, prismatic, driven, spring.",
    "type: revolute\nbetween: [ground, arm.start]\naxis: [0, 0, 1]",
    {
        like("joint"),
        choice("type", required,
               "fixed: no relative motion; revolute: rotation about axis; prismatic: translation along axis; driven: "
               "revolute with prescribed angle; spring: spring and damper; cylindrical: translation along axis and "
               "rotation about it; spherical: all rotations; universal: rotation about two orthogonal axes; planar: "
               "translation normal to axis and rotation about it; distance: constant distance; driven_slide: prismatic "
               "with prescribed position; bushing: springs and dampers along and about three axes; support: components "
               "of every node "
               "held by the ground, for edges of plates",
               {"fixed", "revolute", "prismatic", "driven", "spring", "cylindrical", "spherical", "universal", "planar",
                "distance", "driven_slide", "bushing", "support"}),
        {"between", Type::places, "", required,
         "the two connected places; `ground` alone is the point of the ground that coincides with the other place at "
         "the start"},
        only(
            {"fixed", "revolute", "prismatic", "driven", "cylindrical", "spherical", "universal", "planar",
             "driven_slide"},
            in_space(choice("edges", "",
                            "coupling of a place of several nodes; rigid: a rigid region; line: a line hinge along a "
                            "straight edge, about which each node rotates freely; mean: the weighted mean of its nodes "
                            "is constrained. Absent: rigid where the joint constrains all rotations, line at revolute "
                            "and cylindrical joints along a straight edge, else mean. To the ground, fixed and driven "
                            "joints fix every node, and a hinge with edges: mean fixes the displacements of its edge",
                            {"rigid", "mean", "line"}))),
        only({"support"}, in_space({"hold", Type::texts, "", "",
                                    "displacements x, y, z and rotations rx, ry, rz of every node that are zero, in "
                                    "mesh axes; together with the other joints to the ground they leave the body no "
                                    "rigid motion; required unless straight is given"})),
        only({"support"}, in_space({"straight", Type::texts, "", "",
                                    "displacements x, y, z, normal to a straight edge of shells, that vary linearly "
                                    "along it: an edge that moves and remains straight (movable straight edge)"})),
        only({"driven"}, {"angle", Type::formula, "rad", "",
                          "rotation angle of the second place relative to the first since the start; 0 at t = 0; "
                          "required unless speed is given"}),
        only({"driven_slide"}, {"position", Type::formula, "m", "",
                                "displacement of the second place relative to the first along axis since the start; 0 "
                                "at t = 0; required unless speed is given"}),
        only({"driven", "driven_slide"},
             {"speed", Type::formula, "rad/s; m/s", "", "prescribed rate instead of angle or position"}),
        only(
            {"revolute", "prismatic", "cylindrical"},
            part("limits", Type::section, "",
                 "end stops of the translation where the joint has one, else of the rotation; absent: none", "limits")),
        only({"cylindrical"},
             in_space(part("turn_limits", Type::section, "", "end stops of the rotation; absent: none", "limits"))),
        only({"revolute", "prismatic", "cylindrical"},
             part("friction", Type::section, "",
                  "friction of the translation where the joint has one, else of the rotation; absent: none",
                  "friction")),
        only({"cylindrical"},
             in_space(part("turn_friction", Type::section, "", "friction of the rotation; absent: none", "friction"))),
        only({"prismatic", "revolute", "driven", "cylindrical", "universal", "planar", "driven_slide", "spring"},
             {"axis", Type::point, "", "",
              "direction at the start in world axes; rotates with the first place. For a spring in spatial scenes: "
              "axis of its torsional stiffness. Absent: x for prismatic in planar scenes; in spatial scenes the line "
              "of the nodes for a hinge along an edge"}),
        only({"universal"},
             in_space(
                 {"second_axis", Type::point, "", "",
                  "direction at the start in world axes, normal to axis; rotates with the second place; required"})),
        only({"spring"},
             {"stiffness", Type::number, "N/m", "0", "stiffness along the line between the places", nonnegative}),
        only({"spring"}, {"viscosity", Type::number, "N s/m", "0", "viscous damping along the line between the places",
                          nonnegative}),
        only({"spring"},
             {"length", Type::number, "m", "", "unstretched length; absent: the distance at the start", nonnegative}),
        only({"spring"}, {"torsional_stiffness", Type::number, "N m/rad", "0",
                          "torsional stiffness, relative to the initial rotation", nonnegative}),
        only({"spring"},
             {"torsional_viscosity", Type::number, "N m s/rad", "0", "torsional viscous damping", nonnegative}),
        only({"spring"},
             {"preload", Type::number, "N", "0", "tension at the start, instead of length; negative: compression"}),
        only({"spring"}, {"rest_angle", Type::number, "rad", "0",
                          "rotation since the start at which the torsional spring is relaxed: its moment at the start "
                          "is torsional_stiffness rest_angle, towards it"}),
        only({"bushing"}, {"translation", Type::numbers, "N/m", "[0, 0, 0]",
                           "stiffness along x, y, z, unstretched at the start; axes are the world axes at the start "
                           "and rotate with the first place",
                           nonnegative}),
        only({"bushing"}, {"rotation", Type::numbers, "N m/rad", "[0, 0, 0]",
                           "stiffness about x, y, z, for rotations below 1.6 pi", nonnegative}),
        only({"bushing"}, {"translation_viscosity", Type::numbers, "N s/m", "[0, 0, 0]",
                           "viscous damping along x, y, z", nonnegative}),
        only({"bushing"}, {"rotation_viscosity", Type::numbers, "N m s/rad", "[0, 0, 0]",
                           "viscous damping about x, y, z, of the rate of the rotation vector", nonnegative}),
    }};

const SchemaSection load_section{
    "load",
    "A force, moment or pressure, named by its key. Loads may depend on sensors: "
    "in their formulas JOINT.angle and JOINT.rate (hinges, springs), JOINT.travel and JOINT.speed (slides), "
    "JOINT.length and JOINT.length_rate (springs), and PROBE.COMPONENT, as tip.x, of probes of positions, "
    "displacements, rotations and their rates are numbers.",
    "type: moment\njoint: elbow\nmoment: \"-k*(elbow.angle - ref(t)) - d*elbow.rate\"",
    {
        like("load"),
        choice("type", required,
               "force or moment at a place, force distributed along all beams of a body, or pressure on its shells",
               {"force", "moment", "distributed", "pressure"}),
        only({"force", "moment"}, {"at", Type::place, "", "",
                                   "where it acts; at a place of several nodes it is distributed: over edges by "
                                   "length, over areas by area, over points equally. Exactly one of at, joint"}),
        only({"force", "moment"},
             {"joint", Type::text, "", "",
              "instead: name of a joint between whose places it acts: a moment on the angle of a revolute, cylindrical "
              "or spring joint, a force on the travel of a prismatic or cylindrical joint or on the length of a "
              "spring; one formula, positive where it increases the angle, travel or length"}),
        only({"distributed", "pressure"}, {"body", Type::body, "", required, "the body on which it acts"}),
        only({"pressure"},
             in_space({"part", Type::text, "", "", "part of the mesh on which it acts; absent: all shells"})),
        only({"pressure"}, in_space({"pressure", Type::formula_of_sensors, "N/m2", required,
                                     "pressure, positive along the shells' normals"})),
        only({"pressure"}, in_space({"follower", Type::flag, "", "true",
                                     "true: follower pressure, normal to the deformed shells; false: constant "
                                     "direction, that at the start"})),
        only({"force", "distributed"},
             {"force", Type::load_force, "N; N/m", required, "components, per length if distributed"}),
        only({"moment"}, {"moment", Type::load_moment, "N m", required,
                          "moment, positive counterclockwise; in spatial scenes its components about x, y, z"}),
        only({"force", "moment", "distributed"},
             choice("axes", "world",
                    "axes of the components; body: those of the floating frame; place: rotating with the section at "
                    "the place (follower forces), not for distributed loads. body and place coincide with the mesh "
                    "axes where the body is undeformed",
                    {"world", "body", "place"})),
        only({"force", "moment"},
             in_space(choice("per", "whole",
                             "whole: the resultant; length, area: force or moment per length of the edges (of shells, "
                             "beams), or per area of the shells, of a place of several nodes",
                             {"whole", "length", "area"}))),
        only({"force", "moment"}, in_space({"shape", Type::formula_of_point, "", "1",
                                            "factor on a force or moment per length or area, of the undeformed "
                                            "position in mesh axes"})),
    }};

const SchemaSection motion_section{
    "motion",
    "The simulated time, from t = 0.",
    "end: 3\nstep: 1e-3",
    {
        {"end", Type::number, "s", required, "end time", positive},
        {"step", Type::number, "s", required, "time step (with tolerance: the first one); at most end", positive},
        {"spectral_radius",
         Type::number,
         "",
         "0.8",
         "spectral radius of the integrator at infinite frequency; 0: maximum numerical damping",
         {0, 1, false, true}},
        {"tolerance",
         Type::number,
         "",
         "",
         "error per step for adaptive steps, relative to the greatest distance of all bodies together from the start "
         "(mass-weighted); absent: constant steps",
         {0, 1, true, true}},
        choice("start", "given",
               "given: from the initial states of the bodies; equilibrium: from the static equilibrium under the loads "
               "and drives at t = 0 that is found from there, at rest (drives give their speeds); steady_rotation: "
               "from the steady rotation about the only driven or revolute joint to the ground, at the speed of its "
               "drive at t = 0 or the initial angular_velocity of the body there",
               {"given", "equilibrium", "steady_rotation"}),
        {"every", Type::integer, "", "1", "store every n-th step", counts},
        {"output", Type::number, "s", "",
         "store at multiples of this time instead, interpolated between steps by the integrator's cubic polynomials; "
         "at least 0.01 step; absent: as `every`",
         positive},
    }};

const SchemaSection probe_section{
    "probe",
    "A quantity recorded at a place, of a joint, of a body or of sensors, named by its key. Exactly one of at, joint, "
    "body, formula.",
    "at: beam.end\nquantity: displacement",
    {
        like("probe"),
        {"at", Type::place, "", "", "place where the quantity is recorded"},
        {"joint", Type::text, "", "",
         "instead: name of a joint, spring or bushing, whose force or moment on its second place is recorded, end "
         "stops "
         "included (joint reactions, drive moments), or its coordinate"},
        {"body", Type::text, "", "", "instead: name of a body, whose energy is recorded"},
        {"formula", Type::formula_of_sensors, "", "",
         "instead: a formula of t and sensors (see `load`), as \"elbow.angle - ref(t)\"; its column is NAME.value"},
        {"unit", Type::text, "", "", "unit of the formula's value; absent: none"},
        choice(
            "quantity", "",
            "position, displacement since the start, velocity, angular_velocity: in world axes; deflection: relative "
            "to the floating frame, of a body in several frames to that of the whole body; rotation: of the section "
            "since the start (in "
            "spatial scenes a rotation vector of length at most pi); acceleration, angular_acceleration: in world "
            "axes, "
            "or in those of relative_to (accelerometers); force, moment (about the second place): of a "
            "joint, in world axes; drive: of a joint along its axis, or about it where the joint rotates about it "
            "(also of a cylindrical one), positive where it increases travel, "
            "length "
            "or angle; power: what a joint does on both its places; angle, rate, travel, speed, length, length_rate: "
            "of "
            "a joint, since the start; kinetic_energy, strain_energy: of a body; section_force (N, Vy, Vz; in "
            "planar scenes N, V), section_moment (about the place: T, My, Mz; M): of a beam, what the part beyond the "
            "section (towards increasing x of the elements) exerts on the part before it, in the axes of the section "
            "as it rotates; of a shell, in axes x, y on its surface: "
            "membrane_force and bending_moment per length (positive moments stretch the top), stress, "
            "principal_stress, von_mises_stress and strain at `surface` of the shell or of its `layer`. Absent: "
            "displacement, of a joint force, of a body strain_energy",
            {"position",
             "displacement",
             "deflection",
             "velocity",
             "rotation",
             "angular_velocity",
             "acceleration",
             "angular_acceleration",
             "force",
             "moment",
             "drive",
             "power",
             "angle",
             "rate",
             "travel",
             "speed",
             "length",
             "length_rate",
             "kinetic_energy",
             "strain_energy",
             "section_force",
             "section_moment",
             "stress",
             "principal_stress",
             "von_mises_stress",
             "strain",
             "membrane_force",
             "bending_moment"}),
        {"relative_to", Type::place, "", "",
         "reference place; components in axes that rotate with its section; absent: world. Of a joint, the axes alone "
         "are those of the place"},
        choice("axes", "world",
               "of the force or moment of a joint, instead of relative_to; ground: those of the ground, which does not "
               "rotate, as world; joint: z along the axis of the joint (in planar scenes x of a prismatic joint), x "
               "that of the mesh, normal to z; they rotate with the first place, or with the second where the first is "
               "on the ground",
               {"world", "ground", "joint"}),
        {"toward", Type::place, "", "",
         "section_force, section_moment: the section just beside the place, on the element that leads towards this "
         "place; absent: the mean of both sides, which differ where a load or a joint acts on the place. Of shells: on "
         "the part and plane that lead there, where several meet"},
        in_space(choice("surface", "middle",
                        "of a shell or its layer, for stresses and strains; top is where the normal of its elements "
                        "points",
                        {"middle", "top", "bottom"})),
        in_space({"layer", Type::integer, "", "",
                  "of a laminate, for stresses and strains: number of the ply, from 1 at the bottom", counts}),
        in_space({"axis", Type::point, "", "",
                  "axis x of the components of a shell, mesh axes, projected on the surface; absent: that of the "
                  "section, or x (y where x is normal to the shell)"}),
    }};

const SchemaSection event_section{
    "event",
    "Exactly one of unlock, lock, stop, and exactly one of at, when, probe.",
    "unlock: clamp\nat: 1.5",
    {
        {"unlock", Type::text, "", "",
         "name of a joint that is removed; of a joint that another event locks: only the lock is removed"},
        {"lock", Type::text, "", "",
         "name of a joint whose relative motion is locked; velocities are projected onto the constraints in the "
         "kinetic energy norm (plastic impact), and the impulses are reported"},
        {"stop", Type::flag, "", "false", "the simulation ends"},
        {"at", Type::number, "s", "", "time of the event", nonnegative},
        {"when", Type::formula, "", "",
         "formula of t whose first change of sign triggers the event; of a condition (t > 2) its first change"},
        {"probe", Type::text, "", "",
         "probe component, as tip.y, that triggers the event when it crosses the value `crosses`"},
        {"crosses", Type::number, "", "0", "threshold of `probe`, in its unit"},
    }};

const SchemaSection place_section{
    "place",
    "A node: `beam.end` (body.name; names under line, polyline and segments), `ground`, or this mapping.",
    "body: beam\nnode: [50, 0]",
    {
        {"body", Type::body, "", required, "name of the body, or ground"},
        {"node", Type::point, "m", required,
         "coordinates of a node in mesh axes, of any point for a rigid body; on the ground in world axes"},
    }};

}  // namespace

const std::vector<SchemaSection>& mechanism_sections() {
  static const std::vector<SchemaSection> all{joint_section, limits_section, friction_section, load_section,
                                              place_section, motion_section, probe_section,    event_section};
  return all;
}

}  // namespace floe::scene
