#pragma once
#include "faults.h"
#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

/// A cell in the labels of its file.
struct FileCell {
  long long label;
  CellKind kind;
  int part;
  std::array<long long, most_nodes> nodes;  // of the kind's number
  Where where;
  FileCell(long long l, CellKind k, int p, const std::array<long long, most_nodes>& n, Where w)
      : label(l), kind(k), part(p), nodes(n), where(w) {}
  FileCell(long long l, CellKind k, int p, const std::array<long long, 4>& corners, Where w)
      : FileCell(l, k, p, no_nodes<long long>(), w) {
    std::copy(corners.begin(), corners.end(), nodes.begin());
  }
};

/// A node set in the labels of its file.
struct FilePlace {
  std::string name;
  Where where;
  std::vector<long long> labels;     // that this rank found
  bool weighted = false;             // same on all ranks
  std::vector<double> weights = {};  // of the labels, if weighted
};

/// An element that is no cell.
struct FileMass {
  long long label;
  Where where;
};

/// A node that something else than a cell uses, and that is therefore kept.
struct Mention {
  long long label;
  Where where;
};

/// This rank's share of what a file holds, in the order of the file, in its labels.
struct FileMesh {
  std::vector<long long> node_labels;
  std::vector<Eigen::Vector3d> positions;
  std::vector<Where> node_where;
  std::vector<FileCell> cells;
  std::vector<std::string> parts;  // same on all ranks
  std::vector<FilePlace> places;   // same names on all ranks
  std::vector<Mention> mentions;
  std::vector<FileMass> masses;
};

struct Numbered {
  RawMesh mesh;
  std::vector<PetscInt> mentioned;  // nodes of FileMesh::mentions
  PetscInt dropped = 0;             // nodes that nothing uses
};

/// Numbers the nodes and cells 0..n-1 and drops the nodes that neither a cell nor a mention uses. Collective.
/// @throws InputError  labels that are defined twice, or used and not defined
Numbered number_labels(MPI_Comm comm, FileMesh file, Faults& faults);

}  // namespace floe::mesh
