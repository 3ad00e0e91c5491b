#include "shell_stress.h"
#include "spatial_assembly.h"

namespace floe::assembly {

std::shared_ptr<const ShellPoint> SpatialAssembly::shell_point(std::size_t p) const {
  const int b = plan_.probes[p][0].body;
  const PlannedBody& body = plan_.bodies[b];
  const Slot& slot = slots_[b];
  const std::vector<PatchSample> patch = patch_samples(plan_, p);
  const bool linear = formulation_ == Formulation::lffr || (compact(b) && body.spec.reduction.linear);
  auto point = std::make_shared<ShellPoint>();
  if (compact(b)) {
    std::vector<int> elastic = coordinates_of(b);
    elastic.erase(elastic.begin(), elastic.end() - reduced_[b].body.coordinates());
    point->shares.push_back(reduced_share(body, *reduced_[b].basis, patch, std::move(elastic)));
    if (!owner_) point->shares.clear();
  }
  for (const PatchSample& one : patch) {
    if (compact(b)) break;
    const fem::Mesh::Cell& cell = body.structure.mesh.cells[static_cast<std::size_t>(one.cell)];
    const fem::ShellSample sample = fem::shell_samples(body.structure, cell)[one.number];
    if (slot.corotated) {
      const auto corners = static_cast<Eigen::Index>(sample.corners.size());
      const bool first_order = !mesh::is_quadratic(cell.kind);
      fem::ShellSample own = sample;
      for (Eigen::Index i = 0; i < corners; ++i) own.corners[static_cast<std::size_t>(i)] = static_cast<int>(i);
      ShellPoint::Share share = share_of(own, one, Eigen::MatrixXd::Identity(6 * corners, 6 * corners));
      share.element = slot.corotated->element(cell, first_order ? one.number : 0, 0);
      if (!share.element) continue;  // of a rigid region
      if (first_order)
        for (Eigen::MatrixXd& Q : share.Q) Q.setZero();  // it keeps its corners in its plane
      share.coordinates = share.element->coordinates();
      point->shares.push_back(std::move(share));
      continue;
    }
    const reference::FreeDofs free = reference::free_dofs(body.structure, constrained(b), cell, *slot.nodes);
    point->shares.push_back(share_of(
        sample, one, cell.follows() ? Eigen::MatrixXd(fem::following(body.structure.mesh, cell) * free.V) : free.V));
    point->shares.back().coordinates = free.coordinates;
  }
  if (linear)
    for (ShellPoint::Share& share : point->shares)
      for (Eigen::MatrixXd& Q : share.Q) Q.setZero();
  return point;
}

}  // namespace floe::assembly
