#pragma once
#include <memory>
#include <string>
#include <vector>

#include "floe/mesh/links.h"
#include "floe/scene/scene.h"

namespace floe::plan {
using namespace scene;

/// A mesh as the scene gives it, all of it on every rank (first_node = first_cell = 0), with its rigid links.
struct WholeMesh {
  mesh::RawMesh mesh;
  std::vector<mesh::DependentNode> links;
};
/// @throws InputError  Collective.
WholeMesh whole_mesh(const Body& body, MPI_Comm comm);

/// All of a mesh on every rank. Collective.
mesh::RawMesh on_every_rank(const mesh::RawMesh& mesh);

/// This rank's share of a piece; nodes keep their order. Its cuts become places.
/// @param links  of the whole mesh; receives those of the piece
mesh::RawMesh piece_of(const mesh::RawMesh& whole, const MeshPiece& piece, std::vector<mesh::DependentNode>& links);

/// A mesh cut into pieces by planes across its longest extent: along the longer edge of a plate, else along the mesh
/// axis along which it is longest. Planes lie at the nodes nearest to equal divisions; elements go where their corners'
/// mean lies. What a slice has of unconnected parts are pieces of their own, such as the arms of a branched beam.
struct CutMesh {
  struct Cut {
    int first, second;  ///< pieces
    std::string name;   ///< of the place on both
  };
  WholeMesh whole;
  std::vector<std::shared_ptr<const MeshPiece>> pieces;
  std::vector<Cut> cuts;
  std::vector<std::vector<int>> of_nodes;  ///< pieces of each node, ascending

  /// Pieces that have all nodes of the place, ascending. @throws InputError  no such place or node
  std::vector<int> pieces_of(const Body& body, const Place& place) const;
  /// Pieces with shells of the part, ascending; of any where its name is empty.
  std::vector<int> pieces_with_shells(const std::string& part) const;
};

/// @throws InputError  more frames than planes at nodes, an unconnected mesh, a rigid link across a plane
/// Collective.
CutMesh cut_mesh(const Body& body, MPI_Comm comm);

}  // namespace floe::plan
