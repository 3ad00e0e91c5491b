#pragma once
#include "floe/fem/structure.h"

namespace floe::fem {

/// @throws InputError  the section does not belong on a cell of this kind, or its axes do not. Rank-local.
void check_cell(const Structure& structure, const Mesh::Cell& cell);

}  // namespace floe::fem
