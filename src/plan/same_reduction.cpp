#include "floe/plan/same_reduction.h"

#include <algorithm>
#include <map>

#include "floe/fem/assembly.h"
#include "floe/plan/attachments.h"
#include "floe/plan/interface.h"
#include "floe/reduction/statics.h"

namespace floe::plan {

using petsc::check;

namespace {

bool same_settings(const Body& a, const Body& b) {
  const ReductionSpec &r = a.reduction, &s = b.reduction;
  return r.modes.of == s.modes.of && r.modes.count == s.modes.count && r.modes.given == s.modes.given &&
         r.modes.alone == s.modes.alone && r.derivatives.choice == s.derivatives.choice &&
         r.derivatives.choice != DerivativesSpec::Choice::count && r.derivatives.pairs == s.derivatives.pairs &&
         r.derivatives.full == s.derivatives.full && r.attachment == s.attachment && r.columns.empty() &&
         s.columns.empty() && r.linear == s.linear && r.products == s.products &&
         r.drop_tolerance == s.drop_tolerance && a.damping.modal == b.damping.modal;
}

/// From the frame of a to that of b, where both have the mesh of the same axes.
fem::Placement placement_of(const PlannedBody& a, const PlannedBody& b) {
  fem::Placement placement;
  if (a.structure.dimension() == 2) return placement;
  const Eigen::Matrix3d R = b.axes.transpose() * a.axes;
  placement.rotates = (R - Eigen::Matrix3d::Identity()).norm() > 1e-13;
  if (placement.rotates) placement.rotation = R;
  const Eigen::Vector3d r = b.axes.transpose() * (a.origin - b.origin);
  if (r.norm() > 1e-13 * (a.origin.norm() + b.origin.norm())) placement.translation = r;
  return placement;
}

/// Whether all three displacements, or rotations, of a node are among the conditions, or none.
bool whole(const fem::Conditions& conditions) {
  std::map<PetscInt, int> count;
  for (const PetscInt dof : conditions) ++count[dof / 3];
  return std::all_of(count.begin(), count.end(), [](const auto& each) { return each.second == 3; });
}

/// What begin_stage() makes of the conditions of frame, joints and interface.
struct HeldConditions {
  fem::Conditions modes, statics;
  Eigen::Index free_motions;
  bool balanced;
  bool operator==(const HeldConditions&) const = default;
};

/// Collective.
HeldConditions conditions_of(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  const fem::Holding statics = fem::holding(body.structure, body.frame, constrained_by_modes(plan, index)),
                     modes = body.spec.reduction.modes.of == ModesSpec::Of::frame
                                 ? fem::holding(body.structure, body.frame, body.frame.conditions)
                                 : statics;
  return {modes.constrained, statics.statics, modes.left.cols(), balanced_by_joints(plan, index)};
}

bool same_conditions(const Plan& plan, int first, int second, bool rotates) {
  const PlannedBody &a = plan.bodies[first], &b = plan.bodies[second];
  if (a.frame.kind != b.frame.kind || a.frame.conditions != b.frame.conditions) return false;
  if (a.frame_places[0].node != b.frame_places[0].node || a.frame_places[1].node != b.frame_places[1].node)
    return false;
  const HeldConditions one = conditions_of(plan, first), other = conditions_of(plan, second);
  if (!(one == other)) return false;
  return !rotates || (whole(a.frame.conditions) && whole(one.modes) && whole(one.statics));
}

double difference(Vec a, Vec b) {
  double size = 0, other = 0, difference = 0;
  check(VecNorm(a, NORM_2, &size));
  check(VecNorm(b, NORM_2, &other));
  petsc::VecHandle rest = reduction::copy(a);
  check(VecAXPY(rest, -1, b));
  check(VecNorm(rest, NORM_2, &difference));
  return size > 0 || other > 0 ? difference / std::max(size, other) : 0;
}

/// Whether three attachment modes along or about the axes of b are those of a, rotated: R e_c = sum_d R_dc e_d.
bool same_three(const PlannedBody& b, const fem::Placement& placement, const reduction::Attachment* one,
                const reduction::Attachment* other) {
  for (int c = 0; c < 3; ++c) {
    Vec from = one[c].load ? one[c].load : one[c].moved;
    petsc::VecHandle sum = fem::field(b.structure);
    for (int d = 0; d < 3; ++d) {
      Vec along = other[d].load ? other[d].load : other[d].moved;
      check(VecAXPY(sum, placement.rotation(d, c), along));
    }
    if (difference(fem::placed(b.structure, placement, from), sum) > 1e-12) return false;
  }
  return true;
}

bool same_attachments(const PlannedBody& b, const fem::Placement& placement, const Attachments& one,
                      const Attachments& other) {
  if (one.size() != other.size()) return false;
  for (std::size_t i = 0; i < one.size(); ++i)
    if (!one[i].load != !other[i].load) return false;
  if (!placement.rotates) {
    for (std::size_t i = 0; i < one.size(); ++i)
      if (difference(one[i].load ? one[i].load : one[i].moved, other[i].load ? other[i].load : other[i].moved) > 1e-12)
        return false;
    return true;
  }
  if (one.size() % 3 != 0) return false;
  for (std::size_t i = 0; i < one.size(); i += 3)
    if (!same_three(b, placement, &one[i], &other[i])) return false;
  return true;
}

}  // namespace

Attachments that_act(const PlannedBody& body, Attachments all) {
  if (body.frame.kind != fem::ReferenceFrame::Kind::clamped) return all;
  std::erase_if(all, [&](const reduction::Attachment& one) {
    if (!one.load) return false;
    petsc::VecHandle rest = reduction::copy(one.load);
    fem::hold(rest, body.frame.conditions);
    double size = 0;
    check(VecNorm(rest, NORM_INFINITY, &size));
    return size == 0;
  });
  return all;
}

std::string renamed(const std::string& text, const std::map<std::string, std::string>& labels) {
  std::string result;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(" ,", begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const auto found = labels.find(word);
    result += found == labels.end() ? word : found->second;
    if (end < text.size()) result += text[end];
    begin = end + 1;
  }
  return result;
}

std::vector<SharedReduction> same_reductions(const Plan& plan, const AttachmentsOf& attachments) {
  const int count = static_cast<int>(plan.bodies.size());
  std::vector<SharedReduction> all(count);
  std::map<int, Attachments> loads;  // made when they are compared
  const auto loads_of = [&](int b) -> const Attachments& {
    const auto found = loads.find(b);
    return found != loads.end() ? found->second
                                : loads.emplace(b, that_act(plan.bodies[b], attachments(b))).first->second;
  };
  const auto flexible = [&](int b) { return is_meshed(plan.bodies[b].spec); };
  for (int b = 0; b < count; ++b)
    for (int a = 0; a < b && flexible(b) && all[b].of < 0; ++a) {
      const PlannedBody &one = plan.bodies[a], &other = plan.bodies[b];
      if (!flexible(a) || all[a].of >= 0 || !same_settings(one.spec, other.spec)) continue;
      if (one.structure.dimension() != other.structure.dimension()) continue;
      const fem::Placement placement = placement_of(one, other);
      int same =
          same_conditions(plan, a, b, placement.rotates) && fem::congruent(one.structure, other.structure, placement);
      MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_MIN, plan.comm);
      if (same != 0 && same_attachments(other, placement, loads_of(a), loads_of(b))) all[b] = {a, placement};
    }
  return all;
}

}  // namespace floe::plan
