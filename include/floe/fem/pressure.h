#pragma once
#include "floe/body/pressure.h"
#include "floe/fem/structure.h"

namespace floe::fem {

bool is_shell(const Mesh::Cell& cell);  ///< of either order

/// Shape functions at one of the points by which a shell's surface is integrated: weight X_r x X_s is the point's area
/// vector, X_r = sum dN(0, i) X_i and X_s = sum dN(1, i) X_i. Exact for area vectors.
struct SurfaceShape {
  double weight;
  Eigen::VectorXd N;    ///< of the cell's places
  Eigen::Matrix2Xd dN;  ///< d/dr, d/ds
};
/// A triangle has one point; a quadrilateral is the mean of its two triangulated surfaces.
std::vector<SurfaceShape> surface_shapes(mesh::CellKind kind);

/// Unit pressure along the normal of a shell, on the element's dofs (Structure::cell_dofs). Consistent: N is the
/// displacement that the mass has. A quadrilateral is the mean of its two triangulated surfaces.
body::Pressure pressure(const Structure& structure, const Mesh::Cell& cell);

}  // namespace floe::fem
