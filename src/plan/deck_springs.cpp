#include <algorithm>

#include "deck_sections.h"
#include "floe/mesh/exchange.h"

namespace floe::plan {
namespace {

/// Stiffnesses, axes, place, kind: springs that have the same are one part.
using SpringKey = std::array<double, 17>;

SpringKey key_of(const mesh::NodeSpring& spring) {
  SpringKey key;
  std::copy(spring.stiffness.begin(), spring.stiffness.end(), key.begin());
  Eigen::Map<Eigen::Matrix3d>(key.data() + 6) = spring.axes;
  key[15] = spring.at, key[16] = static_cast<double>(spring.kind);
  return key;
}

fem::NodeSpring section_of(const SpringKey& key) {
  fem::NodeSpring section;
  section.stiffness = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(key.data());
  section.axes = Eigen::Map<const Eigen::Matrix3d>(key.data() + 6);
  section.at = key[15], section.kind = static_cast<mesh::SpringKind>(static_cast<int>(key[16]));
  return section;
}

/// Those of all ranks, ascending, each once. Collective.
std::vector<SpringKey> keys_of_all_ranks(MPI_Comm comm, const std::vector<mesh::NodeSpring>& springs) {
  std::vector<SpringKey> mine;
  for (const mesh::NodeSpring& spring : springs) mine.push_back(key_of(spring));
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  std::vector<SpringKey> copies;
  for (int rank = 0; rank < ranks; ++rank) copies.insert(copies.end(), mine.begin(), mine.end());
  std::vector<SpringKey> all =
      mesh::exchange(comm, copies, std::vector<int>(static_cast<std::size_t>(ranks), static_cast<int>(mine.size())))
          .values;
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

PetscInt omit_springs_without_stiffness(MPI_Comm comm, std::vector<mesh::NodeSpring>& springs) {
  auto omitted = static_cast<PetscInt>(std::erase_if(springs, [](const mesh::NodeSpring& spring) {
    return std::all_of(spring.stiffness.begin(), spring.stiffness.end(), [](double k) { return k == 0; });
  }));
  MPI_Allreduce(MPI_IN_PLACE, &omitted, 1, MPIU_INT, MPI_SUM, comm);
  return omitted;
}

void add_springs(mesh::RawMesh& raw, const std::vector<mesh::NodeSpring>& springs, std::map<int, fem::Section>& parts) {
  const std::vector<SpringKey> all = keys_of_all_ranks(raw.comm, springs);
  if (all.empty()) return;
  const int first = static_cast<int>(raw.parts.size());
  for (const SpringKey& key : all) {
    parts[static_cast<int>(raw.parts.size())] = section_of(key);
    raw.parts.emplace_back("spring");
  }
  for (const mesh::NodeSpring& spring : springs) {
    const int part = first + static_cast<int>(std::lower_bound(all.begin(), all.end(), key_of(spring)) - all.begin());
    mesh::Cell cell{mesh::CellKind::spring, mesh::no_nodes<PetscInt>(), part};
    std::copy(spring.nodes.begin(), spring.nodes.end(), cell.nodes.begin());
    raw.cells.push_back(cell);
    raw.cell_labels.push_back(spring.label);
  }
  int rank = 0;
  MPI_Comm_rank(raw.comm, &rank);
  const std::vector<PetscInt> cells = mesh::starts_of(raw.comm, static_cast<PetscInt>(raw.cells.size()));
  raw.first_cell = cells[static_cast<std::size_t>(rank)];
  raw.cell_count = cells.back();
}

}  // namespace floe::plan
