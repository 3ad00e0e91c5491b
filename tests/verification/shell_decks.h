#pragma once
#include <functional>

#include "spatial_scenes.h"

namespace floe::test {

using Surface = std::function<Eigen::Vector3d(double, double)>;

inline std::string node_line(std::size_t label, const Eigen::Vector3d& x) {
  return fmt::format("{}, {:.17g}, {:.17g}, {:.17g}\n", label, x[0], x[1], x[2]);
}

/// A deck of n x m shells on the image of the unit square, triangles in pairs, with its edges as node sets.
/// @param type    S3, S4, S6 or S8R
/// @param closed  the last nodes across are the first ones: a tube
inline std::string shells(const std::string& type, int n, int m, double thickness, const std::string& material,
                          const Surface& at, bool closed = false) {
  const bool triangles = type == "S3" || type == "S6", middle_nodes = type == "S6" || type == "S8R";
  const int s = middle_nodes ? 2 : 1;
  std::string nodes = "*NODE\n", elements = fmt::format("*ELEMENT, TYPE={}, ELSET=skin\n", type), sets[4];
  std::map<std::pair<int, int>, std::size_t> labels;
  const auto node = [&](int i, int j) {
    if (closed) j %= s * m;
    const auto [found, made] = labels.try_emplace({i, j}, labels.size() + 1);
    if (made) nodes += node_line(found->second, at(double(i) / (s * n), double(j) / (s * m)));
    return found->second;
  };
  int count = 0;
  const auto element = [&](std::vector<std::size_t> corners, const std::vector<std::size_t>& middle) {
    if (middle_nodes) corners.insert(corners.end(), middle.begin(), middle.end());
    elements += std::to_string(++count);
    for (const std::size_t label : corners) elements += ", " + std::to_string(label);
    elements += "\n";
  };
  for (int a = 0; a < s * n; a += s)
    for (int b = 0; b < s * m; b += s) {
      const std::size_t c[] = {node(a, b), node(a + s, b), node(a + s, b + s), node(a, b + s)};
      std::size_t e[4] = {}, middle = 0;
      if (middle_nodes)
        e[0] = node(a + 1, b), e[1] = node(a + 2, b + 1), e[2] = node(a + 1, b + 2), e[3] = node(a, b + 1);
      if (!triangles) {
        element({c[0], c[1], c[2], c[3]}, {e[0], e[1], e[2], e[3]});
        continue;
      }
      if (middle_nodes) middle = node(a + 1, b + 1);
      element({c[0], c[1], c[2]}, {e[0], e[1], middle});
      element({c[0], c[2], c[3]}, {middle, e[2], e[3]});
    }
  for (const auto& [place, label] : labels) {
    const bool on[] = {place.first == 0, place.first == s * n, place.second == 0, place.second == s * m};
    for (int i = 0; i < 4; ++i)
      if (on[i]) sets[i] += std::to_string(label) + ",\n";
  }
  const char* names[] = {"left", "right", "bottom", "top"};
  for (int i = 0; i < 4; ++i) elements += fmt::format("*NSET, NSET={}\n{}", names[i], sets[i]);
  return nodes + elements + "*MATERIAL, NAME=m\n" + material +
         fmt::format("*SHELL SECTION, ELSET=skin, MATERIAL=m\n{:.17g}\n", thickness);
}

/// A file that goes with the test.
struct Deck {
  Scratch scratch;
  std::string path() const { return (scratch.path / "part.inp").string(); }
  explicit Deck(const std::string& text) { write_text(path(), text); }
};

}  // namespace floe::test
