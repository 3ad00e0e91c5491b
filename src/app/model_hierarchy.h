#pragma once
#include "tradeoff.h"

namespace floe::app {

/// The scene with m modes and these derivatives in all its flexible bodies.
scene::Scene with_modes(const scene::Scene& scene, int m, scene::DerivativesSpec::Choice derivatives, int count = 0);

/// Members of the hierarchy with other floating frames, elements and strains, reduced.
void add_discretisations(const scene::Scene& scene, std::vector<Candidate>& members);
/// Full-order members: nlffr, lffr and cfr of the scene's mesh, and of other frames, elements and steps.
void add_full_order(const scene::Scene& scene, std::vector<Candidate>& members);

}  // namespace floe::app
