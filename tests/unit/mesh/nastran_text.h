#pragma once
#include "floe/mesh/nastran.h"
#include "mesh_files.h"

/// Bulk data as text, and what the reader makes of it.
namespace floe::testing::nastran {

inline mesh::DeckFile read(const std::string& name, const std::string& text, const mesh::DeckRequest& request = {}) {
  return mesh::read_nastran(PETSC_COMM_WORLD, written(name, text), request);
}

inline std::string said(const std::string& text) {
  const auto path = written("bad.bdf", text);
  return fault_of([&] { mesh::read_nastran(PETSC_COMM_WORLD, path); });
}

inline std::string all_of(const std::vector<std::string>& notices) {
  std::string text;
  for (const auto& notice : notices) text += notice + "\n";
  return text;
}

inline const std::string grids = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\n";
inline const std::string steel = "MAT1,1,2.1+11,,.3,7800.\n";
inline const std::string skin = "PSHELL,3,1,.01,1\n" + steel;
inline const std::string square = grids + "CQUAD4,1,3,1,2,3,4\n" + skin;

/// The square with a beam of the cards `more` from grid 1 to grid 2.
inline std::string with_beam(const std::string& more) { return square + "CBAR,9,5,1,2,0.,0.,1.\n" + more; }

inline Eigen::Vector3d position(const mesh::RawMesh& raw, long long label) {
  const auto labels = of_all_ranks(raw.node_labels);
  const auto positions = of_all_ranks(raw.positions);
  const auto at = std::find(labels.begin(), labels.end(), label);
  REQUIRE(at != labels.end());
  return positions[at - labels.begin()];
}

}  // namespace floe::testing::nastran
