#pragma once
#include "floe/plan/prepare.h"

namespace floe::plan {

/// Pairs of nodes of joints with edges: nodes, whose places become the first sums of these. Collective.
void find_interfaces(Plan& plan);

}  // namespace floe::plan
