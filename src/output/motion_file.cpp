#include "floe/output/motion_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "floe/output/claim.h"
#include "floe/petsc/error.h"
#include "motion_source.h"
#include "xdmf.h"

namespace floe::output {
namespace {

/// Rows nearest to instants at equal distances, each once; the first and the last among them. Of a path of equilibria,
/// where t also falls: at equal distances in their numbers.
std::vector<std::size_t> chosen_rows(const std::vector<double>& times, int frames) {
  std::vector<std::size_t> rows;
  if (frames <= 0 || frames >= std::ssize(times)) {
    for (std::size_t i = 0; i < times.size(); ++i) rows.push_back(i);
    return rows;
  }
  if (!std::is_sorted(times.begin(), times.end())) {
    for (int f = 0; f < frames; ++f) rows.push_back(f * (times.size() - 1) / std::max(1, frames - 1));
    return rows;
  }
  for (int f = 0; f < frames; ++f) {
    const double t = times.front() + (times.back() - times.front()) * f / std::max(1, frames - 1);
    const auto after = std::lower_bound(times.begin(), times.end(), t);
    std::size_t row = std::min<std::size_t>(after - times.begin(), times.size() - 1);
    if (row > 0 && t - times[row - 1] < times[row] - t) --row;
    if (rows.empty() || row != rows.back()) rows.push_back(row);
  }
  return rows;
}

/// Times that ParaView can order: of a path of equilibria the numbers of the frames instead of t.
std::vector<double> ascending(std::vector<double> times) {
  if (!std::is_sorted(times.begin(), times.end())) std::iota(times.begin(), times.end(), 0.);
  return times;
}

std::string dataset(const MovingBody& body, std::size_t frame, const char* what) {
  return fmt::format("{}/frame_{}/{}", body.name, frame + 1, what);
}

std::vector<double> numbers(const Eigen::Matrix3Xd& vectors) {
  return {vectors.data(), vectors.data() + vectors.size()};
}

/// @return  how many numbers the topology has
std::int64_t write_cells(MPI_Comm comm, hid_t file, const MotionSource& source, const MovingBody& body) {
  std::int64_t first = 0;
  Integers cells;
  petsc::agree(comm, [&] { cells = source.cells(body, first); });
  const Integers topology = mixed_topology(cells);
  const std::int64_t size = sum(comm, std::ssize(topology));
  write_shared(comm, file, body.name + "/part", {hsize_t(body.cells)}, first, columns_of(cells, 4, 1), {});
  write_shared(comm, file, body.name + "/cells", {hsize_t(size)}, sum_before(comm, std::ssize(topology)), topology,
               {"", "mixed topology of XDMF: kind, count of points and lines, nodes from 0"});
  return size;
}

void write_frame(MPI_Comm comm, hid_t file, const MovingBody& body, std::size_t frame, const MovedNodes& at) {
  const Extent shape{hsize_t(body.nodes), 3};
  write_shared(comm, file, dataset(body, frame, "positions"), shape, body.first, numbers(at.x), {"m", ""});
  write_shared(comm, file, dataset(body, frame, "deformation"), shape, body.first, numbers(at.deformation),
               {"m", "in world axes, not enlarged"});
}

/// Some of the columns of rows of `width` numbers.
std::vector<double> part_of(const std::vector<double>& rows, int width, int from, int count) {
  std::vector<double> part;
  for (std::size_t row = 0; row < rows.size(); row += static_cast<std::size_t>(width))
    part.insert(part.end(), rows.begin() + static_cast<std::ptrdiff_t>(row) + from,
                rows.begin() + static_cast<std::ptrdiff_t>(row) + from + count);
  return part;
}

int width_of(const std::vector<CellField>& fields) {
  int width = 0;
  for (const CellField& field : fields) width += field.width;
  return width;
}

/// @param group  NAME/ or NAME/frame_I/
void write_fields(MPI_Comm comm, hid_t file, const MovingBody& body, const std::string& group,
                  const std::vector<CellField>& fields, const CellRows& order, const std::vector<double>& values) {
  const int width = width_of(fields);
  if (width == 0) return;
  const std::vector<double> rows = order.in_order(values, width);
  int from = 0;
  for (const CellField& field : fields) {
    Extent shape{hsize_t(body.cells)};
    if (field.width > 1) shape.push_back(hsize_t(field.width));
    write_shared(comm, file, group + field.name, shape, order.first(), part_of(rows, width, from, field.width),
                 {field.unit, field.description});
    from += field.width;
  }
}

std::string fields_text(const MovingBody& body, const std::string& group, const std::vector<CellField>& fields,
                        const std::string& data) {
  std::string text;
  for (const CellField& field : fields)
    text += xdmf_attribute(
        field.name, field.width > 1 ? "Vector" : "Scalar", "Cell",
        xdmf_item(field.width > 1 ? fmt::format("{} {}", body.cells, field.width) : fmt::format("{}", body.cells),
                  false, data, group + field.name));
  return text;
}

std::string grid_text(const MovingBody& body, std::size_t frame, double t, std::int64_t size, const CellFields* fields,
                      const std::string& data) {
  return fmt::format("      <Grid Name=\"{}\" GridType=\"Uniform\">\n      <Time Value=\"{}\"/>\n", escaped(body.name),
                     t) +
         xdmf_mesh(body.cells, body.name + "/cells", size, body.nodes, dataset(body, frame, "positions"), data) +
         xdmf_attribute("part", "Scalar", "Cell",
                        xdmf_item(fmt::format("{}", body.cells), true, data, body.name + "/part")) +
         xdmf_attribute("deformation", "Vector", "Node",
                        xdmf_item(fmt::format("{} 3", body.nodes), false, data, dataset(body, frame, "deformation"))) +
         (fields ? fields_text(body, body.name + "/", fields->constants, data) +
                       fields_text(body, dataset(body, frame, ""), fields->fields, data)
                 : std::string()) +
         "      </Grid>\n";
}

const CellFields* fields_of(const MotionRequest& request, const MovingBody& body) {
  if (!request.cells) return nullptr;
  const auto found = request.cells->find(body.name);
  return found == request.cells->end() ? nullptr : &found->second;
}

/// A collection over time for each body: readers then call it the same at all times.
std::string text_of(const std::vector<MovingBody>& bodies, const std::vector<double>& times,
                    const std::vector<std::int64_t>& sizes, const MotionRequest& request, const std::string& data) {
  std::string text;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    text += fmt::format("    <Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
                        escaped(bodies[b].name));
    for (std::size_t f = 0; f < times.size(); ++f)
      text += grid_text(bodies[b], f, times[f], sizes[b], fields_of(request, bodies[b]), data);
    text += "    </Grid>\n";
  }
  return xdmf_document(text);
}

}  // namespace

MotionWritten write_motion(MPI_Comm comm, const MotionRequest& request) {
  const XdmfPair pair{request.xdmf, request.what, "floe " + request.what};
  std::optional<MotionSource> source;
  petsc::agree(comm, [&] { source.emplace(comm, request.results); });
  const Claim claim = claim_file(comm, pair.xdmf);
  check_pair(comm, pair, request.overwrite);
  const std::vector<std::size_t> rows =
      request.rows.empty() ? chosen_rows(source->times(), request.frames) : request.rows;
  MotionWritten written;
  written.without = source->without();
  std::vector<MovingBody> bodies;
  for (const MovingBody& body : source->bodies())
    if (!request.cells || fields_of(request, body)) bodies.push_back(body);
  for (const std::size_t row : rows) written.t.push_back(source->times()[row]);
  std::uint64_t bytes = 0;
  for (const MovingBody& body : bodies) {
    written.bodies.push_back(body.name);
    written.nodes += body.nodes, written.cells += body.cells;
    bytes += 8 * (7 * body.cells + 6 * body.nodes * rows.size()) + 4096 * (2 + 2 * rows.size());
    if (const CellFields* fields = fields_of(request, body))
      bytes += 8 * body.cells * (width_of(fields->constants) + width_of(fields->fields) * rows.size()) +
               4096 * (fields->constants.size() + fields->fields.size() * rows.size());
  }
  std::vector<std::int64_t> sizes;
  write_pair(
      comm, pair, bytes,
      [&](hid_t file) {
        std::vector<std::optional<CellRows>> orders(bodies.size());
        for (std::size_t b = 0; b < bodies.size(); ++b) {
          sizes.push_back(write_cells(comm, file, *source, bodies[b]));
          const CellFields* fields = fields_of(request, bodies[b]);
          if (!fields) continue;
          orders[b].emplace(comm, bodies[b].nodes, bodies[b].cells, fields->cells);
          write_fields(comm, file, bodies[b], bodies[b].name + "/", fields->constants, *orders[b],
                       fields->constant_values);
        }
        for (std::size_t f = 0; f < rows.size(); ++f) {
          MotionRow row;
          petsc::agree(comm, [&] { row = source->row(rows[f]); });
          for (std::size_t b = 0; b < bodies.size(); ++b) {
            write_frame(comm, file, bodies[b], f, moved(bodies[b], row, request.amplify));
            if (const CellFields* fields = fields_of(request, bodies[b]))
              write_fields(comm, file, bodies[b], dataset(bodies[b], f, ""), fields->fields, *orders[b],
                           fields->values(f));
          }
        }
      },
      [&] { return text_of(bodies, ascending(written.t), sizes, request, pair.data().filename().string()); });
  return written;
}

}  // namespace floe::output
