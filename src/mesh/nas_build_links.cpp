#include <fmt/format.h>

#include <algorithm>

#include "nas_build.h"
#include "text.h"

namespace floe::mesh {

/// What acts on a grid's rotations beside a link.
struct NasBuild::Rotations {
  std::vector<std::pair<std::size_t, int>> beams;  // each with its end at the grid
  std::string other;                               // in words; empty: nothing
  bool shell = false, linked = false, spring = false;
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
        other(spring.grids[end], fmt::format("spring {}", spring.id)), all[spring.grids[end]].spring = true;
  for (const NasMass& mass : model_.masses)
    if (!mass.mass.inertia.isZero(0) || !mass.mass.offset.isZero(0) || mass.axes < 0)
      other(mass.grid, "a CONM2 with inertia or offset");
  for (const NasMassMatrix& mass : model_.mass_matrices) other(mass.grid, mass.name);
  for (const NasScalarMass& mass : model_.component_masses)
    if (mass.component > 3) other(mass.grid, fmt::format("{} {}", mass.card, mass.id));
  std::unordered_map<long long, int> links;
  for (const NasLink& link : model_.links) {
    other(link.reference, "another link, whose independent grid it is"), all[link.reference].linked = true;
    for (const long long grid : link.nodes)
      if (++links[grid] > 1) other(grid, "another link"), all[grid].linked = true;
  }
  return all;
}

/// The rotations of a dependent grid that a link leaves free, of one or two by their axis, in displacement axes (CD).
RigidLink NasBuild::freedom(const NasLink& link, long long grid) {
  RigidLink free{};
  const std::string locked = link.constrains.substr(3);
  free.others = locked.size() < 2;
  const auto x = frames_.position(grid, link.where);
  if (locked.empty() || !x) return free;
  constexpr int sum = '4' + '5' + '6';
  const int about = free.others ? locked[0] - '4' : sum - locked[0] - locked[1] - '4';
  const long long axes = frames_.displacement_axes(*frames_.grid(grid));
  Eigen::Vector3d::Map(free.axis.data()) = frames_.directions(axes, *x, link.where).col(about);
  return free;
}

/// Links that leave rotations of their dependent grids free: where nothing acts on these, they are rigid; where a
/// single end of a beam does and all are free, this end is released; else the grids have rotations of their own, also
/// those that rods alone hold, where all are free.
void NasBuild::free_rotations() {
  const auto partial = [](const NasLink& link) { return !link.constrains.empty(); };
  if (std::none_of(model_.links.begin(), model_.links.end(), partial)) return;
  const auto rotations = rotations_of_grids();
  for (const NasLink& link : model_.links) {
    if (!partial(link)) continue;
    for (const long long grid : link.nodes) {
      const auto found = rotations.find(grid);
      if (found == rotations.end() || (found->second.other.empty() && found->second.beams.empty())) continue;
      const auto& [beams, other, shell, linked, spring] = found->second;
      const auto bends = [&](const auto& end) { return !model_.beams[end.first].rod; };
      const auto at = [&](const auto& end) {
        return model_.beams[end.first].offsets[static_cast<std::size_t>(end.second)];
      };
      const auto offset = std::find_if(beams.begin(), beams.end(), [&](const auto& end) { return !at(end).isZero(0); });
      const bool pinned = other.empty() && link.constrains == "123", released = pinned && beams.size() == 1;
      if (linked || !(shell || pinned || std::any_of(beams.begin(), beams.end(), bends)))
        faults_.add(link.where,
                    fmt::format("{}: constrains {} of grid {}, whose other rotations are also dofs of {}; expected "
                                "123456, or a grid of shells or beams that is in no other link",
                                link.name, link.constrains, grid, other.empty() ? "rods alone" : other));
      else if (offset != beams.end())  // the ball joint is at the grid, the end is not
        faults_.add(link.where, fmt::format("{}: constrains {} of grid {}, at the end of beam {} with the offset "
                                            "({:.6g}, {:.6g}, {:.6g}); expected 123456, or no offset",
                                            link.name, link.constrains, grid, model_.beams[offset->first].id,
                                            at(*offset).x(), at(*offset).y(), at(*offset).z()));
      else if (released)
        released_[beams[0].first] |= 0x38u << (6 * beams[0].second);
      else
        free_[grid] = freedom(link, grid);
    }
  }
}

/// Ends of rods at grids where nothing but rods has rotations.
void NasBuild::find_rods_alone() {
  const auto is_rod = [&](const NasBeam& beam) { return beam.rod; };
  if (std::none_of(model_.beams.begin(), model_.beams.end(), is_rod)) return;
  const auto rods_alone = [&](const Rotations& at) {
    return std::all_of(at.beams.begin(), at.beams.end(),
                       [&](const auto& end) { return is_rod(model_.beams[end.first]); });
  };
  std::vector<long long> masses;
  for (const auto& [grid, at] : rotations_of_grids()) {
    if ((independent_.contains(grid) && !free_.contains(grid)) || at.beams.empty() || !rods_alone(at)) continue;
    if (at.other.empty())
      for (const auto& [rod, end] : at.beams) alone_[rod] |= 1u << end;
    else if (!at.shell && !at.linked && !at.spring)
      masses.push_back(grid);
  }
  std::sort(masses.begin(), masses.end());
  if (!masses.empty())
    notices.push_back(fmt::format(
        "{}: grid{} {}: rods alone hold a mass with an offset or moments of inertia, which nothing keeps from "
        "rotating: its frequencies are near 0",
        faults_.text_of({0, 1}), masses.size() > 1 ? "s" : "", fmt::join(masses, ", ")));
}

void NasBuild::add_links() {
  free_rotations();
  for (const NasLink& rigid : model_.links) {
    std::map<std::pair<bool, std::array<double, 3>>, std::vector<long long>> by_freedom;
    for (const long long node : rigid.nodes) {
      independent_[node] = rigid.reference;
      const auto free = free_.find(node);
      by_freedom[free == free_.end() ? std::pair(false, std::array<double, 3>{})
                                     : std::pair(free->second.others, free->second.axis)]
          .push_back(node);
    }
    for (const auto& [free, nodes] : by_freedom) {
      link(rigid.reference, nodes, rigid.where);
      deck.links.back().others = free.first, deck.links.back().axis = free.second;
    }
  }
  find_rods_alone();
}

}  // namespace floe::mesh
