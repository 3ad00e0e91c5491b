#pragma once
#include <Eigen/Dense>

#include "floe/assembly/model.h"
#include "floe/petsc/values.h"

namespace floe::testing {

inline assembly::Model built(const std::string& text, scene::Formulation formulation) {
  return assembly::build(scene::parse_scene(text, "test.yaml"), formulation, PETSC_COMM_WORLD);
}

/// The complaint of a scene that reads well and cannot be built.
inline std::string complaint(const std::string& text, scene::Formulation formulation) {
  try {
    built(text, formulation);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Values of the probes at the start.
inline std::vector<double> at_start(const assembly::Model& model) {
  return assembly::probe_values(model, 0, model.U, model.V);
}

inline std::vector<scene::Formulation> all_formulations() {
  using scene::Formulation;
  return {Formulation::cfr, Formulation::nlffr, Formulation::lffr, Formulation::vm, Formulation::vm_md};
}

}  // namespace floe::testing
