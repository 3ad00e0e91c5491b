#include "file_mesh.h"

#include "floe/mesh/exchange.h"
#include "floe/mesh/labels.h"

namespace floe::mesh {
namespace {

void refuse_repeated(MPI_Comm comm, const FileMesh& file, const LabelDirectory& nodes, Faults& faults) {
  for (const std::size_t i : nodes.repeated(file.node_labels))
    faults.add(file.node_where[i], "node " + std::to_string(file.node_labels[i]) + " is defined a second time");
  std::vector<long long> labels;
  labels.reserve(file.cells.size() + file.masses.size());
  for (const auto& cell : file.cells) labels.push_back(cell.label);
  for (const auto& mass : file.masses) labels.push_back(mass.label);
  const LabelDirectory cells(comm, labels);
  for (const std::size_t i : cells.repeated(labels))
    faults.add(i < file.cells.size() ? file.cells[i].where : file.masses[i - file.cells.size()].where,
               "element " + std::to_string(labels[i]) + " is defined a second time");
}

Translation labels_used(const FileMesh& file) {
  std::vector<long long> labels;
  for (const auto& cell : file.cells)
    labels.insert(labels.end(), cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind));
  for (const auto& mention : file.mentions) labels.push_back(mention.label);
  for (const auto& place : file.places) labels.insert(labels.end(), place.labels.begin(), place.labels.end());
  return Translation(std::move(labels));
}

void refuse_unknown(MPI_Comm comm, const FileMesh& file, const Translation& used, const std::vector<PetscInt>& found,
                    Faults& faults) {
  const auto check = [&](long long label, Where where, auto&& user) {
    if (found[used.position(label)] < 0)
      faults.add(where, user() + " names node " + std::to_string(label) + ", which is not defined");
  };
  for (const auto& cell : file.cells)
    for (int i = 0; i < node_count(cell.kind); ++i)
      check(cell.nodes[i], cell.where, [&] { return "element " + std::to_string(cell.label); });
  for (const auto& mention : file.mentions)
    check(mention.label, mention.where, [] { return std::string("this line"); });
  faults.throw_together(comm);  // the sets that hold the nodes of bad elements need not be reported as well
  for (const auto& place : file.places)
    for (const long long label : place.labels) check(label, place.where, [&] { return "node set " + place.name; });
  faults.throw_together(comm);
}

// Of this rank's share of the nodes: which of them a cell or a mention of any rank uses.
std::vector<char> kept_nodes(MPI_Comm comm, const FileMesh& file, const Translation& used,
                             const std::vector<PetscInt>& found, const std::vector<PetscInt>& starts, PetscInt first) {
  std::vector<char> needed(found.size(), 0);
  for (const auto& cell : file.cells)
    for (int i = 0; i < node_count(cell.kind); ++i) needed[used.position(cell.nodes[i])] = 1;
  for (const auto& mention : file.mentions) needed[used.position(mention.label)] = 1;
  std::vector<PetscInt> told;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (needed[i]) told.push_back(found[i]);
  std::vector<char> kept(file.node_labels.size(), 0);
  const auto heard = scatter(comm, told, [&](PetscInt node) { return owner_of(starts, node); });
  for (const PetscInt node : heard.values) kept[node - first] = 1;
  return kept;
}

void fill(Numbered& result, const FileMesh& file, const Translation& used, const std::vector<PetscInt>& numbers) {
  const auto number = [&](long long label) { return numbers[used.position(label)]; };
  auto& mesh = result.mesh;
  mesh.cells.reserve(file.cells.size());
  for (const auto& from : file.cells) {
    Cell cell{from.kind, no_nodes<PetscInt>(), from.part};
    for (int i = 0; i < node_count(from.kind); ++i) cell.nodes[i] = number(from.nodes[i]);
    mesh.cells.push_back(cell);
    mesh.cell_labels.push_back(from.label);
  }
  for (const auto& mention : file.mentions) result.mentioned.push_back(number(mention.label));
  for (const auto& place : file.places) {
    mesh.places.push_back(place.name);
    auto& nodes = mesh.place_nodes.emplace_back();
    for (const long long label : place.labels)
      if (number(label) >= 0) nodes.push_back(number(label));
    if (!place.weighted) continue;
    auto& weights = mesh.place_weights[place.name];
    for (std::size_t i = 0; i < place.labels.size(); ++i)
      if (number(place.labels[i]) >= 0) weights.push_back({number(place.labels[i]), place.weights[i]});
  }
}

}  // namespace

Numbered number_labels(MPI_Comm comm, FileMesh file, Faults& faults) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const LabelDirectory directory(comm, file.node_labels);
  const auto starts = starts_of(comm, static_cast<PetscInt>(file.node_labels.size()));
  const Translation used = labels_used(file);
  const auto found = directory.find(used.keys());
  refuse_repeated(comm, file, directory, faults);
  refuse_unknown(comm, file, used, found, faults);

  const auto kept = kept_nodes(comm, file, used, found, starts, starts[rank]);
  Numbered result;
  auto& mesh = result.mesh;
  mesh.comm = comm;
  mesh.parts = file.parts;
  std::vector<PetscInt> number(kept.size(), -1);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (!kept[i]) continue;
    number[i] = static_cast<PetscInt>(mesh.positions.size());
    mesh.positions.push_back(file.positions[i]);
    mesh.node_labels.push_back(file.node_labels[i]);
  }
  const auto new_starts = starts_of(comm, static_cast<PetscInt>(mesh.positions.size()));
  const auto cell_starts = starts_of(comm, static_cast<PetscInt>(file.cells.size()));
  mesh.first_node = new_starts[rank];
  mesh.node_count = new_starts.back();
  mesh.first_cell = cell_starts[rank];
  mesh.cell_count = cell_starts.back();
  result.dropped = starts.back() - mesh.node_count;
  for (auto& i : number)
    if (i >= 0) i += mesh.first_node;
  const auto numbers = ask<PetscInt>(
      comm, found, [&](PetscInt node) { return owner_of(starts, node); },
      [&](PetscInt node) { return number[node - starts[rank]]; });
  fill(result, file, used, numbers);
  return result;
}

}  // namespace floe::mesh
