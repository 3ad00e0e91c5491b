#pragma once
#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

enum class GmshEncoding { ascii, binary };

/// Writes a Gmsh file of format 4.1 (8-byte counts, this machine's byte order) that read_gmsh(path, mesh.parts) gives
/// back: nodes and elements in their order with their labels, positions bit by bit.
///
/// A part is a curve or surface in a physical group of its name; a place is a point with an element for each of its
/// nodes. read_gmsh makes a place of every group, thus of the parts too; parts without cells and places without nodes
/// are left out, since a group lives by its elements. Rank 0 writes what the others send it one after the other, piece
/// by piece.
/// @throws InputError  a part of lines and shells together, an empty name or one with a quotation mark or the end
///   of a line in it, a mesh without elements
/// @throws RunError    the file cannot be written
/// Collective. Source: Gmsh reference manual, "MSH file format".
void write_gmsh(const std::string& path, const RawMesh& mesh, GmshEncoding encoding = GmshEncoding::ascii);

}  // namespace floe::mesh
