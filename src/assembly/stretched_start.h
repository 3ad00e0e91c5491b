#pragma once
#include <string>

#include "floe/assembly/model.h"
#include "floe/plan/prepare.h"

namespace floe::assembly {

/// Ratio above which the strain energy of initial deformations is that of strains of second order.
inline constexpr double most_stretch = 3;

/// A warning with its number where the strain energy U of the model at its start is more than `most_stretch` times that
/// of the linear strains of all initial deformations as they are given, U_1 = sum 1/2 q'K q in mesh axes: deflections w
/// without their shortening, u' = -w'^2/2, stretch a body. Empty: none, or springs that have an energy of their own.
/// Collective.
std::string stretched_start(const Plan& plan, const Model& model);

}  // namespace floe::assembly
