#include "floe/output/node_motion.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "floe/math/rotation.h"
#include "motion_source.h"
#include "reduced_file_hdf5.h"

namespace floe::output {
namespace {

/// Rows of a matrix nodes x width of a dataset, by numbers. @param lead  index of the first extent of three; -1: of two
std::vector<double> rows_at(hid_t file, const std::string& name, std::int64_t lead,
                            std::span<const std::int64_t> rows) {
  const Extent shape = series_extent(file, name);
  const std::size_t first = lead < 0 ? 0 : 1;
  if (shape.size() != first + 2) fail(name, "rows of nodes", "another shape");
  Extent start(shape.size(), 0), count = shape;
  if (lead >= 0) start[0] = static_cast<hsize_t>(lead), count[0] = 1;
  const hsize_t width = shape[first + 1];
  std::int64_t low = 0, high = -1;  // what of the rows is read
  if (!rows.empty())
    low = *std::min_element(rows.begin(), rows.end()), high = *std::max_element(rows.begin(), rows.end());
  if (low < 0 || high >= static_cast<std::int64_t>(shape[first])) fail(name, "a row of each node", "fewer");
  start[first] = static_cast<hsize_t>(low), count[first] = static_cast<hsize_t>(high - low + 1);
  const std::vector<double> all = read_block<double>(file, name, shape, start, count);
  std::vector<double> some(rows.size() * width);
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(static_cast<hsize_t>(rows[i] - low) * width), width,
                some.begin() + static_cast<std::ptrdiff_t>(i * width));
  return some;
}

bool there(hid_t file, const std::string& name) { return !series_extent(file, name).empty(); }

}  // namespace

NodeMotion::NodeMotion(MPI_Comm comm, const std::filesystem::path& folder)
    : source_(std::make_unique<MotionSource>(comm, folder)) {}
NodeMotion::~NodeMotion() = default;

const std::vector<double>& NodeMotion::times() const { return source_->times(); }
std::string NodeMotion::scene_file() const { return source_->summary().at("scene").at("file"); }
std::string NodeMotion::scene_text() const { return read_text(source_->file(), "scene"); }
std::string NodeMotion::formulation() const { return source_->summary().at("formulation"); }

const MovingBody& NodeMotion::body_of(const std::string& name) const {
  for (const MovingBody& body : source_->bodies())
    if (body.name == name) return body;
  throw std::logic_error("no body " + name + " with a mesh");
}

bool NodeMotion::has(const std::string& name) const {
  return std::any_of(source_->bodies().begin(), source_->bodies().end(),
                     [&](const MovingBody& body) { return body.name == name; });
}

bool NodeMotion::reduced(const std::string& name) const { return body_of(name).elastic >= 0; }
std::int64_t NodeMotion::nodes(const std::string& name) const { return body_of(name).nodes; }

Eigen::Matrix3Xd NodeMotion::positions(const std::string& name, std::span<const std::int64_t> nodes) const {
  const std::vector<double> rows = rows_at(source_->file(), "bodies/" + name + "/shapes/positions", -1, nodes);
  return Eigen::Map<const Eigen::Matrix3Xd>(rows.data(), 3, static_cast<Eigen::Index>(nodes.size()));
}

bool NodeMotion::has_correction() const { return there(source_->file(), "estimate/deviation"); }

Eigen::MatrixXd NodeMotion::basis(const std::string& name, std::span<const std::int64_t> nodes, bool corrected) const {
  const MovingBody& body = body_of(name);
  const hid_t file = source_->file();
  const std::string own = "bodies/" + name + "/shapes/basis", more = "bodies/" + name + "/estimate_basis";
  const auto count = [&](const std::string& dataset) {
    const Extent extent = series_extent(file, dataset);
    return extent.empty() ? Eigen::Index{0} : static_cast<Eigen::Index>(extent[0]);
  };
  const Eigen::Index k = std::min<Eigen::Index>(count(own), body.coordinates), extra = corrected ? count(more) : 0;
  Eigen::MatrixXd fields(body.width * static_cast<Eigen::Index>(nodes.size()), k + extra);
  for (Eigen::Index j = 0; j < k + extra; ++j) {
    const std::vector<double> rows = rows_at(file, j < k ? own : more, j < k ? j : j - k, nodes);
    fields.col(j) = Eigen::Map<const Eigen::VectorXd>(rows.data(), fields.rows());
  }
  return fields;
}

Eigen::MatrixXd NodeMotion::coordinates(const std::string& name, std::span<const std::size_t> rows,
                                        bool corrected) const {
  const MovingBody& body = body_of(name);
  const hid_t file = source_->file();
  const Extent own = series_extent(file, "bodies/" + name + "/shapes/basis");
  const Eigen::Index k = std::min<Eigen::Index>(own.empty() ? 0 : static_cast<Eigen::Index>(own[0]), body.coordinates);
  const auto instants = static_cast<Eigen::Index>(rows.size());
  Eigen::Index extra = 0, first = 0;
  std::vector<double> t, d, at_start;
  Eigen::Index width = 0;
  if (corrected && there(file, "bodies/" + name + "/estimate_columns")) {
    const Extent more = series_extent(file, "bodies/" + name + "/estimate_basis");
    if (!more.empty()) extra = static_cast<Eigen::Index>(more[0]);
    first = std::lround(read_whole<double>(file, "bodies/" + name + "/estimate_columns", {1}).front());
    Extent shape = series_extent(file, "estimate/deviation");
    width = static_cast<Eigen::Index>(shape[1]);
    d = read_whole<double>(file, "estimate/deviation", shape);
    t = read_whole<double>(file, "estimate/t", {shape[0]});
    at_start.assign(shape[1], 0);
    if (there(file, "estimate/deviation_at_start"))
      at_start = read_whole<double>(file, "estimate/deviation_at_start", {shape[1]});
  }
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(k + extra, instants);
  for (Eigen::Index i = 0; i < instants; ++i) {
    const MotionRow row = source_->row(rows[static_cast<std::size_t>(i)]);
    all.col(i).head(k) = Eigen::Map<const Eigen::VectorXd>(row.U.data() + body.elastic, k);
    if (d.empty()) continue;
    const auto after = std::lower_bound(t.begin(), t.end(), row.t - 1e-12 * std::abs(row.t));
    const auto deviation = [&](std::ptrdiff_t at) -> Eigen::VectorXd {
      return Eigen::Map<const Eigen::VectorXd>((at < 0 ? at_start.data() : d.data() + at * width) + first, k + extra);
    };
    const std::ptrdiff_t next = std::min<std::ptrdiff_t>(after - t.begin(), std::ssize(t) - 1);
    const double before = next > 0 ? t[static_cast<std::size_t>(next - 1)] : source_->times().front();
    const double span = t[static_cast<std::size_t>(next)] - before,
                 share = span > 0 ? std::clamp((row.t - before) / span, 0., 1.) : 1;
    all.col(i) += share * deviation(next) + (1 - share) * deviation(next - 1);
  }
  return all;
}

Eigen::VectorXd NodeMotion::state(const std::string& name, std::span<const std::int64_t> nodes,
                                  std::size_t index) const {
  const MovingBody& body = body_of(name);
  const hid_t file = source_->file();
  const MotionRow row = source_->row(index);
  std::vector<double>& where = where_[name];
  if (where.size() != 4 * nodes.size()) where = rows_at(file, "bodies/" + name + "/nodes_of_motion", -1, nodes);
  const Eigen::Index w = body.width;
  Eigen::VectorXd u(w * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double* dofs = row.U.data() + std::lround(where[4 * i]);
    const Eigen::Vector3d arm(where[4 * i + 1], where[4 * i + 2], where[4 * i + 3]);
    auto own = u.segment(w * static_cast<Eigen::Index>(i), w);
    own = Eigen::Map<const Eigen::VectorXd>(dofs, w);
    if (w == 3) {
      own.head<2>() += dofs[2] * Eigen::Vector2d(-arm.y(), arm.x());
    } else {
      const Eigen::Vector3d theta = own.tail<3>();
      if (body.dofs_in_world)
        own.head<3>() += math::rotation(theta) * (body.axes * arm);
      else
        own.head<3>() += theta.cross(arm);
    }
  }
  if (const std::string spins = "bodies/" + name + "/spins_of_motion"; there(file, spins)) {
    Extent shape = series_extent(file, spins);
    const std::vector<double> all = read_whole<double>(file, spins, shape);
    for (hsize_t s = 0; s < shape[0]; ++s) {
      const double* of = all.data() + 5 * s;
      const Eigen::Vector3d axis(of[2], of[3], of[4]);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i] != std::lround(of[0])) continue;
        auto theta = u.segment<3>(w * static_cast<Eigen::Index>(i) + 3);
        theta += axis * (row.U[static_cast<std::size_t>(std::lround(of[1]))] - axis.dot(theta));
      }
    }
  }
  return u;
}

}  // namespace floe::output
