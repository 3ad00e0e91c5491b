#include <fmt/format.h>

#include <algorithm>

#include "floe/fem/shell.h"
#include "floe/plan/prepare_spatial_joints.h"
#include "floe/reference/facet_pressure.h"
#include "floe/scene/joint_events.h"
#include "spatial_assembly.h"

namespace floe::assembly {

using dynamics::SpatialMarker;
using Eigen::Vector3d;

using Pieces = std::vector<std::vector<PetscInt>>;

namespace {

bool leads(const AveragingWeight& weight) { return weight.share != 0; }

/// a of an averaging weight's arm, which maps theta to theta x a.
Vector3d arm_of(const AveragingWeight& weight) { return {-weight.arm(2, 1), -weight.arm(0, 2), -weight.arm(1, 0)}; }

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

void SpatialAssembly::refuse_corotated(std::vector<std::string>& faults) const {
  if (formulation_ != Formulation::cfr) return;
  std::vector<Pieces> pieces;
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    const int index = static_cast<int>(b);
    pieces.push_back(corotated(index) ? clamped_edges(index) : Pieces{});
    const DampingSpec& damping = plan_.bodies[b].spec.damping;
    if (corotated(index) && !damping.modal.empty())
      faults.push_back(damping.where.text() +
                       ": formulation cfr has no modal damping (modes are seen from a floating frame); expected "
                       "damping.mass or damping.stiffness, or another formulation");
  }
  const auto mean = [&](const Anchor& place) {
    return place.body >= 0 && corotated(place.body) && is_mean(place, pieces[place.body]);
  };
  for (std::size_t j = 0; j < plan_.joints.size(); ++j)
    for (const Anchor& place : plan_.joints[j])
      if (mean(place))
        faults.push_back(fmt::format(
            "{}: holds the mean of {} nodes of body {}, which formulation cfr does not know; expected edges: rigid or "
            "line, or a place of one node",
            plan_.scene.joints[j].where.text(), place.nodes.size(), plan_.bodies[place.body].spec.name));
  for (std::size_t l = 0; l < plan_.loads.size(); ++l) {
    const Load& load = plan_.scene.loads[l];
    const Anchor& place = plan_.loads[l];
    if (place.body < 0 || !corotated(place.body)) continue;
    if (load.axes == Load::Axes::body && load.kind != Load::Kind::pressure)
      faults.push_back(load.where.text() +
                       ": axes: body turn with the floating frame, which formulation cfr does not "
                       "have; expected axes: world or place");
    if (load.axes == Load::Axes::place && mean(place))
      faults.push_back(load.where.text() +
                       ": axes: place of several nodes, which formulation cfr does not know; expected axes: world, or "
                       "a place of one node");
  }
  for (std::size_t p = 0; p < plan_.probes.size(); ++p) {
    const Probe& probe = plan_.scene.probes[p];
    const auto& [place, other] = plan_.probes[p];
    if (place.body >= 0 && corotated(place.body) && probe.quantity == Probe::Quantity::deflection)
      faults.push_back(
          probe.where.text() +
          ": deflection is from the floating frame, which formulation cfr does not have in space; expected "
          "displacement, with relative_to a place that stands for the frame");
    for (const Anchor* at : {&place, &other})
      if (mean(*at))
        faults.push_back(
            probe.where.text() +
            ": looks at the mean of several nodes, which formulation cfr does not know; expected places of "
            "one node");
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

std::vector<std::pair<SpatialMarker, double>> SpatialAssembly::corotated_parts(const Anchor& place) const {
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
    at.x0 = weight.share * at.x0 + arm_of(weight);
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
