#include <fmt/format.h>

#include <algorithm>

#include "nas_build.h"
#include "text.h"

namespace floe::mesh {

/// What acts on a grid's rotations beside a link.
struct NasBuild::Rotations {
  std::vector<std::pair<std::size_t, int>> beams;  // each with its end at the grid
  std::string other;                               // in words; empty: nothing
};

std::unordered_map<long long, NasBuild::Rotations> NasBuild::rotations_of_grids() const {
  std::unordered_map<long long, Rotations> all;
  const auto other = [&](long long grid, const std::string& what) { all[grid].other = what; };
  for (std::size_t b = 0; b < model_.beams.size(); ++b)
    for (int end : {0, 1}) all[model_.beams[b].nodes[end]].beams.emplace_back(b, end);
  for (const NasShell& shell : model_.shells)
    for (const auto* nodes : {&shell.nodes, &shell.middles})
      for (const long long grid : *nodes)
        if (grid > 0) other(grid, fmt::format("shell {}", shell.id));
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
    other(link.reference, "another link, whose independent grid it is,");
    for (const long long grid : link.nodes)
      if (++links[grid] > 1) other(grid, "another link");
  }
  return all;
}

/// A link that leaves all rotations of its dependent grids free is a rigid one where nothing acts on these rotations,
/// and one to a beam whose end is released where a single beam does.
void NasBuild::free_rotations() {
  const auto partial = [](const NasLink& link) { return !link.constrains.empty(); };
  if (std::none_of(model_.links.begin(), model_.links.end(), partial)) return;
  const auto rotations = rotations_of_grids();
  for (const NasLink& link : model_.links) {
    if (!partial(link)) continue;
    for (const long long grid : link.nodes) {
      const auto found = rotations.find(grid);
      if (found == rotations.end() || (found->second.other.empty() && found->second.beams.empty())) continue;
      const auto& [beams, other] = found->second;
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
                      "123 where these rotations are dofs of the end of one beam at most",
                      link.name, link.constrains, grid, other.empty() ? "more than one beam end" : other));
    }
  }
}

void NasBuild::add_links() {
  free_rotations();
  for (const NasLink& rigid : model_.links) {
    link(rigid.reference, rigid.nodes, rigid.where);
    for (const long long node : rigid.nodes) independent_[node] = rigid.reference;
  }
}

}  // namespace floe::mesh
