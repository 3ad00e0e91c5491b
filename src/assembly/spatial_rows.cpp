#include "spatial_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "connections.h"
#include "floe/math/independent_rows.h"
#include "floe/math/rotation.h"

namespace floe::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

int SpatialRows::seen(int coordinate) {
  const auto [found, fresh] = number_.emplace(coordinate, static_cast<int>(number_.size()));
  if (fresh) start_.push_back(all_[coordinate]), reach_.push_back(0), moves_.push_back(0);
  return found->second;
}

void SpatialRows::add(int joint, const std::array<dynamics::SpatialMarker, 2>& places,
                      const dynamics::SpatialConstraint& constraint) {
  const int rows = dynamics::rows(constraint);
  const auto term = std::make_shared<dynamics::SpatialJoint>(places[0], places[1], constraint, -1);
  std::vector<Index> at;
  for (std::size_t i = 0; i + rows < term->coordinates().size(); ++i) at.push_back(seen(term->coordinates()[i]));
  for (const dynamics::SpatialMarker& place : places) {
    if (place.framed() && !frames_.contains(place.coordinates[0])) {
      Frame frame;
      for (std::size_t i = 0; i < 6; ++i) frame.at[i] = seen(place.coordinates[i]);
      frame.about = place.attitude->axes(Eigen::Vector3d::Zero()) * math::skew(place.x0);
      frames_.emplace(place.coordinates[0], frame);
    }
    for (std::size_t i = 0; i < place.coordinates.size(); ++i) {
      const int own = seen(place.coordinates[i]);
      if (place.framed() && i < 6) {
        moves_[own] = 1;
        reach_[own] = 1e-2 / (i < 3 ? plan_.extent : 1);
        continue;
      }
      const Index column = static_cast<Index>(i) - (place.framed() ? 6 : 0);
      reach_[own] = std::max(reach_[own], place.S.col(column).norm() / plan_.extent + place.psi.col(column).norm());
      greatest_reach_ = std::max(greatest_reach_, reach_[own]);
    }
  }
  for (const dynamics::SpatialRow& row : constraint.rows)
    unit_.push_back(std::holds_alternative<dynamics::Product>(row) ? 1 : plan_.extent);
  rows_.add(term, std::move(at), rows);
  joints_.push_back(joint), counts_.push_back(rows);
}

VectorXd SpatialRows::scales() const {
  VectorXd scales = VectorXd::Zero(static_cast<Index>(reach_.size()));
  for (std::size_t i = 0; i < reach_.size(); ++i)
    if (moves_[i] || reach_[i] > 1e-10 * greatest_reach_) scales[static_cast<Index>(i)] = 1e-2 / reach_[i];
  return scales;
}

MatrixXd SpatialRows::directions() const {
  const VectorXd scale = scales();
  MatrixXd D = scale.asDiagonal();
  for (const auto& [local, frame] : frames_)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) D(frame.at[i], frame.at[3 + j]) = frame.about(i, j) * scale[frame.at[3 + j]];
  return D;
}

VectorXd SpatialRows::values(const VectorXd& q, double t, MatrixXd* gradient) const {
  VectorXd C = rows_.values(q, t, gradient);
  if (gradient) *gradient = *gradient * directions();
  for (Index i = 0; i < C.size(); ++i) {
    C[i] /= unit_[i];
    if (gradient) gradient->row(i) /= unit_[i];
  }
  return C;
}

/// The nearest configuration in which the kept rows are met; NaN where none is found.
VectorXd SpatialRows::allowed(const VectorXd& q, double t, const std::vector<Index>& kept) const {
  VectorXd x = q;
  MatrixXd gradient;
  for (int iteration = 0; iteration < 20; ++iteration) {
    const VectorXd off = values(x, t, &gradient)(kept);
    if (off.size() == 0 || off.cwiseAbs().maxCoeff() < 1e-13) return x;
    const Eigen::CompleteOrthogonalDecomposition<MatrixXd> least_squares(gradient(kept, Eigen::all));
    x -= directions() * least_squares.solve(off);
  }
  if (values(x, t, nullptr)(kept).cwiseAbs().maxCoeff() < 1e-11) return x;
  return VectorXd::Constant(q.size(), std::nan(""));
}

void SpatialRows::check_left_out(const std::vector<Index>& kept) const {
  const auto complain = [&](Index row, const std::string& when) {
    const Joint& joint = plan_.scene.joints[joint_of(row)];
    throw InputError(
        fmt::format("{}: joint {} is redundant with other joints and inconsistent with them {}; expected joints "
                    "whose constraints "
                    "are consistent throughout the motion",
                    joint.where.text(), joint.name, when));
  };
  Index row = 0;
  const VectorXd q = VectorXd::Map(start_.data(), static_cast<Index>(start_.size()));
  if (values(q, 0, nullptr).cwiseAbs().maxCoeff(&row) > 1e-6) complain(row, "at the start");
  const double end = std::isfinite(plan_.scene.motion.end) ? plan_.scene.motion.end : 0;
  const VectorXd scale = scales();
  for (int sample = 0; sample < 4; ++sample) {
    const double t = end * sample / 64;
    VectorXd moved = q;
    for (Index i = 0; i < q.size(); ++i)  // frames by a twentieth, elastic coordinates by a hundredth
      moved[i] += (moves_[i] ? 0.05 : 1) * scale[i] * std::sin(1 + 1.7 * static_cast<double>(i) + 2.3 * sample);
    moved = allowed(moved, t, kept);
    if (!moved.allFinite()) continue;
    if (values(moved, t, nullptr).cwiseAbs().maxCoeff(&row) > 1e-8)
      complain(row, sample == 0 ? "once bodies move or deform" : fmt::format("at t = {:.6g}", t));
  }
  follow_drives(q, end, kept, complain);
}

/// Drives may begin late: through the whole motion, from one configuration that the kept rows allow to the next, as far
/// as they can be followed. What nobody can foresee the motion finds (SpatialJoint::constraint_status).
void SpatialRows::follow_drives(const VectorXd& start, double end, const std::vector<Index>& kept,
                                const std::function<void(Index, const std::string&)>& complain) const {
  const auto driven = [&](int joint) {
    const Joint::Kind kind = plan_.scene.joints[joint].kind;
    return kind == Joint::Kind::driven || kind == Joint::Kind::driven_slide;
  };
  if (!std::any_of(joints_.begin(), joints_.end(), driven)) return;
  constexpr int samples = 256;
  VectorXd x = start;
  for (int sample = 1; sample <= samples; ++sample) {
    const double t = end * sample / samples;
    x = allowed(x, t, kept);
    if (!x.allFinite() || !rows_.satisfied(x, t)) return;
    Index row = 0;
    if (values(x, t, nullptr).cwiseAbs().maxCoeff(&row) > 1e-6) complain(row, fmt::format("at t = {:.6g}", t));
  }
}

std::vector<std::vector<int>> SpatialRows::independent(std::string& notes, std::vector<int>& undetermined) const {
  std::vector<std::vector<int>> all;
  if (joints_.empty()) return all;
  MatrixXd gradient;
  values(VectorXd::Map(start_.data(), static_cast<Index>(start_.size())), 0, &gradient);
  const std::vector<Index> kept = math::independent_rows(gradient, 1e-3);
  if (static_cast<Index>(kept.size()) < gradient.rows()) {
    check_left_out(kept);
    std::vector<int> joints;
    for (const Index row : math::undetermined_rows(gradient, kept))
      if (const int joint = joint_of(row); joints.empty() || joints.back() != joint) joints.push_back(joint);
    refuse_undetermined(plan_.scene, joints);
    undetermined = std::move(joints);
  }
  Index first = 0;
  for (std::size_t e = 0; e < joints_.size(); ++e) {
    const int count = counts_[e];
    auto& rows = all.emplace_back();
    for (Index i : kept)
      if (i >= first && i < first + count) rows.push_back(static_cast<int>(i - first));
    int left_out = 0;  // rows without gradient are those that the columns meet by themselves
    for (Index i = first; i < first + count; ++i)
      if (!std::binary_search(kept.begin(), kept.end(), i) && gradient.row(i).norm() > 1e-6) ++left_out;
    if (left_out > 0)
      notes += fmt::format("joint {}: {} of its {} constraints are redundant with other joints and eliminated\n",
                           plan_.scene.joints[joints_[e]].name, left_out, count);
    first += count;
  }
  return all;
}

}  // namespace floe::assembly
