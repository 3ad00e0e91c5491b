#include "corner_thickness.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace floe::mesh {
namespace {

/// Of the linear or bilinear interpolation between the corners; exact.
double mean_of_cubes(std::span<const double> t) {
  double sum = 0;
  if (t.size() == 3) {  // all products of third degree, each once
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j)
        for (int k = j; k < 3; ++k) sum += t[i] * t[j] * t[k];
    return sum / 10;
  }
  const double root = 1 / std::sqrt(3.0);  // Gauss points integrate what is cubic in each direction
  for (const double x : {-root, root})
    for (const double y : {-root, root}) {
      const double at =
          ((1 - x) * (1 - y) * t[0] + (1 + x) * (1 - y) * t[1] + (1 + x) * (1 + y) * t[2] + (1 - x) * (1 + y) * t[3]) /
          4;
      sum += at * at * at / 4;
    }
  return sum;
}

}  // namespace

CornerThickness corner_thickness(std::span<const double> corners) {
  const double mean = std::accumulate(corners.begin(), corners.end(), 0.0) / static_cast<double>(corners.size());
  if (std::all_of(corners.begin(), corners.end(), [&](double t) { return t == corners[0]; })) return {corners[0]};
  return {mean, mean_of_cubes(corners) / (mean * mean * mean),
          *std::max_element(corners.begin(), corners.end()) / mean};
}

}  // namespace floe::mesh
