#pragma once
#include <span>

namespace floe::mesh {

/// Of an element whose thickness varies linearly between its corners.
struct CornerThickness {
  double mean;          // of t
  double taper = 1;     // mean of t^3 over mean^3
  double thickest = 1;  // greatest t over mean
  auto operator<=>(const CornerThickness&) const = default;
};

/// @param corners  three, or four of a quadrilateral, whose area counts as that of a parallelogram; mean positive
CornerThickness corner_thickness(std::span<const double> corners);

}  // namespace floe::mesh
