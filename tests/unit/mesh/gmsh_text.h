#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace floe::testing {

/// How a Gmsh file of format 4.1 is written.
struct GmshFormat {
  bool binary = false, swapped = false;
  int width = 8;
};

/// A grid of nx by ny squares of side 1 in the x-y plane, as one surface in the physical group "grid", with "left"
/// its line of nodes x = 0. Nodes are numbered step, 2 step, ... row by row; elements 1, 2, ....
inline std::string gmsh_grid(int nx, int ny, bool triangles, long long step = 1, const GmshFormat& format = {}) {
  std::string text;
  const auto put = [&](const void* value, int size) {
    std::string bytes(static_cast<const char*>(value), size);
    if (format.swapped) std::reverse(bytes.begin(), bytes.end());
    text += bytes;
  };
  const auto integer = [&](std::int32_t value) {
    format.binary ? put(&value, 4) : void(text += std::to_string(value) + " ");
  };
  const auto count = [&](std::uint64_t value) {
    const auto small = static_cast<std::uint32_t>(value);
    if (!format.binary)
      text += std::to_string(value) + " ";
    else if (format.width == 4)
      put(&small, 4);
    else
      put(&value, 8);
  };
  const auto real = [&](double value) { format.binary ? put(&value, 8) : void(text += std::to_string(value) + " "); };
  const auto end_line = [&] {
    if (!format.binary) text += "\n";
  };

  text += "$MeshFormat\n4.1 " + std::to_string(format.binary) + " " + std::to_string(format.width) + "\n";
  if (format.binary) integer(1), text += "\n";
  text += "$EndMeshFormat\n$PhysicalNames\n2\n1 1 \"left\"\n2 5 \"grid\"\n$EndPhysicalNames\n$Entities\n";
  for (const int n : {0, 1, 1, 0}) count(n);
  end_line();
  for (const int group : {1, 5}) {
    integer(1);
    for (int k = 0; k < 6; ++k) real(0);
    count(1), integer(group), count(0), end_line();
  }
  text += "\n$EndEntities\n$Nodes\n";
  const std::uint64_t nodes = (nx + 1) * (ny + 1), cells = (triangles ? 2 : 1) * nx * ny;
  const auto label = [&](int i, int j) { return static_cast<std::uint64_t>(step) * (j * (nx + 1) + i + 1); };
  count(1), count(nodes), count(step), count(step * nodes), end_line();
  integer(2), integer(1), integer(0), count(nodes), end_line();
  for (std::uint64_t i = 1; i <= nodes; ++i) count(step * i), end_line();
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) real(i), real(j), real(0), end_line();
  text += "\n$EndNodes\n$Elements\n";
  count(2), count(cells + ny), count(1), count(cells + ny), end_line();
  integer(1), integer(1), integer(1), count(ny), end_line();
  std::uint64_t number = 0;
  for (int j = 0; j < ny; ++j) count(++number), count(label(0, j)), count(label(0, j + 1)), end_line();
  integer(2), integer(1), integer(triangles ? 2 : 3), count(cells), end_line();
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const std::uint64_t a = label(i, j), b = label(i + 1, j), c = label(i + 1, j + 1), d = label(i, j + 1);
      count(++number), count(a), count(b), count(c);
      if (triangles) end_line(), count(++number), count(a), count(c);
      count(d), end_line();
    }
  }
  return text + "\n$EndElements\n";
}

}  // namespace floe::testing
