#include <fmt/format.h>

#include <algorithm>

#include "nas_build.h"
#include "text.h"

namespace floe::mesh {

/// What acts on a grid's rotations beside a link.
struct NasBuild::Rotations {
  std::vector<std::pair<std::size_t, int>> beams;  // each with its end at the grid
  std::string other;                               // in words; empty: nothing
  bool shell = false, linked = false;
};

std::unordered_map<long long, NasBuild::Rotations> NasBuild::rotations_of_grids() const {
  std::unordered_map<long long, Rotations> all;
  const auto other = [&](long long grid, const std::string& what) { all[grid].other = what; };
  for (std::size_t b = 0; b < model_.beams.size(); ++b)
    for (int end : {0, 1}) all[model_.beams[b].nodes[end]].beams.emplace_back(b, end);
  for (const NasShell& shell : model_.shells)
    for (const auto* nodes : {&shell.nodes, &shell.middles})
      for (const long long grid : *nodes)
        if (grid > 0) other(grid, fmt::format("shell {}", shell.id)), all[grid].shell = true;
  for (const NasSpring& spring : model_.springs)
    for (int end : {0, 1})
      if (spring.grids[1 - end] > 0 && !(spring.scalar() && spring.components[end] <= 3))
        other(spring.grids[end], fmt::format("spring {}", spring.id));
  for (const NasMass& mass : model_.masses)
    if (!mass.mass.inertia.isZero(0) || !mass.mass.offset.isZero(0) || mass.axes < 0)
      other(mass.grid, "a CONM2 with inertia or offset");
  for (const NasMassMatrix& mass : model_.mass_matrices) other(mass.grid, mass.name);
  for (const NasScalarMass& mass : model_.component_masses)
    if (mass.component > 3) other(mass.grid, fmt::format("{} {}", mass.card, mass.id));
  std::unordered_map<long long, int> links;
  for (const NasLink& link : model_.links) {
    other(link.reference, "another link, whose independent grid it is,"), all[link.reference].linked = true;
    for (const long long grid : link.nodes)
      if (++links[grid] > 1) other(grid, "another link"), all[grid].linked = true;
  }
  return all;
}

/// Of the shells at a grid: maximum stiffness in their plane A and in bending D, minimum length of their edges there,
/// and their normals.
struct NasBuild::ShellsAt {
  double A = 0, D = 0, h = 1e300;
  std::vector<Eigen::Vector3d> normals;
};

NasBuild::ShellsAt NasBuild::shells_at(long long grid, const Eigen::Vector3d& x, Where where) {
  ShellsAt at;
  for (const NasShell& shell : model_.shells) {
    const auto end = shell.nodes.begin() + shell.count;
    if (std::find(shell.nodes.begin(), end, grid) == end &&
        std::find(shell.middles.begin(), shell.middles.end(), grid) == shell.middles.end())
      continue;
    if (const auto property = model_.shell_properties.find(shell.property); property != model_.shell_properties.end()) {
      double A = 0, thickness = 0;
      for (const NasPly& ply : property->second.plies) {
        thickness += ply.thickness;
        if (const auto of = model_.materials.find(ply.material);
            of != model_.materials.end() && !of->second.material.constants.empty())
          A += ply.thickness * of->second.material.constants.front();
      }
      at.A = std::max(at.A, A), at.D = std::max(at.D, A * thickness * thickness / 12);
    }
    std::vector<Eigen::Vector3d> corners;
    for (auto node = shell.nodes.begin(); node != end; ++node) {
      if (const auto corner = frames_.position(*node, where)) corners.push_back(*corner);
      if (*node != grid && !corners.empty()) at.h = std::min(at.h, (corners.back() - x).norm());
    }
    if (corners.size() == static_cast<std::size_t>(shell.count))
      at.normals.push_back((corners[2] - corners[0]).cross(corners.back() - corners[1]).normalized());
  }
  return at;
}

/// The link ends at a node of its own, at the grid of shells, which keep their rotations: a spring without moments
/// holds the one at the other, stiffer by the factor c than the shells, k = c A, and normal to those of one plane,
/// which are soft there, k = c D / h^2.
void NasBuild::add_hinge(const NasLink& link, long long grid) {
  constexpr double c = 1000, one_plane = 0.9;
  const auto x = frames_.position(grid, link.where);
  if (!x) return;
  const ShellsAt at = shells_at(grid, *x, link.where);
  if (!(at.A > 0))
    return faults_.add(link.where,
                       fmt::format("{}: constrains 123 of grid {}, of shells without thickness and material in the "
                                   "deck; expected PSHELL or PCOMP, or 123456",
                                   link.name, grid));
  hinge_at_[grid] = next_label_;
  hinges_.push_back({next_label_++, *x, link.where});
  if (rank_ != 0) return;
  const Eigen::Vector3d& n = at.normals.front();
  const bool flat = std::all_of(at.normals.begin(), at.normals.end(),
                                [&](const Eigen::Vector3d& other) { return std::abs(n.dot(other)) > one_plane; });
  NodeSpring spring{{}, {}, Eigen::Matrix3d::Identity(), 0.5, 0};
  spring.axes.col(0) = n, spring.axes.col(1) = n.unitOrthogonal();
  spring.axes.col(2) = n.cross(spring.axes.col(1));
  spring.stiffness = {flat ? std::min(c * at.D / (at.h * at.h), c * at.A) : c * at.A, c * at.A, c * at.A, 0, 0, 0};
  for (int end : {0, 1}) {
    spring.nodes[static_cast<std::size_t>(end)] = static_cast<PetscInt>(mesh.mentions.size());
    mesh.mentions.push_back({end == 0 ? grid : hinge_at_[grid], link.where});
  }
  deck.springs.push_back(spring);
}

/// A link that leaves all rotations of its dependent grids free is a rigid one where nothing acts on these rotations,
/// one to a beam whose end is released where a single beam does, and one with a hinge where shells do.
void NasBuild::free_rotations() {
  const auto partial = [](const NasLink& link) { return !link.constrains.empty(); };
  if (std::none_of(model_.links.begin(), model_.links.end(), partial)) return;
  const auto rotations = rotations_of_grids();
  for (const NasLink& link : model_.links) {
    if (!partial(link)) continue;
    for (const long long grid : link.nodes) {
      const auto found = rotations.find(grid);
      if (found == rotations.end() || (found->second.other.empty() && found->second.beams.empty())) continue;
      const auto& [beams, other, shell, linked] = found->second;
      if (shell && !linked && link.constrains == "123") {
        add_hinge(link, grid);
        continue;
      }
      if (other.empty() && beams.size() == 1 && link.constrains == "123") {
        const auto [b, end] = beams[0];
        const NasBeam& beam = model_.beams[b];
        const Eigen::Vector3d& offset = beam.offsets[static_cast<std::size_t>(end)];
        if (offset.isZero(0))
          released_[b] |= 0x38u << (6 * end);
        else  // the ball joint is at the grid, the released end is not
          faults_.add(link.where,
                      fmt::format("{}: constrains 123 of grid {}, at the end of beam {} with the offset ({:.6g}, "
                                  "{:.6g}, {:.6g}); expected 123456, or no offset",
                                  link.name, grid, beam.id, offset.x(), offset.y(), offset.z()));
        continue;
      }
      faults_.add(
          link.where,
          fmt::format("{}: constrains {} of grid {}, whose other rotations are also dofs of {}; expected 123456, or "
                      "123 where these rotations are dofs of shells, or of the end of one beam at most",
                      link.name, link.constrains, grid, other.empty() ? "more than one beam end" : other));
    }
  }
}

void NasBuild::add_links() {
  free_rotations();
  for (const NasLink& rigid : model_.links) {
    std::vector<long long> nodes = rigid.nodes;
    for (long long& node : nodes) {
      if (const auto hinge = hinge_at_.find(node); hinge != hinge_at_.end())
        node = hinge->second;
      else
        independent_[node] = rigid.reference;
    }
    link(rigid.reference, nodes, rigid.where);
  }
}

}  // namespace floe::mesh
