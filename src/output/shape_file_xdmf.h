#pragma once
#include <string>
#include <vector>

#include "floe/output/shape_file.h"

namespace floe::output {

/// Where a field's displacements or rotations stand in the HDF5 file.
std::string field_dataset(const ShapeGrid& grid, std::size_t field, bool rotation);

/// The XDMF file over an HDF5 file. @param sizes  numbers in the topology of each grid
std::string xdmf_text(const std::vector<ShapeGrid>& grids, const std::vector<std::int64_t>& sizes,
                      const std::string& data);

}  // namespace floe::output
