#pragma once
#include "floe/mesh/deck.h"

namespace floe::mesh {

/// Reads an input deck of CalculiX or Abaqus: its mesh, sections, materials, point masses and rigid links.
///
/// Parts are the element sets that sections name, places the node sets (*NSET, NSET=, node-based *SURFACE); names are
/// those of the deck, compared without case. Elements: B31, B33, S3, S3R, STRI3, S4, S4R and MASS; B31H, B31R, B33H,
/// S4R5, S4RS, S4RSW and S3RS as their twins, with a notice. Rigid links: *RIGID BODY (NSET= or TIE NSET=), *MPC BEAM,
/// *COUPLING with *KINEMATIC of all six directions. Of two sections of an element the later holds, with a notice.
/// *SHELL GENERAL SECTION by 21 numbers, or as *SHELL SECTION. SPRINGA and SPRING2 are springs between two nodes.
/// *NODAL THICKNESS, for sections that ask for it: a shell has the mean of its nodes, and elements of other thicknesses
/// are parts of the same name. Left out with a notice: what stands between *STEP and *END STEP; loads, supports,
/// contact, ties, equations, heat, plasticity, output and all that does not concern a linear elastic body, each keyword
/// with its lines; nodes that nothing uses; materials that no section uses. Elements without a section are refused, or,
/// where the request has sections, belong to the part of the last requested set that holds them, else of their
/// *ELEMENT, ELSET=, else `mesh`. Every record of an *ELEMENT block takes as many lines as its first. A node has two or
/// three coordinates. SECTION=CIRC with one number is a radius (Abaqus), with two equal ones a diameter (CalculiX).
/// GENERATE takes those labels of its range that exist. One *PART and one *INSTANCE that is not moved are looked
/// through. Parameters without meaning here are passed over: CONTROLS, TEMPERATURE and POISSON of sections.
/// @throws InputError  the same on every rank, one line a fault, with file and line: what was found and what was
/// expected;
///   every keyword, parameter and element type that is not known; elements without a section; labels
///   that are defined twice, or used and not defined
/// Collective.
/// Source: CalculiX CrunchiX manual, "Input deck format"; Abaqus keywords reference.
DeckFile read_inp(MPI_Comm comm, const std::string& path, const DeckRequest& request = {});

}  // namespace floe::mesh
