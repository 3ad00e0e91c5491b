#pragma once
#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

/// What a Gmsh file holds.
struct GmshFile {
  RawMesh mesh;
  std::vector<std::string> notices;  // same on all ranks: what was left out
};

/// Reads a Gmsh file of format 4.1, 4.0 or 2 (2.0 to 2.2), ASCII or binary of either byte order; 4.1 with 4- or 8-byte
/// counts. In format 2 the first tag of an element is its physical group; 0: none.
///
/// Parts are physical groups of curves and surfaces, places the node sets of all physical groups (of points too); a
/// group without a name is called by its number. Cells are lines of 2, triangles of 3 and quadrilaterals of 4 nodes.
/// Every rank walks the file and reads its own share of the records.
/// @param wanted_parts  names of physical groups, in the order that RawMesh::parts then has. Empty: all groups of the
///   highest dimension that the file has elements of, or all elements of it as the part "mesh" where it has no groups.
/// @param others  after the wanted parts all other groups of the highest dimension, too. Elements of several groups
///   belong to the wanted one, else to the first by number, which a notice states.
/// @throws InputError  the same on every rank, with line (ASCII) or byte (binary): anything that is not of the format;
///   formats 1 and 3; partitioned meshes; elements of wanted parts that are of another kind; parts that do not
///   exist, are empty or share a surface; labels that are defined twice, or used and not defined
/// Collective.
/// Source: Gmsh reference manual, "MSH file format".
GmshFile read_gmsh(MPI_Comm comm, const std::string& path, const std::vector<std::string>& wanted_parts = {},
                   bool others = false);

}  // namespace floe::mesh
