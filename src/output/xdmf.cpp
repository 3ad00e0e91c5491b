#include "xdmf.h"

#include <fmt/format.h>

#include "floe/output/folder.h"
#include "floe/petsc/error.h"
#include "floe/petsc/rank.h"
#include "replaceable.h"
#include "reserve.h"
#include "writing.h"

namespace floe::output {
namespace fs = std::filesystem;
namespace {

void check_free(const fs::path& path, const std::string& what, bool overwrite, bool ours) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{} '{}': {}", what, path.string(), why));
  };
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) refuse("exists and is not a file");
  if (fs::exists(status) && !ours)
    refuse(fmt::format("exists and contains no {} written by floe; use another name", what));
  if (fs::exists(status) && !overwrite) refuse("exists; use another name, or replace it with --force");
  try {
    write_file_atomically(draft_of(path), "");
  } catch (const RunError& fault) {
    refuse(with_name(fault.what(), path));
  }
  fs::remove(draft_of(path), ignored);
}

}  // namespace

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

std::string xdmf_item(const std::string& dimensions, bool integers, const std::string& data,
                      const std::string& dataset) {
  return fmt::format("<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"8\" Format=\"HDF\">{}:/{}</DataItem>",
                     dimensions, integers ? "Int" : "Float", escaped(data), escaped(dataset));
}

std::string xdmf_attribute(const std::string& name, const char* type, const char* centre, const std::string& values) {
  return fmt::format(
      "      <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n        {}\n      </Attribute>\n",
      escaped(name), type, centre, values);
}

std::string xdmf_mesh(std::int64_t cells, const std::string& topology, std::int64_t size, std::int64_t nodes,
                      const std::string& positions, const std::string& data) {
  return fmt::format("      <Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\">\n        {}\n      </Topology>\n",
                     cells, xdmf_item(fmt::format("{}", size), true, data, topology)) +
         fmt::format("      <Geometry GeometryType=\"XYZ\">\n        {}\n      </Geometry>\n",
                     xdmf_item(fmt::format("{} 3", nodes), false, data, positions));
}

std::string xdmf_document(const std::string& grids) {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n  " + xdmf_mark + "\n  <Domain>\n" +
         grids + "  </Domain>\n</Xdmf>\n";
}

Integers mixed_topology(const Integers& cells) {
  using Kind = ReducedShapes::Kind;
  Integers all;
  for (auto cell = cells.begin(); cell != cells.end(); cell += cell_width) {
    const Kind kind = static_cast<Kind>(cell[cell_width - 1]);
    const int count = corners(kind);
    all.push_back(count == 1 ? 1 : count == 2 ? 2 : count == 3 ? 4 : 5);
    if (count <= 2) all.push_back(count);
    all.insert(all.end(), cell, cell + count);
  }
  return all;
}

fs::path XdmfPair::data() const { return fs::path(xdmf).replace_extension(".h5"); }

void check_pair(MPI_Comm comm, const XdmfPair& pair, bool overwrite) {
  petsc::agree(comm, [&] {
    if (petsc::rank_of(comm) != 0) return;
    if (pair.xdmf.extension() != ".xdmf" || pair.xdmf.stem().empty())
      throw InputError(fmt::format("{} '{}': expected a name that ends in .xdmf", pair.what, pair.xdmf.string()));
    check_free(pair.xdmf, pair.what, overwrite, is_own_xdmf(pair.xdmf));
    check_free(pair.data(), pair.what, overwrite, is_of_format(pair.data(), pair.format));
  });
}

void write_pair(MPI_Comm comm, const XdmfPair& pair, std::uint64_t bytes, const std::function<void(hid_t)>& write,
                const std::function<std::string()>& text) {
  const fs::path &xdmf = pair.xdmf, data = pair.data(), draft = draft_of(data);
  const bool first = petsc::rank_of(comm) == 0;
  const auto alone = [&](const fs::path& path, const auto& work) {
    petsc::agree(comm, [&] {
      if (first) writing(path, work);
    });
  };
  try {
    alone(data, [&] {
      open_file(draft, Open::create, MPI_COMM_NULL).close();
      reserve(draft, bytes);
    });
    writing(data, [&] {
      Hid file;
      petsc::agree(comm, [&] { file = open_file(draft, Open::change, comm); });
      petsc::agree(comm, [&] { write_attribute(file, "format", pair.format); });
      write(file);
      petsc::agree(comm, [&] { file.close(); });
    });
    alone(xdmf, [&] { fs::remove(xdmf); });
    alone(data, [&] { publish_draft(draft, data); });
    alone(xdmf, [&] { write_file_atomically(xdmf, text()); });
  } catch (const RunError& fault) {
    std::error_code ignored;
    if (first) fs::remove(draft, ignored);
    throw RunError(with_name(fault.what(), data));
  }
}

}  // namespace floe::output
