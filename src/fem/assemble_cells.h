#pragma once
#include <functional>

#include "floe/fem/assembly.h"

namespace floe::fem {

/// The sum of what `matrix_of` gives for each cell, symmetric, on the dofs of its nodes; rows and columns under the
/// conditions are empty but for `diagonal` times the greatest entry of all diagonals. MATSBAIJ. Collective.
petsc::MatHandle assemble_cells(const Structure& structure, const Conditions& conditions, double diagonal,
                                const std::function<Eigen::MatrixXd(const Mesh::Cell&)>& matrix_of);

}  // namespace floe::fem
