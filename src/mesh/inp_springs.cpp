#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/petsc/all_ranks.h"
#include "inp_reading.h"
#include "springs.h"
#include "text.h"

namespace floe::mesh {

// A line with the directions of SPRING2, which is empty or left out for SPRINGA, and a stiffness.
void read_spring(const InpBlock& block, InpReading& reading) {
  const std::string set = reading.scopes.own(required(block, "ELSET", reading), InpName::elements);
  const auto lines =
      data_lines(block, 1, 2, "perhaps two directions, and a stiffness on the next line", reading.faults);
  if (set.empty() || lines.empty()) return;
  InpUse use{InpUse::spring, set, block.where, 0};
  if (lines.size() == 2) {
    const auto given = numbers(lines[0].second, lines[0].first, 0, 2, "two directions (1 to 6)", reading.faults);
    if (!given) return;
    for (std::size_t i = 0; i < given->size(); ++i) {
      const double direction = (*given)[i];
      if (direction != std::round(direction) || direction < 0 || direction > 6)
        return reading.faults.add(lines[0].first,
                                  "expected directions from 1 to 6, found " + in_quotes(lines[0].second));
      use.directions[i] = static_cast<int>(direction);
    }
  }
  const auto stiffness = numbers(lines.back().second, lines.back().first, 1, 3, "a stiffness", reading.faults);
  if (!stiffness) return;
  use.amount = stiffness->front();
  if (!(use.amount >= 0)) reading.faults.add(lines.back().first, "a stiffness must not be negative");
  reading.uses.push_back(use);
}

double extent_of(MPI_Comm comm, const FileMesh& mesh) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (const Eigen::Vector3d& x : mesh.positions) low = low.cwiseMin(x), high = high.cwiseMax(x);
  MPI_Allreduce(MPI_IN_PLACE, low.data(), 3, MPI_DOUBLE, MPI_MIN, comm);
  MPI_Allreduce(MPI_IN_PLACE, high.data(), 3, MPI_DOUBLE, MPI_MAX, comm);
  return (high - low).norm();
}

namespace {

// Axes whose first is the direction, and which stiffness it is; what is wrong is a fault.
std::optional<NodeSpring> between(const InpSpring& spring, const InpUse& use, const Eigen::Vector3d& along,
                                  double extent, Faults& faults) {
  const std::string name = "spring " + std::to_string(spring.label);
  constexpr double coincident = 1e-5;  // of the extent
  if (spring.axial) {
    if (!(along.norm() > coincident * extent)) {
      faults.add(spring.where, name + " has no length");
      return std::nullopt;
    }
    return line_spring(along, use.amount, spring.label);
  }
  const auto [first, second] = use.directions;
  if (first == 0 || first != second) {
    faults.add(spring.where,
               fmt::format("{} joins direction {} of one node to direction {} of the other, and would resist rigid "
                           "motion; expected one direction from 1 to 6",
                           name, first, second));
    return std::nullopt;
  }
  const Eigen::Vector3d e = Eigen::Vector3d::Unit((first - 1) % 3);
  const double across = (along - e * e.dot(along)).norm();
  if (first <= 3 && across > coincident * extent) {
    faults.add(spring.where,
               fmt::format("{} would resist rigid motion: its nodes are {:.3g} apart across direction {}; "
                           "expected nodes at one point or along it, or SPRINGA",
                           name, across, first));
    return std::nullopt;
  }
  NodeSpring result{{}, {}, Eigen::Matrix3d::Identity(), 0.5, spring.label};
  result.stiffness[static_cast<std::size_t>(first) - 1] = use.amount;
  return result;
}

}  // namespace

void resolve_springs(MPI_Comm comm, InpReading& reading) {
  std::vector<long long> labels;
  for (const InpSpring& spring : reading.springs) labels.insert(labels.end(), spring.nodes.begin(), spring.nodes.end());
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  const auto positions = positions_of(comm, labels, reading);  // in the order of the labels
  const double extent = extent_of(comm, reading.mesh);
  const auto at = [&](long long label) -> const Eigen::Vector3d* {
    const auto found = std::lower_bound(positions.begin(), positions.end(), label,
                                        [](const auto& one, long long wanted) { return one.first < wanted; });
    return found == positions.end() || found->first != label ? nullptr : &found->second;
  };
  for (const InpSpring& spring : reading.springs) {
    const Eigen::Vector3d *a = at(spring.nodes[0]), *b = at(spring.nodes[1]);
    std::optional<NodeSpring> found;
    if (spring.nodes[0] == spring.nodes[1])
      reading.faults.add(spring.where, "spring " + std::to_string(spring.label) + " joins a node to itself");
    else if (a && b)
      found = between(spring, reading.uses[static_cast<std::size_t>(spring.use)], *b - *a, extent, reading.faults);
    else
      found = NodeSpring{{}, {}, Eigen::Matrix3d::Identity()};  // nodes that are not defined: a fault of their mentions
    if (!found) continue;
    for (std::size_t end : {0, 1}) {
      found->nodes[end] = static_cast<PetscInt>(reading.mesh.mentions.size());
      reading.mesh.mentions.push_back({spring.nodes[end], spring.where});
    }
    reading.deck.springs.push_back(*found);
  }
}

}  // namespace floe::mesh
