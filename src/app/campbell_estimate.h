#pragma once
#include "campbell.h"

namespace floe::app {

/// The scene on larger bases, as vm+md: twice as many modes with all their derivatives, as far as a body has no
/// more than `most_vectors` of these (one mode more at least). Nothing where no body has a mesh.
std::optional<scene::Scene> on_larger_bases(const scene::Scene& scene);
inline constexpr int most_vectors = 100;

/// Relative errors of the frequencies of a reduced model,
///
///   |omega - omega'| / omega',   omega' nearest of the better model at the same speed,
///
/// each omega' used once, from the slowest on. Vibrations without an oscillation, and zero ones, have none.
std::vector<FrequencyError> frequency_errors(const CampbellPoint& point, const std::vector<solve::Vibration>& better);

/// Sets the estimate of a reduced diagram: frequency errors at `speed`, the fastest steady rotation, by a better model
/// that comes there as the diagram does; or why there is none. It is the full-order model where that has vibrations (up
/// to solve::largest_rotating_system unknowns, no bodies from files), else one on larger bases (on_larger_bases).
/// Collective.
void estimate_frequencies(const scene::Scene& scene, int modes, double speed, MPI_Comm comm, CampbellDiagram& diagram);

}  // namespace floe::app
