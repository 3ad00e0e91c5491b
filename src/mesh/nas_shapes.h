#pragma once
#include "nas_reading.h"

namespace floe::mesh {

/// Up to round-off of the numbers of a deck.
bool equal_lengths(double a, double b);

/// Shapes of PBARL and PBEAML that are read.
std::vector<std::string> nas_shape_names();

/// How many dimensions a shape has; 0 where it is none of them.
std::size_t nas_shape_dimensions(const std::string& shape);

/// Section and area from a shape and its dimensions (all positive); faults where they leave no section.
void take_nas_shape(NasFields& card, const std::string& shape, const std::vector<double>& d, NasBeamProperty& property);

}  // namespace floe::mesh
