#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>

#include "floe/error.h"
#include "floe/fem/shell.h"
#include "floe/plan/prepare_spatial_joints.h"
#include "floe/reference/facet_pressure.h"
#include "floe/scene/joint_events.h"
#include "floe/scene/sensors.h"
#include "spatial_assembly.h"

namespace floe::assembly {

using dynamics::SpatialMarker;
using Eigen::Vector3d;

using Pieces = std::vector<std::vector<PetscInt>>;

namespace {

bool leads(const AveragingWeight& weight) { return weight.share != 0; }

/// a of an averaging weight's arm, which maps theta to theta x a in the plane of a shell.
Vector3d arm_of(const AveragingWeight& weight) { return {-weight.arm(2, 1), -weight.arm(0, 2), -weight.arm(1, 0)}; }

/// The same normal to the shell: arms of displacements in its plane are those of quadratic functions (drilling
/// rotations), of deflections those of cubic ones, which are smaller.
Vector3d deflection_arm(const AveragingWeight& weight) {
  const Eigen::Matrix3d odd = (weight.arm - weight.arm.transpose()) / 2;
  const Vector3d along(-odd(2, 1), -odd(0, 2), -odd(1, 0));
  if (along.norm() <= 1e-14 * weight.arm.norm() || along.norm() == 0) return Vector3d::Zero();
  const Vector3d sizes = Eigen::JacobiSVD<Eigen::Matrix3d>(weight.arm).singularValues();
  return (sizes[1] > 1e-9 * sizes[0] ? sizes[1] : sizes[0]) * along.normalized();
}

bool in(const std::vector<PetscInt>& piece, const Anchor& place) {
  return std::all_of(place.averaging_weights.begin(), place.averaging_weights.end(),
                     [&](const AveragingWeight& weight) {
                       return !leads(weight) || std::binary_search(piece.begin(), piece.end(), weight.node);
                     });
}

/// Whether the place is the mean of nodes that move by themselves.
bool is_mean(const Anchor& place, const Pieces& pieces) {
  return place.nodes.size() > 1 && !place.line &&
         std::count_if(place.averaging_weights.begin(), place.averaging_weights.end(), leads) > 1 &&
         std::none_of(pieces.begin(), pieces.end(), [&](const auto& piece) { return in(piece, place); });
}

}  // namespace

/// Edges that joints clamp to what does not deform; those with nodes in common are one piece.
std::vector<std::vector<PetscInt>> SpatialAssembly::clamped_edges(int b) const {
  Pieces pieces;
  for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
    const Anchor* place = constrained_place(plan_, j);
    const Joint& joint = plan_.scene.joints[j];
    if (!place || place->body != b || !plan_.joint_constrained[j] || !clamps(joint)) continue;
    if (is_unlocked(plan_.scene, joint.name)) continue;  // its edge deforms when it is free
    if (place->nodes.size() < 2 ||
        std::count_if(place->averaging_weights.begin(), place->averaging_weights.end(), leads) < 2)
      continue;
    std::vector<PetscInt> piece;
    for (const AveragingWeight& weight : place->averaging_weights)
      if (leads(weight)) piece.push_back(weight.node);
    std::sort(piece.begin(), piece.end());
    for (std::size_t p = 0; p < pieces.size();) {
      std::vector<PetscInt> both;
      std::set_union(piece.begin(), piece.end(), pieces[p].begin(), pieces[p].end(), std::back_inserter(both));
      if (both.size() == piece.size() + pieces[p].size()) {
        ++p;
        continue;
      }
      piece = std::move(both);
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(p));
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

bool SpatialAssembly::is_corotated_mean(const Anchor& place) const {
  return formulation_ == Formulation::cfr && place.body >= 0 && corotated(place.body) &&
         is_mean(place, clamped_edges(place.body));
}

namespace {

/// Quantities of a place that are means of those of its nodes.
bool is_linear(Probe::Quantity quantity) {
  return quantity == Probe::Quantity::position || quantity == Probe::Quantity::displacement ||
         quantity == Probe::Quantity::velocity || quantity == Probe::Quantity::acceleration;
}

/// Whether a formula of a load or of a probe names the probe.
bool is_in_formula(const Scene& scene, int probe) {
  const auto names = [&](const math::Formula& formula) {
    const auto& all = formula.variables();
    return std::any_of(all.begin() + (all.empty() ? 0 : 1), all.end(),
                       [&](const std::string& name) { return scene::sensor_of(scene, name).probe == probe; });
  };
  const auto of_load = [&](const Load& load) {
    return names(load.on_joint) || (load.has_sensors() && (std::any_of(load.force.begin(), load.force.end(), names) ||
                                                           std::any_of(load.moment.begin(), load.moment.end(), names)));
  };
  return std::any_of(scene.loads.begin(), scene.loads.end(), of_load) ||
         std::any_of(scene.probes.begin(), scene.probes.end(),
                     [&](const Probe& one) { return one.quantity == Probe::Quantity::formula && names(one.formula); });
}

}  // namespace

void SpatialAssembly::refuse_corotated(std::vector<std::string>& faults) const {
  if (formulation_ != Formulation::cfr) return;
  std::vector<Pieces> pieces;
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    const int index = static_cast<int>(b);
    pieces.push_back(corotated(index) ? clamped_edges(index) : Pieces{});
  }
  const auto mean = [&](const Anchor& place) {
    return place.body >= 0 && corotated(place.body) && is_mean(place, pieces[place.body]);
  };
  for (std::size_t j = 0; j < plan_.joints.size(); ++j)
    for (const Anchor& place : plan_.joints[j]) {
      const bool supports =
          place.body >= 0 && corotated(place.body) && plan_.scene.joints[j].kind == Joint::Kind::support;
      if (!supports && !mean(place)) continue;
      const std::string where = plan_.scene.joints[j].where.text();
      faults.push_back(
          supports ? where +
                         ": type support, which formulation cfr does not support; expected another "
                         "formulation, or joints of type fixed at single nodes or clamped edges"
                   : fmt::format("{}: constrains the mean displacement of {} nodes of body {}, which formulation "
                                 "cfr does not support; expected edges: rigid or line, or a place of one node",
                                 where, place.nodes.size(), plan_.bodies[place.body].spec.name));
      break;
    }
  for (std::size_t l = 0; l < plan_.loads.size(); ++l) {
    const Load& load = plan_.scene.loads[l];
    const Anchor& place = plan_.loads[l];
    if (place.body < 0 || !corotated(place.body)) continue;
    if (load.axes == Load::Axes::body && load.kind != Load::Kind::pressure)
      faults.push_back(load.where.text() +
                       ": axes: body rotate with the floating frame, which formulation cfr does not "
                       "have; expected axes: world or place");
    if (load.axes == Load::Axes::place && mean(place))
      faults.push_back(
          load.where.text() +
          ": axes: place of several nodes, which formulation cfr does not support; expected axes: world, or "
          "a place of one node");
  }
  for (std::size_t p = 0; p < plan_.probes.size(); ++p) {
    const Probe& probe = plan_.scene.probes[p];
    const auto& [place, other] = plan_.probes[p];
    const bool deflection = place.body >= 0 && corotated(place.body) && probe.quantity == Probe::Quantity::deflection;
    if (deflection && places_of_frame(p).empty())
      faults.push_back(
          probe.where.text() +
          ": deflection is from a mean-axis frame, which formulation cfr does not support in space; expected a "
          "clamped or pinned frame, or displacement with relative_to a place that represents the frame");
    else if (mean(other) ||
             (mean(place) && (!is_linear(probe.quantity) || is_in_formula(plan_.scene, static_cast<int>(p)))))
      faults.push_back(
          probe.where.text() +
          ": formulation cfr records only the position, displacement, velocity and acceleration of the mean of several "
          "nodes, and not in formulas; expected one of these, or a place of one node");
  }
}

void SpatialAssembly::add_corotated(int b) {
  const PlannedBody& body = plan_.bodies[b];
  coordinates_.belongs_to("body " + body.spec.name);
  slots_[b].corotated = std::make_unique<reference::CorotationalBody>(
      coordinates_, body.structure, visited(b), clamped_edges(b),
      reference::CorotationalStart{body.place, body.attitude, body.rate, body.spin, body.deformation,
                                   body.deformation_rate});
}

std::vector<std::pair<SpatialMarker, double>> SpatialAssembly::corotated_parts(const Anchor& place,
                                                                               bool deflection) const {
  const reference::CorotationalBody& body = *slots_[place.body].corotated;
  if (place.nodes.size() == 1 && body.has_frame(place.nodes.front())) return {{body.place(place.nodes.front()), 1.}};
  std::vector<std::pair<SpatialMarker, double>> parts;
  int piece = -1;
  bool one = place.nodes.size() > 1;
  for (const AveragingWeight& weight : place.averaging_weights) {
    if (!leads(weight)) continue;
    const int other = body.piece_of(weight.node);
    one = one && other >= 0 && (parts.empty() || other == piece);
    piece = other;
    SpatialMarker at = body.place(weight.node);
    at.mass = weight.share;
    at.x0 = weight.share * at.x0 + (deflection ? deflection_arm(weight) : arm_of(weight));
    parts.emplace_back(std::move(at), weight.share);
  }
  if (one) return {{body.place_on_piece(piece, place.x), 1.}};
  return parts;
}

void SpatialAssembly::add_corotated_pressure(const Load& load, int b, const fem::Mesh::Cell& cell) {
  const PlannedBody& body = plan_.bodies[b];
  const std::vector<SpatialMarker> places = slots_[b].corotated->places(cell);
  const auto X = [&](int corner) { return body.structure.mesh.positions[cell.place[corner]]; };
  const auto add = [&](const std::array<int, 3>& at, double share) {
    const Vector3d area = 0.5 * (body.attitude * (X(at[1]) - X(at[0])).cross(X(at[2]) - X(at[0])));
    terms_.push_back(std::make_unique<reference::FacetPressure>(
        std::vector<SpatialMarker>{places[at[0]], places[at[1]], places[at[2]]},
        [p = load.pressure](double t) { return p(t); }, share, load.follower ? nullptr : &area));
  };
  if (cell.kind == fem::CellKind::triangle) return add({0, 1, 2}, 1);
  if (mesh::is_quadratic(cell.kind)) {  // facets between the nodes
    const int n = static_cast<int>(cell.corners().size());
    for (int i = 0; i < n; ++i) add({i, n + i, n + (i + n - 1) % n}, 1);
    if (n == 3) return add({3, 4, 5}, 1);
    for (const auto& sides : fem::quadrilateral_triangles) add({n + sides[0], n + sides[1], n + sides[2]}, 0.5);
    return;
  }
  for (const auto& corners : fem::quadrilateral_triangles) add(corners, 0.5);
}

}  // namespace floe::assembly
