#pragma once
#include <string>
#include <vector>

#include "reading.h"

namespace floe::scene {

// Each reads one value of the file into its part of the scene and checks what can be distinguished from this part
// alone.

MeshSpec read_mesh(Document& document, const Value& value);
Body read_body(Document& document, const std::string& name, const Value& value);
/// A body that was reduced before: its file and the start, beside which no other key has a meaning.
Body read_reduced(Document& document, const std::string& name, Reading& body);
/// Whether it is rigid, and its mass where that is given; then perhaps a mesh that stands for it.
void read_rigid(Document& document, Reading& body, Body& into);
/// Masses at places of a body in space. @param name  of the body
std::vector<MassSpec> read_masses(Document& document, Reading& body, const std::string& name);
/// The key inertia of a mass: in space three or six numbers; zero where it is absent.
std::array<double, 6> read_inertia(Document& document, Reading& mass);
/// Position, velocity and deformation at the start.
InitialSpec read_initial(Document& document, Reading& body);
/// The keys section and material of a body.
Section read_section(Document& document, Reading& body, bool rigid);

/// A section given by `shape` and its measures. @throws InputError  measures that do not fit
fem::SectionShape read_shape(Document& document, Reading& section);
std::vector<std::string> shape_keys(const std::string& shape);

/// A fault for each of `all` that is given and not among `keys`, of something that they do not apply to.
void refuse_keys_but(Document& document, const Reading& reading, const std::vector<Key>& all,
                     const std::vector<std::string>& keys, const std::string& of);
/// The keys section, material and parts of a body in space.
std::vector<PartSpec> read_parts(Document& document, Reading& body);
/// @param body  its name
ReductionSpec read_reduction(Document& document, const Value& value, const std::string& body);
Joint read_joint(Document& document, const std::string& name, const Value& value);
Load read_load(Document& document, const std::string& name, const Value& value);
Motion read_motion(Document& document, const Value& value);
/// A start at rest against the initial states of the bodies.
void check_start(Document& document, const Scene& scene);
Event read_event(Document& document, const std::string& name, const Value& value);
Probe read_probe(Document& document, const std::string& name, const Value& value);
/// The places of probes of joints. Joints must have been read.
void place_probes(Document& document, Scene& scene);
/// The places of loads on joints, and the sensors that loads and probes depend on. Joints and probes must have been
/// read.
void place_loads(Document& document, Scene& scene);
void read_parameters(Document& document, const Value& value);
void read_functions(Document& document, const Value& value);
/// Whether formulas can read a name, or the first part of one: letters, digits and _, not starting with a digit.
bool readable_in_formulas(const std::string& name);
/// Whether formulas may know a parameter or function by this name; else a fault.
bool check_name(Document& document, const Where& where, const std::string& name);

/// `beam.end`, `ground` or {body: beam, node: [x, y]} (in space [x, y, z]); whether they exist is checked once all
/// bodies are read.
Place read_place(Document& document, const Value& value, const Key& key);
/// A place of the body itself: `end`, [x, y] or [x, y, z].
Place read_own_place(Document& document, const Value& value, const Key& key, const std::string& body);

// What only the whole scene shows; each notes faults.

/// Frames, modes and initial deformation against the body's mesh, which must be sound.
void check_body(Document& document, const Body& body);
/// All places and bodies that joints, loads and probes name; joints against each other.
void check_places(Document& document, const Scene& scene);
void check_joints(Document& document, const Scene& scene);
/// Joints and probes that events name.
void check_events(Document& document, const Scene& scene);
/// reduction.responses needs a motion, with joints that no event changes.
void check_responses(Document& document, const Scene& scene);
/// Formulas of time are finite from the start to the end of the motion.
void check_formulas(Document& document, const Scene& scene);

}  // namespace floe::scene
