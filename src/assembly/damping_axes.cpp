#include "damping_axes.h"

#include <algorithm>
#include <iterator>

#include "floe/assembly/body_stage.h"
#include "floe/assembly/damping.h"
#include "floe/dynamics/damping.h"
#include "floe/fem/assembly.h"
#include "floe/math/rotation.h"
#include "floe/petsc/values.h"
#include "floe/plan/hold_by_joint.h"
#include "floe/scene/joint_events.h"

namespace floe::assembly {

using dynamics::AccompanyingAxes;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using math::skew;

namespace {

/// Dofs that joints to the ground hold; of a body in a frame that it shares, PlannedBody::constrained has those of the
/// joint to the body that the frame is of. Without nodes that follow others (rigid edges), which these may move.
fem::Conditions held_by_ground(const Plan& plan, int b) {
  if (plan.bodies[b].parent < 0) return without_dependent(plan.bodies[b].structure, plan.bodies[b].constrained);
  fem::Conditions held;
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const auto& [first, second] = plan.joints[j];
    const Anchor& place = first.ground() ? second : first;
    if (first.ground() != second.ground() && place.body == b) hold_place_by_joint(plan, j, place, held);
  }
  std::sort(held.begin(), held.end());
  held.erase(std::unique(held.begin(), held.end()), held.end());
  return held;
}

/// Joints to the ground that are not driven or switched, alone.
bool firmly_grounded(const Plan& plan, const DampedWhole& whole) {
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const auto& [first, second] = plan.joints[j];
    if (first.ground() == second.ground() || !whole.has(first.ground() ? second.body : first.body)) continue;
    const Joint& joint = plan.scene.joints[j];
    if (joint.kind == Joint::Kind::driven || joint.kind == Joint::Kind::driven_slide) return false;
    if (is_switched(plan.scene, joint.name)) return false;
  }
  return true;
}

}  // namespace

std::vector<DampedWhole> damped_wholes(const Plan& plan, bool corotational, const std::vector<bool>& still) {
  std::vector<DampedWhole> all;
  for (std::size_t b = 0; b < plan.bodies.size(); ++b) {
    const Body& spec = plan.bodies[b].spec;
    const bool modal = corotational && has_modal_damping(spec);
    if ((spec.damping.mass == 0 && !modal) || spec.rigid || spec.reduced) continue;
    const std::string name = whole_name(spec);
    if (name == spec.name && !corotational) continue;
    if (all.empty() || whole_name(plan.bodies[all.back().bodies.front()].spec) != name) {
      all.emplace_back();
      all.back().alpha = spec.damping.mass;
    }
    all.back().bodies.push_back(static_cast<int>(b));
  }
  for (DampedWhole& whole : all) {
    whole.length = 0;
    for (int b : whole.bodies) whole.length += fem::extent(plan.bodies[b].structure);
    std::vector<fem::Conditions> by_ground;
    for (int b : whole.bodies) {
      by_ground.push_back(held_by_ground(plan, b));
      whole.constrained.push_back(constrained_for_damping(plan, whole.bodies, b));
    }
    whole.split(plan, by_ground);
    whole.fixed = firmly_grounded(plan, whole) && whole.free.cols() == 0;
    for (int b : whole.bodies) whole.fixed = whole.fixed || still[b];
    // Modes need axes in which deformations are measured.
    if (corotational && has_modal_damping(plan.bodies[whole.bodies.front()].spec)) whole.fixed = false;
    whole.split(plan, whole.constrained);
  }
  return all;
}

std::vector<std::unique_ptr<AccompanyingAxes>> modal_rows(const DampedWhole& whole, const PlannedBody& body,
                                                          const std::function<dynamics::MovingAxes(int)>& axes_of,
                                                          std::vector<std::unique_ptr<dynamics::Term>>& terms) {
  const reference::ModalDamping& modal = *whole.modal;
  const fem::Structure& s = body.structure;
  const Matrix3d A0 = undeformed_axes(body);
  const int n = s.dofs_per_node;
  std::vector<std::unique_ptr<petsc::ConstValues>> forces;
  for (const petsc::VecHandle& f : modal.forces) forces.push_back(std::make_unique<petsc::ConstValues>(f));
  std::vector<std::unique_ptr<AccompanyingAxes>> all;
  for (int node = 0; node < s.mesh.owned_nodes; ++node) {
    const fem::Mesh::Spin* spin = n == 6 ? fem::spin_of(s.mesh, node) : nullptr;
    std::vector<AccompanyingAxes::Row> rows;
    bool any = false;
    for (const auto& f : forces) {
      Vector3d force = Vector3d::Zero(), moment = force;
      for (int d = 0; d < n; ++d) {
        const double value = (*f)[n * (s.mesh.first_node + node) + d];
        const bool rotation = d >= (n == 3 ? 2 : 3);
        if (!rotation)
          force[d] = value;
        else if (spin)
          moment += value * spin->own().col(d - 3);
        else
          moment[n == 3 ? 2 : d - 3] = value;
        any = any || value != 0;
      }
      rows.push_back({A0 * force, Matrix3d(0.5 * skew(A0 * moment) * A0).reshaped()});
    }
    if (any)
      all.push_back(std::make_unique<AccompanyingAxes>(axes_of(node), std::vector<int>{}, whole.f, modal.multipliers,
                                                       std::move(rows)));
  }
  int rank = 0, size = 1;
  MPI_Comm_rank(s.mesh.comm, &rank);
  MPI_Comm_size(s.mesh.comm, &size);
  if (rank + 1 < size) return all;
  std::ranges::move(reference::modal_dampers(modal.viscosity, modal.y, modal.multipliers), std::back_inserter(terms));
  return all;
}

VectorXd begin_modal(const DampedWhole& whole, std::vector<std::unique_ptr<AccompanyingAxes>>& rows, const VectorXd& q,
                     const VectorXd& v, MPI_Comm comm) {
  const Index k = static_cast<Index>(whole.modal->forces.size());
  VectorXd rate = VectorXd::Zero(k);
  for (auto& term : rows) {
    const std::vector<int>& at = term->coordinates();
    const VectorXd q_at = q(at), v_at = v(at), a_at = VectorXd::Zero(q_at.size());
    VectorXd r = VectorXd::Zero(q_at.size());
    term->begin_at(q_at);
    term->residual({0, q_at, v_at, a_at, dynamics::ConstraintLevel::velocity}, r);
    rate += r.tail(k);
  }
  MPI_Allreduce(MPI_IN_PLACE, rate.data(), static_cast<int>(k), MPI_DOUBLE, MPI_SUM, comm);
  return rate;
}

}  // namespace floe::assembly
