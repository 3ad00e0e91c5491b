#include "floe/mesh/gmsh.h"

#include <limits>
#include <memory>

#include "floe/petsc/error.h"
#include "gmsh_records.h"
#include "text.h"

namespace floe::mesh {
namespace {

void refuse_too_many(const GmshStructure& structure, Faults& faults) {
  constexpr long long most = std::numeric_limits<PetscInt>::max();
  long long elements = 0;
  for (const auto& block : structure.elements) elements += block.count;
  if (structure.node_count > most || elements > most)
    faults.add({0, 1}, "more than " + std::to_string(most) + " nodes or elements");
}

std::vector<std::string> notices_of(const std::string& path, long long left_out, long long without_middle,
                                    PetscInt dropped) {
  std::vector<std::string> notices;
  if (without_middle > 0)
    notices.push_back(path + ": " + std::to_string(without_middle) +
                      " quadrilaterals of 9 nodes are read as those of 8, without the nodes in their middles");
  dropped -= static_cast<PetscInt>(without_middle);
  if (left_out > 0)
    notices.push_back(path + ": " + std::to_string(left_out) + " elements in no physical group are ignored");
  if (dropped > 0) notices.push_back(path + ": " + std::to_string(dropped) + " nodes that no element uses are ignored");
  return notices;
}

}  // namespace

GmshFile read_gmsh(MPI_Comm comm, const std::string& path, const std::vector<std::string>& wanted_parts, bool others) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  std::unique_ptr<Faults> faults;
  FileMesh file;
  long long left_out = 0, without_middle = 0;
  std::vector<std::string> shared;
  petsc::agree(comm, [&] {
    const MappedFile mapped(path);
    const GmshStructure structure = gmsh_structure(mapped);
    faults = std::make_unique<Faults>(structure.nodes.front().labels.binary);
    faults->add_file(path);
    refuse_too_many(structure, *faults);
    const GmshSelection selection = select_parts(structure, {wanted_parts, others}, *faults);
    if (faults->any()) return;
    left_out = selection.left_out, without_middle = selection.without_middle, shared = selection.shared;
    file.parts = selection.parts;
    read_nodes(structure, share_of(static_cast<PetscInt>(structure.node_count), rank, ranks), file, *faults);
    read_elements(structure, selection, rank, ranks, file, *faults);
  });
  faults->throw_together(comm);
  Numbered numbered = number_labels(comm, std::move(file), *faults);
  numbered.mesh.source = path;
  std::vector<std::string> notices = notices_of(path, left_out, without_middle, numbered.dropped);
  for (const std::string& words : shared) notices.push_back(path + ": " + words);
  return {std::move(numbered.mesh), std::move(notices)};
}

}  // namespace floe::mesh
