#pragma once
#include <array>
#include <string>
#include <vector>

#include "floe/scene/scene.h"

namespace floe::scene {

/// What is free or driven between the places of a joint, and can be measured or loaded.
enum class JointCoordinate { travel, rotation, length };

/// Travel of slides, rotation of hinges, length and rotation of springs (in space of those with an axis); others have
/// none.
std::vector<JointCoordinate> coordinates_of(const Joint& joint, int dimension);

/// The coordinate on which a load acts. @throws InputError  the joint has none, or its motion is prescribed
JointCoordinate loaded_coordinate(const Load& load, const Joint& joint, int dimension);

/// What a name with a dot means in a formula: a coordinate of a joint or its rate, or a component of a probe.
///
///   JOINT.angle  JOINT.rate  JOINT.travel  JOINT.speed  JOINT.length  JOINT.length_rate  PROBE.COMPONENT
struct Sensor {
  int joint = -1, probe = -1;  ///< one of them
  JointCoordinate of = JointCoordinate::travel;
  bool rate = false;
  int component = 0;  ///< of the probe
};

/// What a component of a probe is called: x, y, z; rx, ry, rz; angle.
std::vector<std::string> components_of(Probe::Quantity quantity, int dimension);

/// All sensors of a scene by name. Probes of deflections and of reactions are none.
std::vector<std::pair<std::string, Sensor>> sensors_of(const Scene& scene);

/// The one with this name, which the scene's checks have found.
Sensor sensor_of(const Scene& scene, const std::string& name);

/// Index of a joint that the scene has.
std::size_t joint_index(const Scene& scene, const std::string& name);

}  // namespace floe::scene
