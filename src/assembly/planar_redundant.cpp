#include "planar_redundant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "connections.h"
#include "floe/dynamics/marker.h"
#include "floe/math/independent_rows.h"

namespace floe::assembly {
namespace {

using Eigen::VectorXd;

/// A body between several joints to the ground: rows C(q) in its own coordinates q = (R, theta, eta).
struct FixedFrameBody {
  struct Hold {
    int joint = 0;
    dynamics::Marker marker;
    Eigen::Matrix<double, Eigen::Dynamic, 3> directions;  ///< of the marker's pose, a row each
    bool driven = false;                                  ///< its last row follows a function of time
  };
  std::vector<Hold> holds;
  /// q at the start, and how far its entries go: deformations by a hundredth of the extent, followed by the frame
  VectorXd start, scale;

  VectorXd rows(const VectorXd& q, Eigen::MatrixXd* gradient) const {
    Eigen::Index count = 0;
    for (const Hold& hold : holds) count += hold.directions.rows();
    VectorXd values(count);
    if (gradient) gradient->resize(count, q.size());
    const VectorXd none = VectorXd::Zero(q.size());
    dynamics::Pose pose;
    Eigen::Index first = 0;
    for (const Hold& hold : holds) {
      const Eigen::Index n = hold.directions.rows();
      dynamics::pose(hold.marker, q, none, none, pose);
      values.segment(first, n) = hold.directions * pose.y;
      if (gradient) gradient->middleRows(first, n) = hold.directions * pose.P * scale.asDiagonal();
      first += n;
    }
    return values;
  }
};

FixedFrameBody fixed_frame_body(const Plan& plan, const ReducedBody& reduced, int b, const std::vector<int>& joints) {
  const PlannedBody& body = plan.bodies[b];
  const int k = reduced.body.coordinates();
  FixedFrameBody constrained;
  for (int j : joints) {
    const Joint& joint = plan.scene.joints[j];
    const Anchor& place = plan.joints[j][plan.joints[j][0].ground() ? 1 : 0];
    const body::PlaceMap map = place_map(plan, reduced, place);
    FixedFrameBody::Hold& hold = constrained.holds.emplace_back();
    hold.joint = j;
    hold.driven = joint.kind == Joint::Kind::driven;
    hold.directions = Eigen::Matrix3d::Identity().topRows(joint_rows(joint));
    if (joint.kind == Joint::Kind::prismatic) {
      const Eigen::Vector2d axis = Eigen::Vector2d(joint.axis[0], joint.axis[1]).normalized();
      hold.directions << -axis.y(), axis.x(), 0, 0, 0, 1;
    }
    hold.marker.framed = true;
    hold.marker.coordinates.resize(3 + k);
    std::iota(hold.marker.coordinates.begin(), hold.marker.coordinates.end(), 0);
    hold.marker.x = map.x.head<2>(), hold.marker.S = map.S, hold.marker.psi = map.psi;
  }
  constrained.start = VectorXd::Zero(3 + k);
  constrained.start.head<3>() = body.pose;
  constrained.scale = VectorXd::Constant(3 + k, 1e-2 * plan.extent * std::sqrt(reduced.body.inertia.m));
  constrained.scale.head<3>() << plan.extent, plan.extent, 1;
  return constrained;
}

/// The joint of a row.
const FixedFrameBody::Hold& hold_of(const FixedFrameBody& constrained, Eigen::Index row) {
  std::size_t h = 0;
  for (; row >= constrained.holds[h].directions.rows(); ++h) row -= constrained.holds[h].directions.rows();
  return constrained.holds[h];
}

/// The row that is furthest from its value where the kept ones have met theirs, the body deformed and driven; and how
/// far.
std::pair<Eigen::Index, double> departure(const FixedFrameBody& constrained, const std::vector<Eigen::Index>& kept,
                                          int sample) {
  VectorXd wanted = constrained.rows(constrained.start, nullptr);
  Eigen::Index end = 0;
  for (const FixedFrameBody::Hold& hold : constrained.holds) {
    end += hold.directions.rows();
    if (hold.driven) wanted[end - 1] += 0.1 * std::sin(2 + 0.9 * static_cast<double>(end) + 1.3 * sample);
  }
  VectorXd q = constrained.start;
  for (Eigen::Index i = 3; i < q.size(); ++i) q[i] += constrained.scale[i] * std::sin(1 + 1.7 * i + 2.3 * sample);
  Eigen::MatrixXd gradient;
  for (int iteration = 0; iteration < 8; ++iteration) {
    const VectorXd off = constrained.rows(q, &gradient) - wanted;
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> least_squares(gradient(kept, Eigen::all));
    q -= constrained.scale.asDiagonal() * least_squares.solve(VectorXd(off(kept)));
  }
  Eigen::Index row = 0;
  const double far = (constrained.rows(q, nullptr) - wanted).cwiseAbs().maxCoeff(&row);
  return {row, far};
}

/// @throws InputError  a row that is not kept does not follow from those that are
void check_left_out(const Plan& plan, const FixedFrameBody& constrained, int b, const std::vector<Eigen::Index>& kept) {
  const Body& body = plan.bodies[b].spec;
  Eigen::Index end = 0;
  for (const FixedFrameBody::Hold& hold : constrained.holds) {
    end += hold.directions.rows();
    const Joint& joint = plan.scene.joints[hold.joint];
    if (hold.driven && !std::binary_search(kept.begin(), kept.end(), end - 1))
      throw InputError(
          fmt::format("{}: no basis vector of body {} represents the rotation driven by joint {}, because other joints "
                      "constrain it as well; expected attachment: joints, or modes: {{of: frame}}",
                      joint.where.text(), body.name, joint.name));
  }
  for (int sample = 0; sample < 3; ++sample) {
    const auto [row, far] = departure(constrained, kept, sample);
    if (!(far > 1e-9 * plan.extent)) continue;
    const Where& place = body.reduced ? body.reduced->where : body.frame.where;
    throw InputError(
        fmt::format("{}: several joints attach body {} to the ground, and its basis satisfies joint {} only while it "
                    "is undeformed; expected frame: pinned, from one joint to the other, with attachment: joints, or "
                    "modes: {{of: frame}}",
                    place.text(), body.name, plan.scene.joints[hold_of(constrained, row).joint].name));
  }
}

void leave_out(const Plan& plan, const FixedFrameBody& constrained, int b, std::vector<std::vector<int>>& independent,
               std::vector<int>& undetermined) {
  Eigen::MatrixXd gradient;
  constrained.rows(constrained.start, &gradient);
  const std::vector<Eigen::Index> kept = math::independent_rows(gradient);
  if (static_cast<Eigen::Index>(kept.size()) == gradient.rows()) return;
  check_left_out(plan, constrained, b, kept);
  std::vector<int> joints;
  for (const Eigen::Index row : math::undetermined_rows(gradient, kept))
    if (const int joint = hold_of(constrained, row).joint; joints.empty() || joints.back() != joint)
      joints.push_back(joint);
  refuse_undetermined(plan.scene, joints);
  undetermined.insert(undetermined.end(), joints.begin(), joints.end());
  Eigen::Index first = 0;
  for (const FixedFrameBody::Hold& hold : constrained.holds) {
    const Eigen::Index n = hold.directions.rows();
    auto& rows = independent[hold.joint];
    rows.clear();
    for (Eigen::Index i : kept)
      if (i >= first && i < first + n) rows.push_back(static_cast<int>(i - first));
    first += n;
  }
}

}  // namespace

int joint_rows(const Joint& joint) {
  switch (joint.kind) {
    case Joint::Kind::fixed:
    case Joint::Kind::driven:
      return 3;
    case Joint::Kind::revolute:
    case Joint::Kind::prismatic:
      return 2;
    default:
      return 0;
  }
}

std::vector<std::vector<int>> independent_rows(const Plan& plan, const std::vector<ReducedBody>& reduced,
                                               std::vector<int>& undetermined) {
  std::vector<std::vector<int>> independent;
  for (const Joint& joint : plan.scene.joints) {
    independent.emplace_back(joint_rows(joint));
    std::iota(independent.back().begin(), independent.back().end(), 0);
  }
  for (int b = 0; b < static_cast<int>(reduced.size()); ++b) {
    if (plan.bodies[b].spec.rigid || (!reduced[b].basis && !plan.bodies[b].spec.reduced)) continue;
    std::vector<int> joints;
    std::set<PetscInt> nodes;
    for (std::size_t j = 0; j < plan.joints.size(); ++j) {
      const auto& [first, second] = plan.joints[j];
      const Joint& joint = plan.scene.joints[j];
      if (first.ground() == second.ground() || std::max(first.body, second.body) != b || joint_rows(joint) == 0)
        continue;
      joints.push_back(static_cast<int>(j));
      nodes.insert(first.ground() ? second.node : first.node);
    }
    if (nodes.size() < 2 || nodes.size() < joints.size()) continue;  // joints at one place contradict
    leave_out(plan, fixed_frame_body(plan, reduced[b], b, joints), b, independent, undetermined);
  }
  return independent;
}

}  // namespace floe::assembly
