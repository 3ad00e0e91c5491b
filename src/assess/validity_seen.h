#pragma once
#include "floe/assess/validity.h"

namespace floe::assess {

/// Of one body over the motion.
struct Seen {
  double slope = 0, spin = 0;        // greatest
  double intra_deflection = 0;       // where the slope is greatest
  double bending = 0, membrane = 0;  // energies where membrane's is greatest
  double rate = 0, size = 0;         // sums of squares of deformations
};

/// Displacements in the floating frame; null where there are no columns, and of bodies from files, which have no nodes
/// to look at. Collective.
petsc::VecHandle deformation_of(const BodyReport& body, const solve::State& state);

/// Slopes against the floating frames of each body, of all its frames together (moderate_rotations.h).
void judge_slopes(const Model& model, const std::vector<const solve::State*>& states, const std::vector<Seen>& seen,
                  MPI_Comm comm, std::vector<OutOfRange>& out);
/// Loads, gravity, the ground's acceleration against the frequencies that are kept.
void judge_loads(const Scene& scene, const Model& model, std::vector<OutOfRange>& out);
/// The step against the fastest of what moves.
void judge_step(const Scene& scene, const Model& model, const std::vector<Seen>& seen, std::vector<OutOfRange>& out);

/// What the element's strains and inertia leave out at second order (fem::MissingStiffness), against the stiffness K of
/// the undeformed body, where its energy and its spin are greatest: |reduction::StiffnessChange::relative()|, limit 5 %
/// (2.5 % of a frequency). K stands as frame and ground hold the body. Collective. At most 48 solves with K, which is
/// factored first where no factor was kept.
void judge_missing(const Model& model, std::size_t b, const std::vector<const solve::State*>& states,
                   std::vector<OutOfRange>& out);

}  // namespace floe::assess
