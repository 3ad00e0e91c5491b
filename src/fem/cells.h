#pragma once
#include "floe/fem/structure.h"

namespace floe::fem {

/// Whether the sections belong on the cells that have them. The fault that is told is the one of the cell whose first
/// corner comes first (by x, then y, then z): the same on any number of ranks. Collective.
/// @throws InputError  a section does not belong on a cell of this kind, or its axes do not
void check_cells(const Structure& structure);

}  // namespace floe::fem
