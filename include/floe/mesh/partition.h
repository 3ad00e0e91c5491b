#pragma once
#include <string>

#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

/// The rank that each node of this rank's share should move to: equal numbers of nodes, few elements between ranks.
///
/// The graph joins nodes that share an element. Options have the prefix -mesh_: -mesh_mat_partitioning_type metis (the
/// default), ptscotch, current, ...
/// @throws InputError  an option that cannot be taken
/// @throws RunError  the partitioner failed
/// Collective.
std::vector<int> partition(const RawMesh& mesh);

/// Lets a partitioner without a mesh take the options of a prefix.
/// @throws InputError  an option that cannot be taken. Rank-local.
void check_partitioning_options(const std::string& prefix);

/// Number of edges of the graph whose ends are on different ranks. Collective.
long long edge_cut(const RawMesh& mesh, const std::vector<int>& ranks);

/// Makes the MatPartitioning type "metis" known to PETSc, once: METIS_PartGraphKway on rank 0. partition() calls it.
void register_metis();

}  // namespace floe::mesh
