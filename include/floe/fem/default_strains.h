#pragma once
#include <string>
#include <vector>

#include "floe/fem/structure.h"

namespace floe::fem {

/// The strains that the geometry of a body in space calls for, and the numbers that decide.
///
/// Rotations in the plane of an element, and curvatures of a section that is rotated, matter where the surface is not
/// flat (boxes, tubes, curved blades: their walls bend in their planes), where it is a narrow strip (bending in its
/// plane is as soft as in rotating blades), and in beams (bending with torsion). A flat, wide shell has von Karman's
/// strains, which have fewer products and are faster by a factor of up to four in reduced models.
struct StrainsChoice {
  bool beams = false;
  double height = 0;  ///< extent of all nodes across their mean plane, over the thickness of the shells [-]
  double width = 1;   ///< standard deviations of the area in its mean plane, the smaller over the larger [-]

  static constexpr double greatest_height = 0.1, least_width = 0.25;
  Strains strains() const {
    const bool flat = height <= greatest_height && width >= least_width;
    return flat && !beams ? Strains::von_karman : Strains::second_order;
  }
  /// The strains and the number that decides: "second_order (width/length 0.1, limit 0.25)".
  std::string text() const;
};

/// Collective.
StrainsChoice default_strains(const Mesh& mesh, const std::vector<Section>& sections);

}  // namespace floe::fem
