#pragma once
#include "floe/fem/flat_body.h"

namespace floe::fem {

/// What a structure makes when it is first asked for, and keeps.
struct Kept {
  petsc::MatHandle mass;              ///< of mass(structure, {})
  PetscObjectState mass_changes = 0;  ///< its state when it was assembled
  bool flatness_known = false;
  std::unique_ptr<const FlatBody> flat;
};

}  // namespace floe::fem
