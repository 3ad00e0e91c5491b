#pragma once
#include "floe/mesh/deck.h"
#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

/// What a deck holds.
struct InpFile {
  RawMesh mesh;
  Deck deck;
  std::vector<std::string> notices;  // same on all ranks: what was left out
};

/// Reads an input deck of CalculiX or Abaqus: its mesh, sections, materials, point masses and rigid links.
///
/// Parts are the element sets that sections name, places the node sets (*NSET, NSET=, node-based *SURFACE); names are
/// those of the deck, compared without case. Elements: B31, B33, S3, S3R, STRI3, S4, S4R and MASS. Rigid links: *RIGID
/// BODY (NSET= or TIE NSET=), *MPC BEAM, *COUPLING with *KINEMATIC of all six directions.
/// Left out with a notice: what stands between *STEP and *END STEP, *BOUNDARY (supports are joints of the scene),
/// *AMPLITUDE, *TIME POINTS, *EXPANSION, *CONDUCTIVITY, *SPECIFIC HEAT, nodes that nothing uses.
/// Every record of an *ELEMENT block takes as many lines as its first. A node has two or three coordinates.
/// SECTION=CIRC with one number is a radius (Abaqus), with two equal ones a diameter (CalculiX). GENERATE takes those
/// labels of its range that exist. One *PART and one *INSTANCE that is not moved are looked through.
/// Parameters without meaning here are passed over: CONTROLS, TEMPERATURE and POISSON of sections.
/// @throws InputError  the same on every rank, one line a fault, with file and line: what was found and what was
/// expected;
///   every keyword, parameter and element type that is not named here; elements without a section or with two; labels
///   that are defined twice, or used and not defined
/// Collective.
/// Source: CalculiX CrunchiX manual, "Input deck format"; Abaqus keywords reference.
InpFile read_inp(MPI_Comm comm, const std::string& path);

}  // namespace floe::mesh
