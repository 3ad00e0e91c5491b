#include "at_base.h"

#include "floe/petsc/values.h"

namespace floe::solve {

AtBase::AtBase(const System& system, Vec U, Vec V, double t) : system_(system), U_(U) {
  if (!system.has_attitudes()) return;
  {
    petsc::Values values(U);
    for (const auto& [first, attitude] : system.attitudes()) {
      bases_.push_back(attitude->base);
      for (int i = 0; i < 3; ++i) {
        const PetscInt global = system.coordinates().global()[first + i];
        if (global >= values.first && global < values.end) owned_.push_back({global, values[global]});
      }
    }
  }
  system.rebase(U, V, t);
}

AtBase::~AtBase() {
  if (bases_.empty()) return;
  petsc::Values values(U_);
  for (const auto& [global, value] : owned_) values[global] = value;
  for (std::size_t i = 0; i < bases_.size(); ++i) system_.attitudes()[i].second->base = bases_[i];
}

}  // namespace floe::solve
