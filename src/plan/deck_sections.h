#pragma once
#include <map>

#include "floe/mesh/deck.h"
#include "floe/scene/scene.h"

namespace floe::plan {
using namespace scene;

/// A part of a deck, as far as its section is worth a notice.
struct DeckPart {
  int number = -1;  ///< of RawMesh::parts
  std::string name;
  std::vector<std::string> massless;  ///< what has no density: `material FOAM`, or `the section`
  double size = 0;                    ///< thickness of a shell, greatest dimension of a profile; as written
};

struct DeckSections {
  std::map<int, fem::Section> parts;        ///< by the number of RawMesh::parts
  std::vector<DeckPart> described;          ///< the same parts
  std::map<int, fem::StressPoints> points;  ///< likewise
};

/// Sections of a deck's parts, as floe's elements take them. Section axes: y is the deck's 1-direction, z its
/// 2-direction.
///
/// Shells: OFFSET moves the middle the other way; plies from below; all plies of a section are rotated against one
/// axis.
/// @throws InputError  one line a fault: material missing or without elasticity, unsymmetric box and I profiles, plies
///                     of different orientations
DeckSections deck_sections(const mesh::DeckFile& file);

/// Of parts whose section is the deck's own: materials without *DENSITY, with the share of elements that they make
/// massless; and, where `scale` is not 1, what it leaves as written, by the ratio of thickness and extent.
///
/// @param replaced  parts that have a section of the scene
/// @return          lines without an end. Collective.
std::vector<std::string> deck_notices(const mesh::DeckFile& file, const DeckSections& deck,
                                      const std::vector<std::string>& replaced, double scale);

/// Adds the deck's point masses to the mesh as cells of one node, in parts `mass M` for each value. Collective.
void add_masses(mesh::DeckFile& file, std::map<int, fem::Section>& parts);

/// As bushings that have viscosity alone. @return  how many, of all ranks. Collective.
PetscInt omit_springs_without_stiffness(MPI_Comm comm, std::vector<mesh::NodeSpring>& springs);

/// Adds springs between nodes to the mesh as elements of two nodes, in parts `spring` for each set of constants.
/// Collective.
void add_springs(mesh::RawMesh& raw, const std::vector<mesh::NodeSpring>& springs, std::map<int, fem::Section>& parts);

}  // namespace floe::plan
