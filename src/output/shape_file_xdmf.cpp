#include "shape_file_xdmf.h"

#include <fmt/format.h>

#include "replaceable.h"

namespace floe::output {
namespace {

/// As text within XML, also within quotation marks.
std::string escaped(const std::string& text) {
  std::string all;
  for (const char c : text) {
    if (c == '&')
      all += "&amp;";
    else if (c == '<')
      all += "&lt;";
    else if (c == '>')
      all += "&gt;";
    else if (c == '"')
      all += "&quot;";
    else
      all += c;
  }
  return all;
}

std::string item(const std::string& dimensions, bool integers, const std::string& data, const std::string& dataset) {
  return fmt::format("<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"8\" Format=\"HDF\">{}:/{}</DataItem>",
                     dimensions, integers ? "Int" : "Float", escaped(data), escaped(dataset));
}

std::string grid_text(const ShapeGrid& grid, std::int64_t size, const std::string& data) {
  const std::string vectors = fmt::format("{} 3", grid.nodes);
  std::string text = fmt::format("    <Grid Name=\"{}\" GridType=\"Uniform\">\n", escaped(grid.name));
  text +=
      fmt::format("      <Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\">\n        {}\n      </Topology>\n",
                  grid.cells, item(fmt::format("{}", size), true, data, grid.name + "/cells"));
  text += fmt::format("      <Geometry GeometryType=\"XYZ\">\n        {}\n      </Geometry>\n",
                      item(vectors, false, data, grid.name + "/positions"));
  const auto attribute = [&](const std::string& name, const char* type, const char* centre, const std::string& values) {
    text += fmt::format(
        "      <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n        {}\n      </Attribute>\n",
        escaped(name), type, centre, values);
  };
  attribute("part", "Scalar", "Cell", item(fmt::format("{}", grid.cells), true, data, grid.name + "/part"));
  for (std::size_t f = 0; f < grid.fields.size(); ++f) {
    attribute(grid.fields[f], "Vector", "Node", item(vectors, false, data, field_dataset(grid, f, false)));
    attribute(grid.fields[f] + ", rotation", "Vector", "Node",
              item(vectors, false, data, field_dataset(grid, f, true)));
  }
  return text + "    </Grid>\n";
}

}  // namespace

std::string field_dataset(const ShapeGrid& grid, std::size_t field, bool rotation) {
  return fmt::format("{}/field_{}/{}", grid.name, field + 1, rotation ? "rotation" : "displacement");
}

std::string xdmf_text(const std::vector<ShapeGrid>& grids, const std::vector<std::int64_t>& sizes,
                      const std::string& data) {
  std::string text = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n  ";
  text += xdmf_mark + "\n  <Domain>\n";
  for (std::size_t g = 0; g < grids.size(); ++g) text += grid_text(grids[g], sizes[g], data);
  return text + "  </Domain>\n</Xdmf>\n";
}

}  // namespace floe::output
