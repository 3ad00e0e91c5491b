#include "floe/scene/formulation.h"

#include "floe/math/nearest.h"
#include "floe/scene/scene.h"

namespace floe::scene {

std::vector<std::string> formulation_names() { return {"cfr", "nlffr", "lffr", "vm", "vm+md"}; }

std::string name_of(Formulation formulation) { return formulation_names()[static_cast<int>(formulation)]; }

Formulation formulation_of(const std::string& name, const std::string& option) {
  const std::vector<std::string> names = formulation_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<Formulation>(i);
  const std::string near = math::nearest(name, names);
  throw InputError(option + ": \"" + name + "\" is not one of cfr, nlffr, lffr, vm, vm+md" +
                   (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

bool is_reduced(Formulation formulation) { return formulation == Formulation::vm || formulation == Formulation::vm_md; }

}  // namespace floe::scene
