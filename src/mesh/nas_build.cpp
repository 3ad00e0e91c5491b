#include "nas_build.h"

#include <fmt/format.h>

#include <algorithm>

#include "text.h"

namespace floe::mesh {

void NasBuild::build() {
  deck.nastran = true;
  share_ = share_of(static_cast<PetscInt>(model_.shells.size() + model_.beams.size()), rank_, ranks_);
  add_grids();
  add_links();
  add_shells();
  add_beams();
  add_extra_grids();
  add_springs();
  add_masses();
  add_means();
  add_places();
  report_unused();
}

bool NasBuild::mine(std::size_t element) const {
  const auto i = static_cast<PetscInt>(element);
  return i >= share_.first && i < share_.first + share_.count;
}

void NasBuild::add_grids() {
  const Share share = share_of(static_cast<PetscInt>(model_.grids.size()), rank_, ranks_);
  for (std::size_t i = 0; i < model_.grids.size(); ++i) {
    const NasGrid& grid = model_.grids[i];
    const Eigen::Vector3d x = frames_.position_of(grid);
    next_label_ = std::max(next_label_, grid.id + 1);
    if (static_cast<PetscInt>(i) < share.first || static_cast<PetscInt>(i) >= share.first + share.count) continue;
    mesh.node_labels.push_back(grid.id);
    mesh.positions.push_back(x);
    mesh.node_where.push_back(grid.where);
  }
}

void NasBuild::link(long long reference, const std::vector<long long>& nodes, Where where) {
  auto& rigid = deck.links.emplace_back(RigidLink{static_cast<PetscInt>(mesh.mentions.size()), {}});
  mesh.mentions.push_back({reference, where});
  if (rank_ != 0) return;
  for (const long long node : nodes) {
    if (node == reference) continue;
    rigid.nodes.push_back(static_cast<PetscInt>(mesh.mentions.size()));
    mesh.mentions.push_back({node, where});
  }
}

void NasBuild::add_extra_grids() {
  if (rank_ == ranks_ - 1)
    for (const auto* all : {&extra_, &between_})
      for (const Extra& extra : *all) {
        mesh.node_labels.push_back(extra.label);
        mesh.positions.push_back(extra.x);
        mesh.node_where.push_back(extra.where);
      }
  if (!between_.empty())
    notices.push_back(
        fmt::format("{}: beams with taper are divided into pieces of uniform section, with {} between "
                    "them, from {} on",
                    faults_.text_of(between_.front().where), counted(static_cast<long long>(between_.size()), "node"),
                    between_.front().label));
  if (extra_.empty()) return;
  for (const auto& [reference, which] : extra_links_) {
    std::vector<long long> nodes;
    for (const std::size_t i : which) nodes.push_back(extra_[i].label);
    link(reference, nodes, extra_[which.front()].where);
  }
  notices.push_back(faults_.text_of(extra_.front().where) + ": " +
                    counted(static_cast<long long>(extra_.size()), "node") + " of beams with offsets, from " +
                    std::to_string(extra_.front().label) + " on, rigidly linked to their grids");
}

std::vector<long long> NasBuild::used_grids() const {
  std::vector<long long> used;
  const auto add = [&](const auto& grids) { used.insert(used.end(), grids.begin(), grids.end()); };
  for (const NasShell& shell : model_.shells) add(shell.nodes), add(shell.middles);
  for (const NasBeam& beam : model_.beams) add(beam.nodes);
  for (const NasSpring& spring : model_.springs)
    if (spring.grids[0] > 0 && spring.grids[1] > 0) add(spring.grids);
  for (const NasMass& mass : model_.masses) used.push_back(mass.grid);
  for (const NasMassMatrix& mass : model_.mass_matrices) used.push_back(mass.grid);
  for (const NasScalarMass& mass : model_.component_masses) used.push_back(mass.grid);
  for (const NasLink& rigid : model_.links) used.push_back(rigid.reference), add(rigid.nodes);
  std::sort(used.begin(), used.end());
  return used;
}

/// A place is where the mean of its grids is: a force at another point has a moment about it.
void NasBuild::refuse_distant(const NasMean& mean) {
  const NasGrid* reference = frames_.grid(mean.reference);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> points;
  double sum = 0;
  for (std::size_t i = 0; i < mean.nodes.size(); ++i) {
    const NasGrid* grid = frames_.grid(mean.nodes[i]);
    if (!grid) return;  // a fault elsewhere
    points.push_back(frames_.position_of(*grid));
    centre += mean.weights[i] * points.back(), sum += mean.weights[i];
  }
  if (!reference) return;
  centre /= sum;
  double size = 0;
  for (const Eigen::Vector3d& x : points) size = std::max(size, (x - centre).norm());
  const double apart = (frames_.position_of(*reference) - centre).norm();
  constexpr double near = 1e-6;  // of the size of the place, and of coordinates, which are rounded
  if (apart <= near * (size + centre.norm())) return;
  faults_.add(mean.where, fmt::format("RBE3 {}: reference grid {} is {:.3g} away from the mean of its grids, ({:.6g}, "
                                      "{:.6g}, {:.6g}); expected a grid there; to "
                                      "leave the card out: file: {{ignore: [RBE3]}}",
                                      mean.id, mean.reference, apart, centre.x(), centre.y(), centre.z()));
}

/// A mean of grids carries nothing: where its reference grid has no more it is a place of the scene.
void NasBuild::add_means() {
  if (model_.means.empty()) return;
  const std::vector<long long> held = used_grids();
  const auto holds = [&](long long grid) { return std::binary_search(held.begin(), held.end(), grid); };
  std::vector<long long> used = held;
  for (const NasMean& mean : model_.means) used.insert(used.end(), mean.nodes.begin(), mean.nodes.end());
  std::sort(used.begin(), used.end());
  std::vector<std::string> names;
  for (const NasMean& mean : model_.means) {
    const std::string name = "RBE3 " + std::to_string(mean.id);
    if (std::count(names.begin(), names.end(), "RBE3_" + std::to_string(mean.id)) > 0) {
      faults_.add(mean.where, name + ": there is another RBE3 of this number; expected one");
      continue;
    }
    const auto loose = std::find_if_not(mean.nodes.begin(), mean.nodes.end(), holds);
    if (loose != mean.nodes.end() && frames_.grid(*loose))
      faults_.add(mean.where, fmt::format("{}: grid {} has no element, mass or link, and does not move with the body; "
                                          "expected grids of the body; to leave the card out: file: {{ignore: [RBE3]}}",
                                          name, *loose));
    if (std::binary_search(used.begin(), used.end(), mean.reference)) {
      faults_.add(
          mean.where,
          fmt::format("{0}: reference grid {1} has an element, a mass or a link, which a mean of grids does not "
                      "carry; expected RBE2, or for a mass a rigid body of the scene, fixed to the place "
                      "RBE3_{2} by a joint",
                      name, mean.reference, mean.id));
      continue;
    }
    refuse_distant(mean);
    names.push_back("RBE3_" + std::to_string(mean.id));
    FilePlace& place = mean_places_.emplace_back(FilePlace{names.back(), mean.where, {}, true});
    std::map<long long, double> weights;
    for (std::size_t i = 0; i < mean.nodes.size(); ++i) weights[mean.nodes[i]] += mean.weights[i];
    if (rank_ == 0)
      for (const auto& [node, weight] : weights) place.labels.push_back(node), place.weights.push_back(weight);
  }
  if (names.empty()) return;
  notices.push_back(
      faults_.text_of(model_.means.front().where) + ": " + counted(static_cast<long long>(names.size()), "RBE3") +
      " without element at the reference grid: a place each, the mean of its grids by the weights of the card (" +
      names.front() + (names.size() > 1 ? ", ...)" : ")") +
      "; joints there with edges: mean (edges: rigid makes the grids one rigid region)");
}

std::map<std::string, std::vector<std::pair<long long, Where>>> NasBuild::supports() const {
  std::map<std::string, std::vector<std::pair<long long, Where>>> all;
  for (const auto& [set, grids] : model_.supports) all["SPC" + std::to_string(set)] = grids;
  for (const auto& [set, first, last, where] : model_.support_ranges)
    for (const NasGrid& grid : model_.grids)
      if (grid.id >= first && grid.id <= last) all["SPC" + std::to_string(set)].emplace_back(grid.id, where);
  for (const NasGrid& grid : model_.grids)
    if (frames_.constrained(grid)) all["PS"].emplace_back(grid.id, grid.where);
  return all;
}

void NasBuild::add_places() {
  std::map<std::string, std::size_t> numbers;
  const auto place = [&](const std::string& name, Where where) {
    const auto [at, fresh] = numbers.try_emplace(name, mesh.places.size());
    if (fresh) mesh.places.push_back({name, where, {}});
    return at->second;
  };
  std::vector<std::size_t> of_part;
  for (const std::string& part : mesh.parts) of_part.push_back(place(part, {0, 1}));
  for (const FileCell& cell : mesh.cells) {
    auto& labels = mesh.places[of_part[cell.part]].labels;
    labels.insert(labels.end(), cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind));
  }
  for (const auto& [name, grids] : supports()) {
    auto& support = mesh.places[place(name, grids.empty() ? Where{0, 1} : grids.front().second)];
    for (const auto& [grid, where] : grids) {
      if (!frames_.grid(grid))
        faults_.add(where, "supports " + name + " name grid " + std::to_string(grid) + ", which is not defined");
      else if (rank_ == 0)
        support.labels.push_back(grid);
    }
  }
  for (auto& one : mesh.places) {
    std::sort(one.labels.begin(), one.labels.end());
    one.labels.erase(std::unique(one.labels.begin(), one.labels.end()), one.labels.end());
  }
  mesh.places.insert(mesh.places.end(), mean_places_.begin(), mean_places_.end());
}

void NasBuild::report_unused() {
  std::vector<std::string> unused;
  const auto is_used = [](std::vector<long long>& used, long long id) {
    return std::find(used.begin(), used.end(), id) != used.end();
  };
  for (auto* used : {&used_materials_, &used_properties_}) {
    std::sort(used->begin(), used->end());
    used->erase(std::unique(used->begin(), used->end()), used->end());
  }
  for (const auto& [id, own] : model_.shell_properties)
    if (!is_used(used_properties_, id)) unused.push_back(own.name);
  for (const auto& [id, own] : model_.beam_properties)
    if (!is_used(used_properties_, id)) unused.push_back(own.name);
  for (const auto& [id, own] : model_.materials)
    if (!is_used(used_materials_, id)) unused.push_back(own.material.name);
  for (const auto& [part, count] : without_property_)
    notices.push_back(faults_.text_of({0, 1}) + ": " + counted(count, "element") + " of part " + part +
                      " with the section of the scene: the deck does not have the property");
  if (without_thickness_ > 0)
    notices.push_back(faults_.text_of({0, 1}) + ": " + counted(without_thickness_, "shell") +
                      " with the section of the scene: neither elements nor PSHELL have a thickness");
  if (varying_shells_ > 0)
    notices.push_back(faults_.text_of({0, 1}) + ": " + counted(varying_shells_, "shell") +
                      " of varying thickness: membrane and mass by the mean of the corners, bending by that of the "
                      "cubes, stresses where it is thickest");
  if (!unused.empty()) notices.push_back(faults_.text_of({0, 1}) + ": not used by any element: " + listed(unused));
}

}  // namespace floe::mesh
