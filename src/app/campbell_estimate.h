#pragma once
#include "campbell.h"

namespace floe::app {

/// The scene on larger bases, as vm+md: half as many modes again with all their derivatives, as far as a body has no
/// more than `most_vectors` of these (one mode more at least). Nothing where no body has a mesh.
std::optional<scene::Scene> on_larger_bases(const scene::Scene& scene);
inline constexpr int most_vectors = 100;

/// Relative errors of the frequencies of a reduced model,
///
///   |omega - omega'| / omega',   omega' nearest of the model on larger bases (on_larger_bases) at the same speed,
///
/// each omega' used once, from the slowest on. Vibrations without an oscillation, and zero ones, have none.
std::vector<FrequencyError> frequency_errors(const CampbellPoint& point, const std::vector<solve::Vibration>& larger);

/// Sets the estimate of a reduced diagram: frequency errors at `speed`, the fastest steady rotation, by a model on
/// larger bases that comes there as the diagram does; or why there is none.
/// @param given, scene  what the user wrote, and with a probe of the hub. Collective.
void estimate_frequencies(const scene::Scene& given, const scene::Scene& scene, int modes, double speed, MPI_Comm comm,
                          CampbellDiagram& diagram);

}  // namespace floe::app
