#include <algorithm>
#include <numeric>

#include "floe/reduction/place_set.h"
#include "spatial_assembly.h"

// Joints between the pieces of a split body (plan::Interface): at full order every pair of nodes is fixed, in reduced
// models the sums over the pairs that the interface vectors define.
namespace floe::assembly {

using dynamics::Along;
using dynamics::SpatialConstraint;
using Eigen::Index;

namespace {

const Interface& interface_of(const Plan& plan, int joint) {
  static const Interface none;
  return plan.interfaces.empty() ? none : plan.interfaces[joint];
}

/// Moments about z, x, y, as the products of fixed places have them; about z, the normal, where there is none.
SpatialConstraint vanishing_moments(const Interface& cut) {
  if (cut.rows_of_higher() < 6) return {{Along{0}, Along{1}}};
  return {{Along{2}, Along{0}, Along{1}}};
}
SpatialConstraint vanishing_forces() { return {{Along{0}, Along{1}, Along{2}}}; }
SpatialConstraint vanishing_force_across() { return {{Along{0}}}; }

}  // namespace

int SpatialAssembly::row_count(int j) const {
  if (stands(j)) return 0;
  if (const auto found = constrained_nodes_.find(j); found != constrained_nodes_.end())
    return std::accumulate(found->second.begin(), found->second.end(), 0,
                           [](int sum, const ConstrainedNode& one) { return sum + static_cast<int>(one.dofs.size()); });
  const Interface& cut = interface_of(plan_, j);
  if (cut.empty()) return spatial_rows(plan_.scene.joints[j].kind);
  if (!is_reduced(formulation_)) return 6 * static_cast<int>(std::ssize(cut.pairs));
  return 6 + static_cast<int>(cut.rows_of_higher() * (cut.whole() - 1) + cut.across);
}

void SpatialAssembly::count_uses() {
  const auto use = [&](const Anchor& place) {
    for (const AveragingWeight& weight : place.averaging_weights) ++uses_[{place.body, weight.node}];
  };
  for (int j = 0; j < static_cast<int>(plan_.joints.size()); ++j) {
    if (const Interface& cut = interface_of(plan_, j); cut.empty())
      use(plan_.joints[j][0]), use(plan_.joints[j][1]);
    else
      for (const auto& pair : cut.pairs) use(pair[0]), use(pair[1]);
  }
}

bool SpatialAssembly::stands_apart(int j, std::size_t piece) const {
  if (const auto found = constrained_nodes_.find(j); found != constrained_nodes_.end())
    return uses_.at({constrained_place(plan_, j)->body, found->second[piece].node}) == 1;
  const Interface& cut = interface_of(plan_, j);
  if (cut.empty() || is_reduced(formulation_)) return false;
  const auto free = [&](const Anchor& node) {
    if (node.averaging_weights.size() != 1 || node.averaging_weights[0].node != node.nodes[0]) return false;
    const fem::Conditions& none = constrained(node.body);
    const auto first = std::lower_bound(none.begin(), none.end(), 6 * node.nodes[0]);
    return (first == none.end() || *first >= 6 * node.nodes[0] + 6) && uses_.at({node.body, node.nodes[0]}) == 1;
  };
  return free(cut.pairs[piece][0]) || free(cut.pairs[piece][1]);
}

std::vector<SpatialAssembly::PlacedJoint> SpatialAssembly::place_all(int j) {
  const Interface& cut = interface_of(plan_, j);
  if (constrained_nodes_.contains(j)) return place_constrained_nodes(j);
  std::vector<PlacedJoint> all;
  if (cut.empty() || is_reduced(formulation_)) all.push_back(place(j, plan_.joints[j]));
  if (cut.empty()) return all;
  if (!is_reduced(formulation_)) {
    for (const auto& pair : cut.pairs) all.push_back(place(j, pair));
    return all;
  }
  for (Index vector = 1; vector < cut.factors.cols(); ++vector) {
    PlacedJoint forces{{marker(cut.sum(0, vector)), marker(cut.sum(1, vector))}, vanishing_forces()};
    for (int side : {0, 1}) {
      dynamics::SpatialMarker& at = forces.places[side];
      at.mass = 0;  // the factors sum up to zero
      at.D0 = plan_.bodies[plan_.joints[j][side].body].attitude.transpose() * plan_.joint_axes[j];
    }
    if (vector >= cut.whole()) {
      forces.constraint = vanishing_force_across();
      for (dynamics::SpatialMarker& at : forces.places) at.psi.setZero();
      all.push_back(std::move(forces));
      continue;
    }
    PlacedJoint moments{forces.places, vanishing_moments(cut)};
    for (int side : {0, 1}) {
      moments.places[side].S = forces.places[side].psi;
      moments.places[side].x0.setZero();
      for (PlacedJoint* one : {&forces, &moments}) one->places[side].psi.setZero();
    }
    for (dynamics::SpatialMarker& at : moments.places) at.Q = {}, at.arm.setZero();
    all.push_back(std::move(forces));
    all.push_back(std::move(moments));
  }
  return all;
}

JointMultipliers SpatialAssembly::multipliers_of(int j) const {
  JointMultipliers own{multipliers_[j], std::vector<int>(static_cast<std::size_t>(row_count(j)))};
  std::iota(own.rows.begin(), own.rows.end(), 0);
  const Interface& cut = interface_of(plan_, j);
  if (cut.empty() || own.rows.empty() || !is_reduced(formulation_)) return own;
  own.at_nodes.setZero(6 * std::ssize(cut.pairs), std::ssize(own.rows));
  for (Index node = 0; node < std::ssize(cut.pairs); ++node) {
    for (Index i = 0; i < cut.across; ++i)
      own.at_nodes(6 * node, own.at_nodes.cols() - cut.across + i) = cut.factors(node, cut.whole() + i);
    for (Index vector = 0; vector < cut.whole(); ++vector) {
      const Index rows = vector == 0 ? 6 : cut.rows_of_higher(), first = vector == 0 ? 0 : 6 + rows * (vector - 1);
      own.at_nodes.block<3, 3>(6 * node, first).diagonal().setConstant(cut.factors(node, vector));
      for (Index i = 3; i < rows; ++i) own.at_nodes(6 * node + i + (6 - rows), first + i) = cut.factors(node, vector);
    }
  }
  const Eigen::Matrix3d W = plan_.bodies[plan_.joints[j][0].body].attitude.transpose() * plan_.joint_axes[j],
                        moments = (Eigen::Matrix3d() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished() * W.transpose();
  for (Index node = 0; node < std::ssize(cut.pairs); ++node) {
    const reduction::WeightedNode& at = (*cut.means[0])[static_cast<std::size_t>(node)];
    own.at_nodes.block<3, 3>(6 * node, 3) += W.transpose() * at.turn.transpose() * moments.transpose();
    own.at_nodes.block<3, 3>(6 * node + 3, 3) += moments * at.twist.transpose() * moments.transpose();
  }
  return own;
}

}  // namespace floe::assembly
