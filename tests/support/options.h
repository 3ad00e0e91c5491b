#pragma once
#include <petscsys.h>

#include <map>
#include <string>

#include "floe/petsc/error.h"

namespace floe::testing {

/// PETSc's options for as long as it lives.
struct Options {
  std::map<std::string, std::string> all;
  explicit Options(std::map<std::string, std::string> given) : all(std::move(given)) {
    for (const auto& [name, value] : all) petsc::check(PetscOptionsSetValue(nullptr, name.c_str(), value.c_str()));
  }
  Options(const Options&) = delete;
  ~Options() {
    for (const auto& [name, value] : all) PetscOptionsClearValue(nullptr, name.c_str());
  }
};

}  // namespace floe::testing
