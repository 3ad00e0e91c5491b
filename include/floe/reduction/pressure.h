#pragma once
#include <functional>

#include "floe/body/pressure.h"
#include "floe/reduction/basis.h"

namespace floe::reduction {

/// Unit pressure on those shells of a body that `on` chooses, on the coordinates of its basis. Collective; replicated.
/// @param basis  of a rigid body: one without basis vectors
body::Pressure pressure(const fem::Structure& structure, const Basis& basis,
                        const std::function<bool(const fem::Mesh::Cell&)>& on);

}  // namespace floe::reduction
