#pragma once
#include <optional>

#include "floe/dynamics/coordinates.h"
#include "floe/plan/prepare.h"
#include "floe/reference/modal_damping.h"

namespace floe::assembly {
using namespace plan;

/// Modal damping of a full-order body by the modes that reduced models have, with its unknowns added; none: it has
/// none. @param constrained  dofs that are zero with the full-order model. Collective.
std::optional<reference::ModalDamping> full_order_modal_damping(const Plan& plan, int body,
                                                                const fem::Conditions& constrained,
                                                                dynamics::Coordinates& coordinates);

/// The unknowns of `damping` at the start. @param owner  whether this rank has the shared unknowns. Collective.
void set_modal_coordinates(const reference::ModalDamping& damping, const PlannedBody& body,
                           const dynamics::Coordinates& coordinates, bool owner, Vec U, Vec V);

}  // namespace floe::assembly
