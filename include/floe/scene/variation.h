#pragma once
#include <memory>
#include <string>
#include <vector>

#include "floe/scene/scene.h"

namespace floe::scene {

/// A number in place of what the scene's file says at a path: a key, `joints.hinge.viscosity`, an entry of a list,
/// `loads.tip.force[2]` (from 1), or the name of one of the scene's parameters, `F`.
struct Variation {
  std::string path;
  double value = 0;
};

/// Reads a scene with some of its values replaced.
///
/// @param name  stands for the file in messages
/// @throws InputError  as parse_scene; a path that the text does not have (with the nearest), or that is no number
Scene parse_scene(const std::string& text, const std::string& name, const std::vector<Variation>& variations);

/// A text that two scenes share only if their bodies are prepared and reduced alike: what the file says of bodies (not
/// where they are at the start, and how fast), of joints without their springs, drives and stops, of the places of
/// loads, which joints events change, and the values of all parameters that these name. Derivatives that are chosen by
/// count look at the whole motion: then all of the file but probes and events.
std::string offline_inputs(const std::string& text, const std::string& name, const std::vector<Variation>& variations);

}  // namespace floe::scene
