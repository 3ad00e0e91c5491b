#pragma once
#include "floe/mesh/deck.h"

namespace floe::mesh {

/// Reads bulk data of Nastran: its mesh, sections, materials, point masses and rigid links.
///
/// Small, large and free field, tabs, continuations in order, INCLUDE, BEGIN BULK (what precedes it is left out with a
/// notice) and ENDDATA. Parts are named PSHELL3, PCOMP3, PBAR3, ... by the property's number, and there are places of
/// the same names, and SPC7 for the nodes of SPC and SPC1 of set 7. Elements of one property that differ in thickness,
/// ZOFFS, material axis or orientation vector are parts of the same name.
///   nodes     GRID with CP and CD, GRDSET, CORD1R/C/S, CORD2R/C/S
///   shells    CQUAD4, CQUADR, CTRIA3, CTRIAR: PSHELL (MID2 may differ), PCOMP, PCOMPG; ZOFFS, T1..T4 as their mean
///   beams     CBAR, CBEAM: PBAR, PBARL and PBEAML (BAR, BOX, I, ROD, TUBE, TUBE2), PBEAM without taper, I1 about the
///             z-axis of the element; offsets WA, WB are rigid links to nodes of their own; K1, K2 are shear factors;
///             pin flags are releases
///   rods      CROD, CTUBE, CONROD: beams released in bending, as PBAR without I1 and I2
///   springs   CELAS1, CELAS2, CBUSH between two grids, where no rigid motion strains them; others are left out
///   material  MAT1, MAT8, MAT2 (orthotropic in its own axes)
///   rest      CONM2, RBE2 of all six directions, RBAR with one independent end, PARAM,WTMASS
/// Nonstructural mass becomes density. Loads, supports, constraint equations, tables and output are left out, each card
/// with its number; elements of other kinds (solids, shear panels) are refused, or left out on request. RBE3 is a
/// place. Every rank reads the whole file and keeps its share.
/// @throws InputError  the same on every rank, one line a fault, with file, line, card and field: what was found and
///   what was expected; cards that are not known; taper
/// Collective.
/// Source: the published quick reference guides of MSC Nastran and NX Nastran, "Bulk data entries".
DeckFile read_nastran(MPI_Comm comm, const std::string& path, const DeckRequest& request = {});

/// Whether a path ends as files of Nastran do: .bdf, .nas, .dat.
bool is_nastran(const std::string& path);

}  // namespace floe::mesh
