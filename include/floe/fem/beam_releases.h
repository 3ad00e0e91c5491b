#pragma once
#include <bitset>

#include "floe/fem/spatial_beam_fixed.h"

namespace floe::fem {

/// Dofs of a beam's ends that it does not share with its nodes, in element axes: (u, v, w, rx, ry, rz) of the first
/// end, then of the second.
using BeamReleases = std::bitset<12>;

/// The dofs of a beam's ends from those of its nodes, q_e = T q: released ones a are where they carry no force,
/// q_a = -K_aa^+ K_ab q_b, of the linear stiffness; K_aa^+ is the pseudo-inverse, for what is released at both ends.
///
/// T keeps rigid motions, so that strains of second order and mass carry over by q_e = T q, too.
/// Source: Przemieniecki, Theory of matrix structural analysis, ch. 6.6 (static condensation).
/// @throws floe::InputError  as spatial_beam
Matrix12 released(const BeamPlace& place, const SpatialBeamSection& section, const BeamReleases& releases);

/// Stiffness of a rod whose ends are alone (at nodes that rods alone hold) against rotations of these nodes relative to
/// its line, and about it where its torsion is released: 1e-10 EA l per radian. Neither loads nor mass act on these
/// rotations: they follow the rods. Rigid motions have no energy.
Matrix12 rod_rotations(const BeamPlace& place, const SpatialBeamSection& section, const BeamReleases& releases,
                       std::bitset<2> alone);

}  // namespace floe::fem
