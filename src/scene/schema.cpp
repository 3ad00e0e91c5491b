#include "floe/scene/schema.h"

#include "schema_parts.h"
#include "schema_ranges.h"

namespace floe::scene {
namespace {

const Key accuracy{"accuracy",
                   Type::accuracy,
                   "",
                   "",
                   "maximum total error of the probes (each probe as a vector, root mean square; against geometrically "
                   "exact beams and "
                   "shells, converged in mesh and step), for which floe run selects floating frames, elements, "
                   "strains, basis vectors, "
                   "elastic force and time step; absent: the scene's own model",
                   {0, 1, true, true},
                   {},
                   {},
                   "accuracy"};

const SchemaSection scene_section{
    "scene",
    "The whole file: one mapping with these keys.",
    "title: Cantilever\nparameters: {L: 100, F: 2500}\ngravity: [0, -9.81]\nbodies: {...}\njoints: {...}\nloads: "
    "{...}\n"
    "motion: {...}\nprobes: {...}\nevents: {...}",
    {
        {"title", Type::text, "", "", "title of results and pictures; absent: the name of the file"},
        {"parameters", Type::parameters, "", "",
         "named numbers that all numbers and formulas may use; a parameter may use those defined above it"},
        part("functions", Type::functions, "",
             "named functions that formulas may call, as gust(t): each a formula of t or a table; a function may call "
             "those defined above it",
             "table"),
        {"gravity", Type::formulas, "m/s2", "", "acceleration of gravity in world axes; absent: zero"},
        part("ground", Type::section, "", "prescribed motion of the ground; absent: fixed", "ground"),
        {"share_frames", Type::flag, "", "true",
         "spatial scenes: a flexible body welded to a rigid body by a fixed joint uses that body's frame as its "
         "floating frame (beams: where `frame` clamps them there), which eliminates its rigid-body coordinates and the "
         "joint's multipliers; false: never"},
        part("bodies", Type::named_sections, required, "bodies by name", "body"),
        part("joints", Type::named_sections, "", "joints by name; absent: the bodies are free", "joint"),
        part("loads", Type::named_sections, "", "loads by name", "load"),
        part("copies", Type::named_sections, "",
             "copies of groups of bodies by name, with the joints, loads, probes and events that act on them", "copy"),
        part("motion", Type::section, "", "end time and time step; required by run, compare, tradeoff and sweep",
             "motion"),
        accuracy,
        part("probes", Type::named_sections, "", "recorded quantities by name", "probe"),
        part("events", Type::named_sections, "", "events by name; each occurs at most once", "event"),
    }};

const SchemaSection accuracy_section{
    "accuracy",
    "A required accuracy of a part of the error alone.",
    "reduction: 1 %",
    {
        {"reduction",
         Type::share,
         "",
         Key::required,
         "maximum error of the probes relative to the full-order model of the same mesh; floe run selects basis "
         "vectors, elastic force and time step",
         {0, 1, true, true}},
    }};

const SchemaSection table_section{
    "table",
    "A function given at points, named by its key: either t and values, or file. Before the first point it has the "
    "first "
    "value, after the last point the last value.",
    "file: gust.csv\ncolumn: 3\ninterpolation: cubic",
    {
        {"t", Type::numbers, "", "", "arguments of the points, ascending"},
        {"values", Type::numbers, "", "", "values of the points"},
        {"file", Type::text, "", "",
         "text file (CSV) beside the scene: columns of numbers separated by commas, semicolons or blanks; lines that "
         "begin "
         "with # and a header are skipped"},
        {"t_column", Type::integer, "", "1", "column of the arguments, from 1", counts},
        {"column", Type::integer, "", "2", "column of the values, from 1", counts},
        choice("interpolation", "linear",
               "linear; cubic: monotone between the points, with a continuous first derivative (for drives)",
               {"linear", "cubic"}),
        {"periodic", Type::flag, "", "false", "repeated beyond its ends"},
    }};

const SchemaSection copy_section{
    "copy",
    "A copy of a group of bodies, moved as a whole. The joints that connect these bodies with one another or with the "
    "ground, and the loads and probes of these bodies and joints, are copied and moved with them (forces, axes and "
    "points of the ground in world axes, and sensors in formulas, too); so are joints to places {body: BODY, node: "
    "[..]} of other bodies. Copies are named NAME_ORIGINAL, with the key as NAME. A joint, load, probe or event "
    "that the scene itself has by that name replaces the copy. Copied are also events that unlock or lock a copied "
    "joint, or that a copied probe triggers.",
    "like: [upper_arm, forearm]\nposition: [0, 0.5]\nangle: pi",
    {
        {"like", Type::texts, "", Key::required,
         "names of the bodies of the group; bodies of earlier copies are allowed"},
        {"position", Type::point, "m", "", "translation, after the rotation about the world origin; absent: zero"},
        in_plane({"angle", Type::number, "rad", "0", "rotation about the world origin, counterclockwise"}),
        in_space({"rotation", Type::point, "rad", "", "rotation vector about the world origin; absent: zero"}),
        {"without", Type::texts, "", "", "names of joints, loads, probes and events that are not copied; absent: none"},
    }};

const SchemaSection ground_section{
    "ground",
    "Translational base excitation. The world axes move with the ground: positions and velocities are relative to it, "
    "and the inertia force of the opposite acceleration acts on every mass.",
    "acceleration: [0, \"3*sin(20*t)\"]",
    {
        {"acceleration", Type::formulas, "m/s2", "", "acceleration of the ground in world axes; absent: zero"},
    }};

}  // namespace

const std::vector<SchemaSection>& schema() {
  static const std::vector<SchemaSection> all = [] {
    std::vector<SchemaSection> sections{scene_section, accuracy_section, table_section, ground_section, copy_section};
    for (const auto* part : {&body_sections(), &mechanism_sections(), &spatial_sections()})
      sections.insert(sections.end(), part->begin(), part->end());
    return sections;
  }();
  return all;
}

}  // namespace floe::scene
