#include "floe/assembly/shared_reduction.h"

#include <algorithm>
#include <map>

#include "floe/assembly/damping.h"
#include "floe/body/placed_inertia.h"
#include "floe/fem/assembly.h"
#include "floe/plan/attachments.h"

namespace floe::assembly {

using petsc::check;

namespace {

constexpr std::string_view attachment_prefix = "attachment ";  // how labels of their origins begin

std::shared_ptr<reduction::Basis> placed(const fem::Structure& structure, const fem::Placement& placement,
                                         const reduction::Basis& basis) {
  auto result = std::make_shared<reduction::Basis>();
  result->columns = basis.columns, result->origins = basis.origins, result->norms = basis.norms;
  check(BVDuplicate(basis.V, result->V.out()));
  check(BVSetMatrix(result->V, fem::mass(structure, {}), PETSC_FALSE));
  for (int j = 0; j < basis.columns; ++j) {
    Vec column = nullptr;
    check(BVGetColumn(basis.V, j, &column));
    check(BVInsertVec(result->V, j, fem::placed(structure, placement, column)));
    check(BVRestoreColumn(basis.V, j, &column));
  }
  check(BVSetActiveColumns(result->V, 0, basis.columns));
  return result;
}

/// Whether damping.modal refers to the same modes: other bodies may hold one of two that have the same basis.
bool same_damping_modes(const Plan& plan, int a, int b, const fem::Placement& placement) {
  const std::optional<fem::Conditions> one = conditions_for_damping(plan, a), other = conditions_for_damping(plan, b);
  return one == other && !(one && placement.rotates);
}

}  // namespace

std::vector<SharedReduction> shared_reductions(const Plan& plan) {
  std::vector<SharedReduction> all = same_reductions(plan, [&](int body) { return attachments(plan, body); });
  for (std::size_t b = 0; b < all.size(); ++b) {
    if (all[b].of < 0 || !has_modal_damping(plan.bodies[b].spec)) continue;
    int same = same_damping_modes(plan, all[b].of, static_cast<int>(b), all[b].placement);
    MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_LAND, plan.comm);
    if (same == 0) all[b] = {};
  }
  return all;
}

ReducedBody shared_body(const Plan& plan, int index, const SharedReduction& shared, const ReducedBody& original) {
  const PlannedBody& body = plan.bodies[index];
  ReducedBody reduced = original;
  std::map<std::string, std::string> labels;
  const Attachments own = that_act(body, attachments(plan, index)),
                    others = that_act(plan.bodies[shared.of], attachments(plan, shared.of));
  for (std::size_t i = 0; i < own.size(); ++i) labels[others[i].label] = own[i].label;
  std::erase_if(reduced.report.origins, [&](const reduction::ColumnOrigin& origin) {
    return origin.kind == reduction::ColumnOrigin::Kind::attachment && !origin.kept &&
           labels.count(origin.label.substr(attachment_prefix.size())) == 0;
  });
  for (reduction::ColumnOrigin& origin : reduced.report.origins)
    origin.label = renamed(origin.label, labels), origin.dropped = renamed(origin.dropped, labels);
  reduced.report.reduction_of = plan.bodies[shared.of].spec.name;
  reduced.report.seconds_modes = reduced.report.seconds_derivatives = reduced.report.seconds_projection = 0;
  const auto d = body.structure.dimension();
  const Eigen::MatrixXd R = shared.placement.rotation.topLeftCorner(d, d);
  const Eigen::VectorXd r = shared.placement.translation.head(d);
  if (shared.placement.rotates || !r.isZero(0)) {
    reduced.body.inertia = body::placed(original.body.inertia, R, r);
    reduced.body.line = body::placed(original.body.line, R, r);
  }
  if (shared.placement.rotates && original.basis) {
    reduced.basis = placed(body.structure, shared.placement, *original.basis);
    reduced.report.basis = reduced.basis;
    if (original.relief.W) {
      reduction::Columns W;
      for (const petsc::VecHandle& w : *original.relief.W)
        W.push_back(fem::placed(body.structure, shared.placement, w));
      reduced.relief.W = std::make_shared<const reduction::Columns>(std::move(W));
    }
    reduced.statics = nullptr;
  }
  return reduced;
}

}  // namespace floe::assembly
