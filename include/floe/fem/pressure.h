#pragma once
#include "floe/body/pressure.h"
#include "floe/fem/structure.h"

namespace floe::fem {

bool is_shell(const Mesh::Cell& cell);  ///< of either order

/// Unit pressure along the normal of a shell, on the element's dofs (Structure::cell_dofs). Consistent: N is the
/// displacement that the mass has. A quadrilateral is the mean of its two triangulated surfaces.
body::Pressure pressure(const Structure& structure, const Mesh::Cell& cell);

}  // namespace floe::fem
