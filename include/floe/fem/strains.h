#pragma once

namespace floe::fem {

/// Which terms of second order the strains of a body's elements have; every one is quadratic in the nodal unknowns.
///
///   von_karman    squares of the slopes across the element in its membrane strain; curvatures and twist are linear
///   second_order  all terms of second order, so that a rigid rotation by a costs energy of order a^6
enum class Strains { von_karman, second_order };

}  // namespace floe::fem
