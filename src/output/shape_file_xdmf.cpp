#include "shape_file_xdmf.h"

#include <fmt/format.h>

#include "xdmf.h"

namespace floe::output {
namespace {

std::string grid_text(const ShapeGrid& grid, std::int64_t size, const std::string& data) {
  const std::string vectors = fmt::format("{} 3", grid.nodes);
  std::string text = fmt::format("    <Grid Name=\"{}\" GridType=\"Uniform\">\n", escaped(grid.name));
  text += xdmf_mesh(grid.cells, grid.name + "/cells", size, grid.nodes, grid.name + "/positions", data);
  text += xdmf_attribute("part", "Scalar", "Cell",
                         xdmf_item(fmt::format("{}", grid.cells), true, data, grid.name + "/part"));
  for (std::size_t f = 0; f < grid.fields.size(); ++f) {
    text += xdmf_attribute(grid.fields[f], "Vector", "Node",
                           xdmf_item(vectors, false, data, field_dataset(grid, f, false)));
    text += xdmf_attribute(grid.fields[f] + ", rotation", "Vector", "Node",
                           xdmf_item(vectors, false, data, field_dataset(grid, f, true)));
  }
  return text + "    </Grid>\n";
}

}  // namespace

std::string field_dataset(const ShapeGrid& grid, std::size_t field, bool rotation) {
  return fmt::format("{}/field_{}/{}", grid.name, field + 1, rotation ? "rotation" : "displacement");
}

std::string xdmf_text(const std::vector<ShapeGrid>& grids, const std::vector<std::int64_t>& sizes,
                      const std::string& data) {
  std::string text;
  for (std::size_t g = 0; g < grids.size(); ++g) text += grid_text(grids[g], sizes[g], data);
  return xdmf_document(text);
}

}  // namespace floe::output
