#include <algorithm>
#include <cmath>

#include "nas_reading.h"

namespace floe::mesh {
namespace {

constexpr double degree = M_PI / 180;

/// Components in the frame's Cartesian axes.
Eigen::Vector3d cartesian(char kind, const Eigen::Vector3d& x) {
  if (kind == 'C') return {x[0] * std::cos(x[1] * degree), x[0] * std::sin(x[1] * degree), x[2]};
  if (kind == 'S') {
    const double radius = x[0] * std::sin(x[1] * degree);
    return {radius * std::cos(x[2] * degree), radius * std::sin(x[2] * degree), x[0] * std::cos(x[1] * degree)};
  }
  return x;
}

}  // namespace

NasFrames::NasFrames(const NasModel& model, Faults& faults) : model_(model), faults_(faults) {
  frames_[0] = {};
  if (const auto found = model.defaults.find("GRDSET"); found != model.defaults.end()) {
    NasFields fields(found->second, faults);
    default_cp_ = fields.integer(1, "axes (CP)", 0);
    default_cd_ = fields.integer(5, "axes (CD)", 0);
    default_constrained_ = NasGrid::are_constrained(fields.card.text(6));
  }
  grids_.reserve(model.grids.size());
  for (std::size_t i = 0; i < model.grids.size(); ++i) grids_.emplace(model.grids[i].id, i);
}

const NasGrid* NasFrames::grid(long long id) const {
  const auto found = grids_.find(id);
  return found == grids_.end() ? nullptr : &model_.grids[found->second];
}

Eigen::Vector3d NasFrames::point(long long axes, const Eigen::Vector3d& x, Where where) {
  const Frame& in = frame(axes, where);
  return in.origin + in.axes * cartesian(in.kind, x);
}

Eigen::Vector3d NasFrames::position_of(const NasGrid& grid) {
  return point(grid.cp < 0 ? default_cp_ : grid.cp, grid.x, grid.where);
}

std::optional<Eigen::Vector3d> NasFrames::position(long long id, Where where) {
  if (const NasGrid* found = grid(id)) return position_of(*found);
  faults_.add(where, "this card names grid " + std::to_string(id) + ", which is not defined");
  return std::nullopt;
}

Eigen::Matrix3d NasFrames::directions(long long axes, const Eigen::Vector3d& at, Where where) {
  const Frame& in = frame(axes, where);
  if (in.kind == 'R') return in.axes;
  const Eigen::Vector3d local = in.axes.transpose() * (at - in.origin);
  const double radius = std::hypot(local[0], local[1]);
  const double c = radius > 0 ? local[0] / radius : 1, s = radius > 0 ? local[1] / radius : 0;
  Eigen::Matrix3d own;
  if (in.kind == 'C') {
    own << c, -s, 0, s, c, 0, 0, 0, 1;
  } else {
    const double whole = local.norm(), sine = whole > 0 ? radius / whole : 0, cosine = whole > 0 ? local[2] / whole : 1;
    own << sine * c, cosine * c, -s, sine * s, cosine * s, c, cosine, -sine, 0;
  }
  return in.axes * own;
}

const NasFrames::Frame& NasFrames::frame(long long id, Where where) {
  if (const auto known = frames_.find(id); known != frames_.end()) return known->second;
  const auto given = model_.axes.find(id);
  if (given == model_.axes.end()) {
    faults_.add(where, "there are no axes " + std::to_string(id) + " (CORD1R, CORD1C, CORD1S, CORD2R, CORD2C, CORD2S)");
    return frames_[0];
  }
  const NasAxes& axes = given->second;
  if (std::find(at_work_.begin(), at_work_.end(), id) != at_work_.end()) {
    faults_.add(axes.where, "axes " + std::to_string(id) + " depend on themselves");
    return frames_[0];
  }
  constexpr std::size_t deepest = 1000;
  if (at_work_.size() > deepest) {
    faults_.add(axes.where, "axes refer to others more than " + std::to_string(deepest) + " deep");
    return frames_[0];
  }
  at_work_.push_back(id);
  std::array<Eigen::Vector3d, 3> p;
  for (int i = 0; i < 3; ++i)
    p[i] = axes.reference >= 0 ? point(axes.reference, axes.points[i], axes.where)
                               : position(axes.grids[i], axes.where).value_or(Eigen::Vector3d::Unit(i));
  at_work_.pop_back();
  Frame frame;
  frame.kind = axes.kind;
  frame.origin = p[0];
  const Eigen::Vector3d z = p[1] - p[0], x = p[2] - p[0], y = z.cross(x);
  constexpr double least = 1e-12;
  if (!(y.norm() > least * z.norm() * x.norm()) || !y.allFinite())
    faults_.add(axes.where, "the points of axes " + std::to_string(id) + " lie on one line");
  else
    frame.axes << y.cross(z).normalized(), y.normalized(), z.normalized();
  return frames_[id] = frame;
}

}  // namespace floe::mesh
