#pragma once
#include "floe/assembly/body_stage.h"
#include "floe/plan/same_reduction.h"

namespace floe::assembly {

/// Of each body whether one before it has the same reduction (plan::same_reductions). Collective.
std::vector<SharedReduction> shared_reductions(const Plan& plan);

/// The reduction of `original` for another body: the rotated basis, inertia constants in its axes, the same elastic
/// energy. Collective.
ReducedBody shared_body(const Plan& plan, int body, const SharedReduction& shared, const ReducedBody& original);

}  // namespace floe::assembly
