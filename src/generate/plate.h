#pragma once
#include "grid.h"

namespace floe::generate {

Grid grid_of(const Plate& plate);

/// Of a node of the plate's grid.
Eigen::Vector3d position_of(const Plate& plate, GridNode node);

/// @throws InputError  what makes no plate, or more nodes than are counted
void check_plate(const std::string& source, const Plate& plate);

/// edge_places and, where there is a node, the centre.
std::vector<PlaceRule> plate_places(const Plate& plate, const std::string& prefix,
                                    const std::function<PetscInt(GridNode)>& number);

}  // namespace floe::generate
