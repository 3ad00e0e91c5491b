#pragma once
#include "floe/fem/assembly.h"

namespace floe::fem {

/// k K + m M, with a diagonal under the conditions, as each rank's sum over its own elements (MATIS, local matrices
/// AIJ): for domain decomposition. A rank's subdomain has the nodes that its elements act on, and those of its own that
/// no element acts on. Collective.
petsc::MatHandle assemble_subdomains(const Structure& structure, const Conditions& conditions, double k, double m);

}  // namespace floe::fem
