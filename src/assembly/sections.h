#pragma once
#include "floe/plan/beam_sides.h"
#include "floe/plan/prepare.h"
#include "floe/reduction/projection.h"

namespace floe::assembly {
using namespace plan;

/// A side of a section, and how much it counts in the mean.
struct ChosenSide {
  BeamSide side;
  double weight = 1;
};

/// The sides of the place of a probe of a section: the one towards a place, the only one, or both of a line.
/// @throws InputError  a place of several nodes, or without beams, or where more than two meet. Collective.
std::vector<ChosenSide> chosen_sides(const Plan& plan, std::size_t probe);

/// A part of a body that a section separates from the rest.
struct BodyPart {
  std::vector<char> cells;            ///< of this rank's: whether they belong to it
  std::vector<char> nodes;            ///< of all, global: whether they move it
  bool beyond = true;                 ///< it begins with the element of the side; false: it is the rest
  reduction::PartMasses masses = {};  ///< of a reduced body
  bool has(const Anchor& place) const;
};

/// The part whose equilibrium gives the forces in the section: the one with fewer joints, of which none is
/// undetermined.
/// @param undetermined  joints whose multipliers are not determined; on the last rank of `system`
/// @throws InputError  the section does not separate the body, or a joint connects both parts, or both have
/// undetermined joints. Collective.
BodyPart part_of(const Plan& plan, std::size_t probe, const BeamSide& side, const std::vector<int>& undetermined,
                 MPI_Comm system);

/// Words about damping that the forces in a section do not have; empty: all is there.
std::string without_damping(const Plan& plan, std::size_t probe);

}  // namespace floe::assembly
