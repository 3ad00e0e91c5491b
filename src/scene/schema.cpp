#include "floe/scene/schema.h"

#include "schema_parts.h"
#include "schema_ranges.h"

namespace floe::scene {
namespace {

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
         "in space: a body that a fixed joint makes one with a rigid body has its frame (beams where `frame` clamps "
         "them there), without coordinates and multipliers of its own; false: never"},
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

}  // namespace

const std::vector<SchemaSection>& schema() {
  static const std::vector<SchemaSection> all = [] {
    std::vector<SchemaSection> sections{scene_section, ground_section};
    for (const auto* part : {&body_sections(), &mechanism_sections(), &spatial_sections()})
      sections.insert(sections.end(), part->begin(), part->end());
    return sections;
  }();
  return all;
}

}  // namespace floe::scene
