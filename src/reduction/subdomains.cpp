#include "subdomains.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "floe/fem/subdomains.h"
#include "multigrid.h"

namespace floe::reduction {

using petsc::check;

namespace {

/// A node of an interface: its place, and its number in this rank's subdomain.
struct InterfaceNode {
  Eigen::Vector3d x;
  PetscInt number;
};

/// By the ranks that share them; in the order of their global numbers, on all of these ranks.
using Interfaces = std::map<std::vector<PetscInt>, std::vector<InterfaceNode>>;

Eigen::Vector3d place_of(const fem::Mesh& mesh, PetscInt global) {
  if (global >= mesh.first_node && global < mesh.first_node + mesh.owned_nodes)
    return mesh.positions[global - mesh.first_node];
  const auto found = std::lower_bound(mesh.foreign.begin(), mesh.foreign.end(), global);
  return mesh.positions[mesh.owned_nodes + (found - mesh.foreign.begin())];
}

Interfaces interfaces_of(ISLocalToGlobalMapping mapping, const fem::Structure& structure) {
  const int n = structure.dofs_per_node;
  PetscInt dofs = 0, *count = nullptr, **ranks = nullptr;
  const PetscInt* global = nullptr;
  std::map<std::vector<PetscInt>, std::map<PetscInt, PetscInt>> shared;  // global number to number in the subdomain
  check(ISLocalToGlobalMappingGetNodeInfo(mapping, &dofs, &count, &ranks));
  check(ISLocalToGlobalMappingGetIndices(mapping, &global));
  for (PetscInt i = 0; i < dofs; i += n) {
    if (count[i] < 2) continue;
    std::vector<PetscInt> sharing(ranks[i], ranks[i] + count[i]);
    std::sort(sharing.begin(), sharing.end());
    shared[sharing][global[i] / n] = i / n;
  }
  check(ISLocalToGlobalMappingRestoreIndices(mapping, &global));
  check(ISLocalToGlobalMappingRestoreNodeInfo(mapping, &dofs, &count, &ranks));
  Interfaces interfaces;
  for (const auto& [sharing, nodes] : shared)
    for (const auto& [node, number] : nodes) interfaces[sharing].push_back({place_of(structure.mesh, node), number});
  return interfaces;
}

const InterfaceNode& farthest(const std::vector<InterfaceNode>& nodes, const Eigen::Vector3d& from) {
  return *std::max_element(nodes.begin(), nodes.end(), [&](const InterfaceNode& a, const InterfaceNode& b) {
    return (a.x - from).norm() * (1 + 1e-9) < (b.x - from).norm();  // of equally far ones the first
  });
}

}  // namespace

void set_corners(PC bddc, Mat A, const fem::Structure& structure) {
  const int n = structure.dofs_per_node;
  ISLocalToGlobalMapping mapping = nullptr;
  check(MatISGetLocalToGlobalMapping(A, &mapping, nullptr));
  std::vector<PetscInt> dofs;
  for (const auto& [ranks, nodes] : interfaces_of(mapping, structure)) {
    const InterfaceNode& first = farthest(nodes, nodes[0].x);
    for (const InterfaceNode* corner : {&first, &farthest(nodes, first.x)})
      for (int i = 0; i < n; ++i) dofs.push_back(n * corner->number + i);
  }
  std::sort(dofs.begin(), dofs.end());
  dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
  petsc::IsHandle corners;
  check(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(dofs.size()), dofs.data(), PETSC_COPY_VALUES,
                        corners.out()));
  check(PCBDDCSetPrimalVerticesLocalIS(bddc, corners));
}

petsc::MatHandle for_iteration(KSP ksp, const ShiftedStiffness& stiffness) {
  const auto& [structure, frame, constrained, shift, assembled] = stiffness;
  PC pc = nullptr;
  PetscBool by_subdomains = PETSC_FALSE;
  const char* prefix = nullptr;
  check(KSPGetOptionsPrefix(ksp, &prefix));
  check(KSPGetPC(ksp, &pc));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCBDDC, &by_subdomains));
  if (!by_subdomains && assembled) return for_multigrid(assembled, frame, constrained);
  if (!by_subdomains) return for_multigrid(fem::assemble(structure, constrained, 1, 1, -shift), frame, constrained);
  int ranks = 1;
  MPI_Comm_size(structure.mesh.comm, &ranks);
  if (ranks == 1)  // PCBDDC of PETSc 3.18.5 reads past its arrays where there is no interface
    throw InputError(
        fmt::format("option -{}pc_type bddc: one rank is one subdomain; expected several ranks (mpirun -n "
                    "4), or cholesky",
                    prefix ? prefix : ""));
  petsc::MatHandle A = fem::assemble_subdomains(structure, constrained, 1, -shift);
  set_near_null_space(A, frame, constrained);
  set_corners(pc, A, structure);
  return A;
}

}  // namespace floe::reduction
