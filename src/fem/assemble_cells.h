#pragma once
#include <functional>

#include "floe/fem/assembly.h"

namespace floe::fem {

using MatrixOfCell = std::function<Eigen::MatrixXd(const Mesh::Cell&)>;
using MatrixSink = std::function<void(const Mesh::Cell&, const Eigen::MatrixXd&)>;

/// Passes each cell's matrix to `add`, with empty rows and columns under the conditions.
/// @return  the greatest entry of all diagonals. Collective.
double for_each_matrix(const Structure& structure, const Conditions& conditions, const MatrixOfCell& matrix_of,
                       const MatrixSink& add);

/// The sum of what `matrix_of` gives for each cell, symmetric, on the dofs of its nodes; rows and columns under the
/// conditions are empty but for `diagonal` times the greatest entry of all diagonals. MATSBAIJ. Collective.
petsc::MatHandle assemble_cells(const Structure& structure, const Conditions& conditions, double diagonal,
                                const MatrixOfCell& matrix_of);

}  // namespace floe::fem
