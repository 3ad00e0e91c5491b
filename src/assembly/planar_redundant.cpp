#include "planar_redundant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <set>

#include "connections.h"
#include "floe/dynamics/constraint_rows.h"
#include "floe/dynamics/joints.h"
#include "floe/math/independent_rows.h"

namespace floe::assembly {
namespace {

using dynamics::Marker;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rows C(q) of joints between the ground and bodies with a frame (rigid, reduced, from files), in their coordinates q
/// = (R, theta, eta), body by body.
class JointRows {
 public:
  /// @param rows  of each of the scene's joints, those that have been kept so far
  JointRows(const Plan& plan, const std::vector<ReducedBody>& reduced, const std::vector<int>& joints,
            const std::vector<std::vector<int>>& rows)
      : plan_(plan), reduced_(reduced) {
    for (const int j : joints)
      for (const Anchor& place : plan.joints[j])
        if (!place.ground() && !first_.contains(place.body)) add_body(place.body);
    for (const int j : joints) add(j, rows[j]);
  }

  struct Entry {
    int joint;
    std::vector<int> rows;  ///< of its constraint
    bool driven;            ///< its last row follows a function of time
  };
  const Entry& entry_of(Index row) const { return entries_[rows_.term_of(row)]; }
  const std::vector<Entry>& entries() const { return entries_; }

  /// Derivatives at the start by q in parts of its scale.
  MatrixXd gradient() const {
    MatrixXd gradient;
    rows_.values(start_, 0, &gradient);
    return gradient * scale_.asDiagonal();
  }

  /// The row that is furthest from its value where the kept ones have met theirs, the bodies deformed and driven, and
  /// moved by so many parts of the extent (driven by a tenth of `deformed`); and how far, in extents or radians.
  /// Infinite where the kept ones are not met.
  std::pair<Index, double> departure(const std::vector<Index>& kept, int sample, double moved, double deformed) const {
    VectorXd wanted = rows_.values(start_, 0, nullptr);
    Index end = 0;
    for (const Entry& entry : entries_) {
      end += static_cast<Index>(entry.rows.size());
      if (entry.driven) wanted[end - 1] += 0.1 * deformed * std::sin(2 + 0.9 * static_cast<double>(end) + 1.3 * sample);
    }
    VectorXd q = start_;
    for (Index i = 0; i < q.size(); ++i)
      q[i] += (frame_[i] ? moved : deformed) * scale_[i] * std::sin(1 + 1.7 * static_cast<double>(i) + 2.3 * sample);
    MatrixXd gradient;
    for (int iteration = 0; iteration < 12; ++iteration) {
      const VectorXd off = rows_.values(q, 0, &gradient) - wanted;
      const Eigen::CompleteOrthogonalDecomposition<MatrixXd> least_squares(gradient(kept, Eigen::all) *
                                                                           scale_.asDiagonal());
      q -= scale_.asDiagonal() * least_squares.solve(VectorXd(off(kept)));
    }
    const VectorXd off =
        (rows_.values(q, 0, nullptr) - wanted).cwiseAbs().cwiseQuotient(VectorXd::Map(unit_.data(), wanted.size()));
    if (!(VectorXd(off(kept)).norm() <= 1e-11)) return {0, INFINITY};
    Index row = 0;
    const double far = off.maxCoeff(&row);
    return {row, far};
  }

 private:
  void add_body(int b) {
    const Index first = start_.size(), k = reduced_[b].body.coordinates();
    first_[b] = first;
    start_.conservativeResize(first + 3 + k), scale_.conservativeResize(first + 3 + k);
    start_.segment<3>(first) = plan_.bodies[b].pose;
    start_.tail(k).setZero();
    scale_.segment<3>(first) << plan_.extent, plan_.extent, 1;
    scale_.tail(k).setConstant(1e-2 * plan_.extent * std::sqrt(reduced_[b].body.inertia.m));
    frame_.resize(static_cast<std::size_t>(first + 3 + k), 0);
    std::fill_n(frame_.begin() + first, 3, 1);
  }

  Marker marker(const Anchor& place) const {
    if (place.ground()) return Marker::ground(place.x.head<2>());
    const body::PlaceMap map = place_map(plan_, reduced_[place.body], place);
    Marker at;
    at.framed = true;
    at.coordinates.resize(static_cast<std::size_t>(3 + reduced_[place.body].body.coordinates()));
    std::iota(at.coordinates.begin(), at.coordinates.end(), static_cast<int>(first_.at(place.body)));
    at.x = plan_.bodies[place.body].spec.rigid ? Eigen::Vector2d(place.x.head<2>()) : Eigen::Vector2d(map.x);
    at.S = map.S, at.psi = map.psi;
    return at;
  }
  Eigen::Vector3d pose(const Marker& marker) const {
    VectorXd q = VectorXd::Zero(static_cast<Index>(marker.coordinates.size()));
    for (Index i = 0; i < q.size(); ++i) q[i] = start_[marker.coordinates[i]];
    const VectorXd none = VectorXd::Zero(q.size());
    dynamics::Pose at;
    dynamics::pose(marker, q, none, none, at);
    return at.y;
  }

  void add(int j, const std::vector<int>& rows) {
    const Joint& joint = plan_.scene.joints[j];
    std::array<Marker, 2> places{marker(plan_.joints[j][0]), marker(plan_.joints[j][1])};
    for (int i = 0; i < 2; ++i)  // a ground without a point follows the other place
      if (plan_.joints[j][i].ground() && std::isnan(places[i].x.x())) places[i].x = pose(places[1 - i]).head<2>();
    dynamics::Constraint constraint = dynamics::Revolute{};
    if (joint.kind == Joint::Kind::fixed || joint.kind == Joint::Kind::driven) constraint = dynamics::Clamp{};
    if (joint.kind == Joint::Kind::prismatic) {
      const Eigen::Vector2d axis = Eigen::Vector2d(joint.axis[0], joint.axis[1]).normalized();
      constraint = dynamics::Prismatic{rotation_matrix(-pose(places[0])[2]) * Eigen::Vector2d(-axis.y(), axis.x())};
    }
    const auto term = std::make_shared<dynamics::Joint>(places[0], places[1], constraint, -1, rows);
    const Index count = static_cast<Index>(rows.size());
    rows_.add(term, {term->coordinates().begin(), term->coordinates().end() - count}, count);
    const int lengths = joint.kind == Joint::Kind::prismatic ? 1 : 2;  // the rows before those of angles
    for (const int row : rows) unit_.push_back(row < lengths && plan_.extent > 0 ? plan_.extent : 1);
    entries_.push_back({j, rows, joint.kind == Joint::Kind::driven && !rows.empty() && rows.back() == 2});
  }

  const Plan& plan_;
  const std::vector<ReducedBody>& reduced_;
  std::map<int, Index> first_;  ///< of each body's coordinates
  /// q at the start, and how far its entries go: deformations by a hundredth of the extent, followed by the frame
  VectorXd start_, scale_;
  std::vector<char> frame_;   ///< of each entry of q
  std::vector<double> unit_;  ///< of each row
  dynamics::ConstraintRows rows_;
  std::vector<Entry> entries_;
};

/// @throws InputError  a row that is not kept does not follow from those that are
void check_left_out(const Plan& plan, const JointRows& rows, int b, const std::vector<Index>& kept) {
  const Body& body = plan.bodies[b].spec;
  Index end = 0;
  for (const JointRows::Entry& entry : rows.entries()) {
    end += static_cast<Index>(entry.rows.size());
    const Joint& joint = plan.scene.joints[entry.joint];
    if (entry.driven && !std::binary_search(kept.begin(), kept.end(), end - 1))
      throw InputError(
          fmt::format("{}: no basis vector of body {} represents the rotation driven by joint {}, because other joints "
                      "constrain it as well; expected attachment: joints, or modes: {{of: frame}}",
                      joint.where.text(), body.name, joint.name));
  }
  for (int sample = 0; sample < 3; ++sample) {
    const auto [row, far] = rows.departure(kept, sample, 0, 1);
    if (!(far > 1e-9)) continue;
    const Where& place = body.reduced ? body.reduced->where : body.frame.where;
    throw InputError(
        fmt::format("{}: several joints attach body {} to the ground, and its basis satisfies joint {} only while it "
                    "is undeformed; expected frame: pinned, from one joint to the other, with attachment: joints, or "
                    "modes: {{of: frame}}",
                    place.text(), body.name, plan.scene.joints[rows.entry_of(row).joint].name));
  }
}

/// Those whose multipliers the rows do not determine.
std::vector<int> undetermined_joints(const JointRows& rows, const MatrixXd& gradient, const std::vector<Index>& kept) {
  std::vector<int> joints;
  for (const Index row : math::undetermined_rows(gradient, kept))
    if (const int joint = rows.entry_of(row).joint; joints.empty() || joints.back() != joint) joints.push_back(joint);
  return joints;
}

/// Takes the rows that are not kept out of `independent`, and notes the joints whose multipliers are not determined.
void take_out(const Plan& plan, const JointRows& rows, const MatrixXd& gradient, const std::vector<Index>& kept,
              std::vector<std::vector<int>>& independent, std::vector<int>& undetermined) {
  const std::vector<int> joints = undetermined_joints(rows, gradient, kept);
  refuse_undetermined(plan.scene, joints);
  undetermined.insert(undetermined.end(), joints.begin(), joints.end());
  Index row = 0;
  for (const JointRows::Entry& entry : rows.entries()) {
    auto& own = independent[entry.joint];
    own.clear();
    for (const int i : entry.rows)
      if (std::binary_search(kept.begin(), kept.end(), row++)) own.push_back(i);
  }
}

/// Of a flexible body between several joints to the ground: its basis may satisfy what they hold.
void leave_out_of_body(const Plan& plan, const std::vector<ReducedBody>& reduced, int b, const std::vector<int>& joints,
                       std::vector<std::vector<int>>& independent, std::vector<int>& undetermined) {
  const JointRows rows(plan, reduced, joints, independent);
  const MatrixXd gradient = rows.gradient();
  const std::vector<Index> kept = math::independent_rows(gradient);
  if (static_cast<Index>(kept.size()) == gradient.rows()) return;
  check_left_out(plan, rows, b, kept);
  take_out(plan, rows, gradient, kept, independent, undetermined);
}

/// Whether the rows that are not kept remain satisfied wherever the others are; not where they depend on these at the
/// start alone, in a singular position. Near such a position large moves can lead to another branch, on which a row
/// departs by as much as the bodies move: then smaller moves decide. A row that departs by less is one that touches the
/// others' motion to a higher order (a guide along the straight part of Watt's curve).
bool follow(const JointRows& rows, const std::vector<Index>& kept) {
  for (const double moved : {0.05, 0.01, 0.002}) {
    int tried = 0;
    bool branched = false;
    for (int sample = 0; sample < 8 && tried < 4 && !branched; ++sample) {
      const double far = rows.departure(kept, sample, moved, 20 * moved).second;
      if (!std::isfinite(far)) continue;
      branched = far >= 0.1 * moved;
      if (far > 1e-10 && !branched) return false;
      ++tried;
    }
    if (tried > 0 && !branched) return true;
  }
  return false;
}

/// Of all bodies with a frame: what remains redundant (a third parallel crank, a second guide on the same line).
void leave_out_of_mechanism(const Plan& plan, const std::vector<ReducedBody>& reduced, const std::vector<int>& joints,
                            std::vector<std::vector<int>>& independent, std::vector<int>& undetermined,
                            std::vector<std::string>& notes) {
  const JointRows rows(plan, reduced, joints, independent);
  const MatrixXd gradient = rows.gradient();
  const std::vector<Index> kept = math::independent_rows(gradient);
  if (static_cast<Index>(kept.size()) == gradient.rows()) return;
  if (!follow(rows, kept)) return refuse_undetermined(plan.scene, undetermined_joints(rows, gradient, kept));
  std::map<int, std::size_t> before;
  for (const int j : joints) before[j] = independent[j].size();
  take_out(plan, rows, gradient, kept, independent, undetermined);
  for (const auto& [j, count] : before)
    if (const std::size_t left_out = count - independent[j].size(); left_out > 0)
      notes.push_back(fmt::format("joint {}: {} of its {} constraints are redundant with other joints and eliminated",
                                  plan.scene.joints[j].name, left_out, count));
}

/// @throws InputError  a joint that an event unlocks is redundant at the start: the rows that it makes redundant would
/// have to come back
void refuse_switched(const Plan& plan, const std::vector<ReducedBody>& reduced, const std::vector<int>& always,
                     const std::vector<int>& switched, const std::vector<std::vector<int>>& independent) {
  if (switched.empty()) return;
  std::vector<int> joints = always;
  joints.insert(joints.end(), switched.begin(), switched.end());
  const JointRows rows(plan, reduced, joints, independent);
  const MatrixXd gradient = rows.gradient();
  const std::vector<Index> kept = math::independent_rows(gradient);
  if (static_cast<Index>(kept.size()) == gradient.rows() || !follow(rows, kept)) return;
  Index row = 0;
  while (row < static_cast<Index>(kept.size()) && kept[row] == row) ++row;
  const Joint& joint = plan.scene.joints[rows.entry_of(row).joint];
  throw InputError(fmt::format(
      "{}: joint {} is redundant with other joints, and an event unlocks it; expected joints that constrain "
      "different motions",
      joint.where.text(), joint.name));
}

/// Whether its coordinates are those of a frame and of a basis.
bool has_frame(const Plan& plan, const std::vector<ReducedBody>& reduced, int b) {
  return plan.bodies[b].spec.rigid || reduced[b].basis || plan.bodies[b].spec.reduced;
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
                                               const std::map<std::string, JointSwitches>& switches,
                                               std::vector<int>& undetermined, std::vector<std::string>& notes) {
  std::vector<std::vector<int>> independent;
  for (const Joint& joint : plan.scene.joints) {
    independent.emplace_back(joint_rows(joint));
    std::iota(independent.back().begin(), independent.back().end(), 0);
  }
  for (int b = 0; b < static_cast<int>(reduced.size()); ++b) {
    if (plan.bodies[b].spec.rigid || !has_frame(plan, reduced, b)) continue;
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
    leave_out_of_body(plan, reduced, b, joints, independent, undetermined);
  }
  std::vector<int> always, switched;
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const auto framed = [&](const Anchor& place) { return place.ground() || has_frame(plan, reduced, place.body); };
    const auto found = switches.find(plan.scene.joints[j].name);
    if (independent[j].empty() || !framed(plan.joints[j][0]) || !framed(plan.joints[j][1])) continue;
    const bool unlocked = found != switches.end() && found->second.joint;
    if (!unlocked)
      always.push_back(static_cast<int>(j));
    else if (found->second.joint->closed)
      switched.push_back(static_cast<int>(j));
  }
  leave_out_of_mechanism(plan, reduced, always, independent, undetermined, notes);
  refuse_switched(plan, reduced, always, switched, independent);
  return independent;
}

}  // namespace floe::assembly
