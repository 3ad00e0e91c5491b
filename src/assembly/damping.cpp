#include "floe/assembly/damping.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <limits>
#include <map>

#include "floe/assembly/body_stage.h"
#include "floe/dynamics/damping.h"
#include "floe/fem/joint_frame.h"
#include "floe/plan/attachments.h"
#include "floe/plan/hold_by_joint.h"
#include "floe/plan/interface.h"

namespace floe::assembly {

using petsc::check;

namespace {

bool in_several_frames(const PlannedBody& body) { return body.spec.piece > 0; }

bool holds(const Joint& joint) {
  return joint.kind != Joint::Kind::spring && joint.kind != Joint::Kind::bushing && joint.kind != Joint::Kind::distance;
}

/// How many joints each body is away from the ground, or from a rigid body where none leads to the ground.
std::vector<int> distances(const Plan& plan) {
  constexpr int far = std::numeric_limits<int>::max();
  std::vector<int> all(plan.bodies.size(), far);
  const auto walk = [&](std::deque<int> next) {
    while (!next.empty()) {
      const int at = next.front();
      next.pop_front();
      for (std::size_t j = 0; j < plan.joints.size(); ++j) {
        if (!holds(plan.scene.joints[j])) continue;
        for (const int side : {0, 1}) {
          const int here = plan.joints[j][side].body, there = plan.joints[j][1 - side].body;
          if (here != at || there < 0 || all[there] != far) continue;
          all[there] = all[at] + 1;
          next.push_back(there);
        }
      }
    }
  };
  std::deque<int> grounded, rigid;
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    for (const int side : {0, 1}) {
      const int body = plan.joints[j][side].body;
      if (!plan.joints[j][1 - side].ground() || body < 0 || !holds(plan.scene.joints[j]) || all[body] != far) continue;
      all[body] = 1;
      grounded.push_back(body);
    }
  walk(grounded);
  for (std::size_t b = 0; b < all.size(); ++b)
    if (all[b] == far && plan.bodies[b].spec.rigid) all[b] = 0, rigid.push_back(static_cast<int>(b));
  walk(rigid);
  return all;
}

}  // namespace

fem::Conditions constrained_for_damping(const Plan& plan, int index) {
  return constrained_for_damping(plan, {index}, index);
}

fem::Conditions constrained_for_damping(const Plan& plan, const std::vector<int>& whole, int index) {
  const PlannedBody& body = plan.bodies[index];
  fem::Conditions constrained = body.constrained;
  const std::vector<int> away = distances(plan);
  int nearest = away[index];
  for (int b : whole) nearest = std::min(nearest, away[b]);
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    for (const int side : {0, 1}) {
      const Anchor &here = plan.joints[j][side], &there = plan.joints[j][1 - side];
      if (here.body != index || there.body < 0 || here.map || away[there.body] >= nearest) continue;
      hold_place_by_joint(plan, j, here, constrained);
    }
  std::sort(constrained.begin(), constrained.end());
  constrained.erase(std::unique(constrained.begin(), constrained.end()), constrained.end());
  return without_dependent(body.structure, constrained);
}

namespace {

/// Whether damping.modal refers to modes on the joints of the body: not of an interface or a frame.
bool has_modes_of_joints(const PlannedBody& body) {
  return has_modal_damping(body.spec) && body.interface.empty() && !of_frame(body);
}

}  // namespace

std::optional<fem::Conditions> conditions_for_damping(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  if (!has_modes_of_joints(body) || in_several_frames(body)) return {};
  fem::Conditions constrained = constrained_for_damping(plan, index);
  int same = constrained == without_dependent(body.structure, constrained_by_modes(plan, index));
  MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_LAND, body.structure.mesh.comm);
  return same != 0 ? std::nullopt : std::optional(std::move(constrained));
}

std::optional<reduction::Modes> modes_for_damping(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  const std::optional<fem::Conditions> constrained = conditions_for_damping(plan, index);
  if (!constrained) return {};
  const fem::Holding holding = fem::holding(body.structure, body.frame, *constrained);
  const reduction::Statics statics(body.structure, body.frame, holding);
  reduction::ModeSolver solver(body.structure, body.frame, holding, statics);
  return solver.solve(static_cast<int>(std::min<PetscInt>(std::ssize(body.spec.damping.modal), solver.available())));
}

reduction::Modes all_modes_for_damping(const Plan& plan, int index) {
  if (std::optional<reduction::Modes> modes = modes_for_damping(plan, index)) return std::move(*modes);
  Stage stage;
  BodyReport report;
  begin_stage(plan, index, count_of_modes(plan.bodies[index]), stage, report);
  return std::move(stage.generators.modes);
}

std::vector<std::string> damping_with_free_joints(const Plan& plan) {
  constexpr int far = std::numeric_limits<int>::max();
  const std::vector<int> away = distances(plan);
  std::map<std::string, int> nearest;  // of all pieces of a body
  for (std::size_t b = 0; b < away.size(); ++b) {
    int& least = nearest.emplace(whole_name(plan.bodies[b].spec), far).first->second;
    least = std::min(least, away[b]);
  }
  std::map<std::string, std::vector<std::string>> free;  // joints, by body
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    for (const int side : {0, 1}) {
      const Anchor &here = plan.joints[j][side], &there = plan.joints[j][1 - side];
      if (here.body < 0 || there.body < 0 || !holds(plan.scene.joints[j])) continue;
      const PlannedBody& body = plan.bodies[here.body];
      const std::string& name = whole_name(body.spec);
      if (body.spec.rigid || body.spec.reduced || !has_modes_of_joints(body)) continue;
      if (name == whole_name(plan.bodies[there.body].spec)) continue;
      fem::Conditions held;
      const int least = nearest.at(name);
      if (least == far || (away[there.body] < least && (here.map || !hold_place_by_joint(plan, j, here, held))))
        free[name].push_back(plan.scene.joints[j].name);
    }
  std::vector<std::string> all;
  for (const auto& [name, joints] : free)
    all.push_back(
        fmt::format("body {}: the modes of damping.modal do not satisfy joint{} {} to another body, or only in part: "
                    "its vibrations can have less damping than specified. damping.stiffness has no such limit",
                    name, joints.size() > 1 ? "s" : "", fmt::join(joints, ", ")));
  return all;
}

std::string damping_without_joints(const Plan& plan, int index, const ReducedBody& reduced) {
  const PlannedBody& body = plan.bodies[index];
  if (reduced.report.file_version < 3) return "";  // beta is not in the file, and cannot be separated
  const Eigen::MatrixXd K = reduced.body.elasticity.linear_stiffness();
  if (!(reduced.damping.norm() > 1e-9 * reduced.strain_rate_damping * K.norm())) return "";
  const Joint* to_body = nullptr;
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    for (const int side : {0, 1}) {
      if (plan.joints[j][side].body != index || !holds(plan.scene.joints[j])) continue;
      if (plan.joints[j][1 - side].ground()) return "";
      to_body = &plan.scene.joints[j];
    }
  if (!to_body) return "";
  return fmt::format(
      "body {}: the mass-proportional and modal damping in {} is that of the free body, without joint {} to another "
      "body: vibrations on this joint can be damped far too little. damping.stiffness has no such limit, nor have "
      "damping.mass and damping.modal of a body with a mesh in the scene",
      body.spec.name, body.spec.reduced->path, to_body->name);
}

fem::Conditions without_dependent(const fem::Structure& structure, const fem::Conditions& constrained) {
  const fem::Conditions dependent = fem::dependent_dofs(structure.mesh, structure.dofs_per_node);
  fem::Conditions own;
  std::set_difference(constrained.begin(), constrained.end(), dependent.begin(), dependent.end(),
                      std::back_inserter(own));
  return own;
}

fem::ReferenceFrame damping_frame(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  return fem::joint_frame(body.structure, body.frame, constrained_for_damping(plan, index));
}

namespace {

/// Modal damping, as it came with the basis or the file, and alpha V'P'MPV.
Eigen::MatrixXd constant_damping(const Plan& plan, int index, const ReducedBody& reduced) {
  const PlannedBody& body = plan.bodies[index];
  Eigen::MatrixXd C = reduced.damping;
  if (body.spec.damping.mass == 0 || in_several_frames(body) || !reduced.basis || reduced.basis->columns == 0) return C;
  std::vector<petsc::VecHandle> columns;
  for (int i = 0; i < reduced.basis->columns; ++i) {
    columns.push_back(fem::field(body.structure));
    check(BVCopyVec(reduced.basis->V, i, columns.back()));
  }
  const Eigen::MatrixXd M = fem::mass_seen(body.structure, damping_frame(plan, index), columns);
  if (C.size() == 0) C.setZero(M.rows(), M.cols());
  return C + body.spec.damping.mass * M;
}

/// beta [s], of the scene or of the body's file.
double stiffness_factor(const Plan& plan, int index, const ReducedBody& reduced) {
  return plan.bodies[index].spec.damping.stiffness + reduced.strain_rate_damping;
}

}  // namespace

Eigen::MatrixXd linear_damping(const Plan& plan, int index, const ReducedBody& reduced) {
  Eigen::MatrixXd C = constant_damping(plan, index, reduced);
  const double beta = stiffness_factor(plan, index, reduced);
  if (beta == 0) return C;
  const Eigen::MatrixXd K = beta * reduced.body.elasticity.linear_stiffness();
  return C.size() == 0 ? K : C + K;
}

std::vector<std::unique_ptr<dynamics::Term>> damping_terms(const Plan& plan, int index, const ReducedBody& reduced,
                                                           const std::vector<int>& elastic) {
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  Eigen::MatrixXd C = constant_damping(plan, index, reduced);
  if (C.size() > 0) terms.push_back(std::make_unique<dynamics::LinearDamping>(elastic, std::move(C)));
  const double beta = stiffness_factor(plan, index, reduced);
  if (beta != 0 && !elastic.empty())
    terms.push_back(std::make_unique<dynamics::StrainRateDamping>(elastic, reduced.body.elasticity, beta));
  return terms;
}

std::optional<reference::MassDamping> full_order_damping(const Plan& plan, int index,
                                                         const fem::Conditions& constrained,
                                                         dynamics::Coordinates& coordinates) {
  const PlannedBody& body = plan.bodies[index];
  if (body.spec.damping.mass == 0 || in_several_frames(body)) return std::nullopt;
  const fem::Conditions by_joints = constrained_for_damping(plan, index);
  reference::MassDamping damping{fem::joint_frame(body.structure, body.frame, by_joints), constrained,
                                 body.spec.damping.mass};
  const bool mean_axes = by_joints.empty() && body.frame.kind == fem::ReferenceFrame::Kind::mean_axis;
  if (mean_axes || reference::moves_nothing(body.structure, damping.joints, constrained)) return damping;
  const int r = body.structure.rigid_motion_count();
  damping.motion = coordinates.add_shared(r);
  damping.multipliers = coordinates.add_shared(r, true);
  return damping;
}

void set_rigid_part(const reference::MassDamping& damping, const PlannedBody& body,
                    const dynamics::Coordinates& coordinates, bool owner, Vec U, Vec V) {
  if (damping.motion < 0) return;
  const Eigen::VectorXd s = reference::rigid_part(damping.joints, body.deformation),
                        rate = reference::rigid_part(damping.joints, body.deformation_rate);
  for (int i = 0; i < static_cast<int>(s.size()) && owner; ++i) {
    const PetscInt row = coordinates.global()[damping.motion + i];
    check(VecSetValue(U, row, s[i], INSERT_VALUES));
    check(VecSetValue(V, row, rate[i], INSERT_VALUES));
  }
}

}  // namespace floe::assembly
