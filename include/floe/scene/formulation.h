#pragma once
#include <string>
#include <vector>

namespace floe::scene {

/// What is simulated: corotational full order; full order in floating frames, von Karman or linear; reduced to modes,
/// or to modes and modal derivatives.
enum class Formulation { cfr, nlffr, lffr, vm, vm_md };
std::string name_of(Formulation formulation);
/// @param option  that has the name. @throws InputError  unknown, with the nearest name
Formulation formulation_of(const std::string& name, const std::string& option = "--formulation");
std::vector<std::string> formulation_names();
bool is_reduced(Formulation formulation);

}  // namespace floe::scene
