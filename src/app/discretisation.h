#pragma once
#include <vector>

#include "floe/scene/scene.h"

namespace floe::app {

/// What a choice for the total error changes of a body beside its reduced model.
struct Discretised {
  int frames = 1;
  int elements = 1;  ///< times as many as the scene has, along each edge; of imported meshes a power of 2
  std::optional<fem::Strains> strains = {};  ///< absent: as the scene has them
  bool operator==(const Discretised&) const = default;
};

/// Of each body; those that are rigid or reduced in files do not change.
using Discretisation = std::vector<Discretised>;

/// Whether it is one straight line or a plate, whose floating frame may be divided.
bool divisible(const scene::Body& body);

/// Elements of the flexible bodies with lines and plates.
double element_count(const scene::Scene& scene, const Discretisation& bodies);

/// Whether each of its pieces has two elements along it; the pieces of a line have equally many.
bool fits(const scene::Body& body, const Discretised& one);

Discretisation discretisation_of(const scene::Scene& scene);

/// The scene with other frames, elements and strains, as text and read again. A body in more frames has fewer modes in
/// each: count (old frames)/(new frames), at least two and one more where that is no whole number; derivatives and
/// columns that the scene lists are not among its words.
/// @throws InputError  the scene does not read that way
scene::Scene discretised(const scene::Scene& scene, const Discretisation& bodies);

}  // namespace floe::app
