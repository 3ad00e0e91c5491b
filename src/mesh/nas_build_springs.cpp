#include <fmt/format.h>

#include <algorithm>

#include "nas_build.h"
#include "springs.h"
#include "text.h"

namespace floe::mesh {
namespace {

std::string name_of(const NasSpring& spring) {
  return (spring.scalar() ? "spring " : "CBUSH ") + std::to_string(spring.id);
}

}  // namespace

/// Springs to ground resist rigid motions of the body: they are no part of it.
void NasBuild::report_grounded() {
  std::vector<std::string> samples;
  long long count = 0;
  const NasSpring* first = nullptr;
  for (const NasSpring& spring : model_.springs) {
    if (spring.grids[0] > 0 && spring.grids[1] > 0) continue;
    if (!first) first = &spring;
    constexpr long long most = 3;
    if (++count <= most) {
      const int end = spring.grids[0] > 0 ? 0 : 1;
      const std::string direction =
          spring.scalar() ? fmt::format(", direction {}", spring.components[end]) : std::string();
      samples.push_back(fmt::format("{} at grid {}{}", name_of(spring), spring.grids[end], direction));
    }
  }
  if (first)
    notices.push_back(
        fmt::format("{}: {} to ground left out ({}{}): a spring to ground resists rigid motion; use "
                    "springs or bushings of the scene",
                    faults_.text_of(first->where), counted(count, "spring"), listed(samples),
                    count > static_cast<long long>(samples.size()) ? ", ..." : ""));
}

/// Axes and stiffness of a scalar spring between equal components of two grids. It resists no rigid motion only where
/// its grids have one direction of it, and lie at one point or along it.
std::optional<NodeSpring> NasBuild::scalar_spring(const NasSpring& spring, const std::array<Eigen::Vector3d, 2>& x) {
  const auto refuse = [&](const std::string& text) {
    faults_.add(spring.where, name_of(spring) + " would resist rigid motion: " + text);
    return std::nullopt;
  };
  const auto [first, second] = spring.components;
  if (first != second)
    return refuse(fmt::format("it joins direction {} of one grid to direction {} of the other; expected one direction",
                              first, second));
  const int i = (first - 1) % 3;
  std::array<Eigen::Vector3d, 2> e;
  for (int end : {0, 1}) {
    const NasGrid& grid = *frames_.grid(spring.grids[end]);
    e[end] = frames_.directions(frames_.displacement_axes(grid), x[end], spring.where).col(i);
  }
  constexpr double parallel = 1e-6, coincident = 1e-5;  // of the extent of all grids
  if (!((e[0] - e[1]).norm() < parallel))
    return refuse(fmt::format("direction {} of its grids is not the same (CD)", first));
  const Eigen::Vector3d across = (x[1] - x[0]) - e[0] * e[0].dot(x[1] - x[0]);
  if (first <= 3 && across.norm() > coincident * extent())
    return refuse(
        fmt::format("its grids are {:.3g} apart across direction {}; expected grids at one point or along "
                    "it, or CBUSH",
                    across.norm(), first));
  double stiffness = spring.stiffness;
  if (spring.property > 0) {
    const auto found = model_.scalar_stiffness.find(spring.property);
    if (found == model_.scalar_stiffness.end()) {
      faults_.add(spring.where,
                  fmt::format("{} names PELAS {}, which is not defined", name_of(spring), spring.property));
      return std::nullopt;
    }
    stiffness = found->second;
  }
  NodeSpring result{{}, {}, axes_along(e[0]), 0.5, spring.id};
  result.stiffness[first <= 3 ? 0 : 3] = stiffness;
  return result;
}

std::optional<NodeSpring> NasBuild::bush(const NasSpring& spring, const std::array<Eigen::Vector3d, 2>& x) {
  const auto found = model_.bush_stiffness.find(spring.property);
  if (found == model_.bush_stiffness.end()) {
    faults_.add(spring.where, fmt::format("{} names PBUSH {}, which is not defined", name_of(spring), spring.property));
    return std::nullopt;
  }
  NodeSpring result{{}, found->second, Eigen::Matrix3d::Identity(), spring.at, spring.id};
  const Eigen::Vector3d along = x[1] - x[0];
  const auto refuse = [&](const char* text) {
    faults_.add(spring.where, name_of(spring) + text);
    return std::nullopt;
  };
  if (spring.axes >= 0) {
    result.axes = frames_.directions(spring.axes, x[0], spring.where);
    return result;
  }
  if (!(along.norm() > 1e-9 * extent())) return refuse(" has grids at one point; expected axes (CID)");
  result.axes = axes_along(along);
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  if (spring.orientation_node > 0) {
    if (const auto at = frames_.position(spring.orientation_node, spring.where)) v = *at - x[0];
  } else if (!spring.orientation.isZero(0)) {
    const NasGrid& grid = *frames_.grid(spring.grids[0]);
    v = frames_.directions(frames_.displacement_axes(grid), x[0], spring.where) * spring.orientation;
  } else {
    const auto& k = result.stiffness;
    const bool of_the_line = k[1] == k[2] && k[4] == k[5];  // the same about it in all directions
    if (!of_the_line) return refuse(" has stiffnesses across its line; expected an orientation vector or axes (CID)");
    return result;
  }
  const Eigen::Vector3d z = result.axes.col(0).cross(v);
  if (!(z.norm() > 1e-6 * v.norm())) return refuse(": its orientation vector is parallel to its line");
  result.axes.col(2) = z.normalized();
  result.axes.col(1) = result.axes.col(2).cross(result.axes.col(0));
  return result;
}

double NasBuild::extent() {
  if (extent_ >= 0) return extent_;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (const NasGrid& grid : model_.grids) {
    const Eigen::Vector3d x = frames_.position_of(grid);
    low = low.cwiseMin(x), high = high.cwiseMax(x);
  }
  return extent_ = (high - low).norm();
}

void NasBuild::add_springs() {
  report_grounded();
  for (const NasSpring& spring : model_.springs) {
    if (spring.grids[0] <= 0 || spring.grids[1] <= 0) continue;
    if (spring.grids[0] == spring.grids[1]) {
      faults_.add(spring.where, name_of(spring) + " joins a grid to itself");
      continue;
    }
    std::array<Eigen::Vector3d, 2> x;
    bool known = true;
    for (int end : {0, 1}) {
      const auto at = frames_.position(spring.grids[end], spring.where);
      known = known && at;
      if (at) x[end] = *at;
    }
    if (!known) continue;
    auto found = spring.scalar() ? scalar_spring(spring, x) : bush(spring, x);
    if (!found || rank_ != 0) continue;
    for (int end : {0, 1}) {
      found->nodes[end] = static_cast<PetscInt>(mesh.mentions.size());
      mesh.mentions.push_back({spring.grids[end], spring.where});
    }
    deck.springs.push_back(*found);
  }
}

}  // namespace floe::mesh
