#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "reduced_file_hdf5.h"
#include "reduced_file_image.h"

namespace floe::output {
namespace {

void check_pairs(const body::Elasticity& elasticity) {
  const auto& pairs = elasticity.pairs;
  const auto bad = std::adjacent_find(pairs.begin(), pairs.end(), [](auto left, auto right) { return left >= right; });
  if (bad == pairs.end()) return;
  fail("elasticity/pairs", "pairs in ascending order, each once",
       fmt::format("({}, {}) before ({}, {})", bad[0].first, bad[0].second, bad[1].first, bad[1].second));
}

void check_columns(const ReducedBodyFile& file) {
  int kept = 0;
  for (const auto& column : file.columns) {
    if (column.kind != "mode" && column.kind != "derivative" && column.kind != "attachment")
      fail("columns/kind", "mode, derivative or attachment", fmt::format("'{}'", column.kind));
    kept += column.kept;
  }
  if (kept != file.body.coordinates())
    fail("columns/kept", fmt::format("{} candidate vectors kept", file.body.coordinates()), fmt::format("{}", kept));
}

void check_places(const std::vector<ReducedPlace>& places) {
  std::set<std::string> names;
  for (const auto& place : places) {
    if (place.name.empty()) fail("places/names", "names", "an empty one");
    if (!names.insert(place.name).second)
      fail("places/names", "names that differ", fmt::format("'{}' twice", place.name));
  }
}

void check_frame(const ReducedFrame& frame) {
  constexpr double tolerance = 1e-9;
  const Eigen::Index d = frame.axes.rows();
  const double off = (frame.axes.transpose() * frame.axes - Eigen::MatrixXd::Identity(d, d)).cwiseAbs().maxCoeff();
  if (off > tolerance || frame.axes.determinant() < 0)
    fail("frame/axes", "a rotation", fmt::format("{:.1e} off, determinant {:.3g}", off, frame.axes.determinant()));
}

}  // namespace

void check_contents(const ReducedBodyFile& file) {
  if (!(file.body.inertia.m > 0)) fail("inertia/m", "a positive mass", fmt::format("{}", file.body.inertia.m));
  check_pairs(file.body.elasticity);
  check_columns(file);
  check_places(file.places);
  check_frame(file.frame);
}

}  // namespace floe::output
