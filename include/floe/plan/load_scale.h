#pragma once
#include "floe/plan/prepare.h"

namespace floe::plan {

/// A force of the scene [N], beside which others are round-off or not: the maximum, over 64 intervals of the motion, of
/// its forces (moments, distributed loads and pressures by its extent) and of the weight of its bodies; and a
/// thousandth of what would bend the most flexible body by its length (EI/L^2; of shells D/L).
/// 0: nothing of this is there. Collective.
double force_of(const Plan& plan);

}  // namespace floe::plan
