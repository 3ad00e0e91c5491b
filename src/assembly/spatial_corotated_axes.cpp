#include <algorithm>

#include "floe/math/rotation.h"
#include "floe/petsc/error.h"
#include "floe/reduction/place_set.h"
#include "probe_sources.h"
#include "spatial_assembly.h"

// Axes among the unknowns of corotational bodies: those that accompany a whole body as its floating frame would, and
// those of places of several nodes.
namespace floe::assembly {

using dynamics::AccompanyingAxes;
using dynamics::MovingAxes;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using math::skew;
using petsc::check;

namespace {

MovingAxes axes_of(const dynamics::SpatialMarker& at) { return {at.coordinates[0], at.coordinates[3], at.attitude}; }

/// Of the same nodes.
bool same_weights(const Anchor& one, const Anchor& other) {
  if (!one.weights || !other.weights) return one.weights == other.weights;
  return std::equal(one.weights->begin(), one.weights->end(), other.weights->begin(), other.weights->end(),
                    [](const auto& a, const auto& b) { return a.node == b.node && a.weight == b.weight; });
}

}  // namespace

const SpatialAssembly::MeanAxes* SpatialAssembly::find_mean(const Anchor& place) const {
  const auto found = std::find_if(means_.begin(), means_.end(), [&](const MeanAxes& mean) {
    const Anchor& other = mean.place;
    return other.body == place.body && other.nodes == place.nodes && same_weights(other, place);
  });
  return found == means_.end() ? nullptr : &*found;
}

void SpatialAssembly::add_axes(WholeAxes& axes) {
  axes.f.position = coordinates_.add_shared(6), axes.f.rotation = axes.f.position + 3;
  axes.multipliers = coordinates_.add_shared(6, true);
  const auto attitude = std::make_shared<dynamics::Attitude>();
  axes.f.attitude = attitude;
  axes_attitudes_.emplace_back(axes.f.rotation, attitude);
}

void SpatialAssembly::add_corotated_axes() {
  if (formulation_ != Formulation::cfr) return;
  for (int b = 0; b < static_cast<int>(slots_.size()); ++b) {
    if (!corotated(b) || !needs_frame_axes(plan_, b, [&](std::size_t p) { return !places_of_frame(p).empty(); }))
      continue;
    coordinates_.belongs_to("axes of body " + plan_.bodies[b].spec.name);
    WholeAxes& axes = body_axes_.emplace(b, frame_axes(plan_, b)).first->second;
    add_axes(axes);
    axes_attitudes_.back().second->base = Eigen::Quaterniond(mesh_axes_at_start(plan_.bodies[b]).A).normalized();
  }
  const auto add = [&](const Anchor& place) {
    if (!is_corotated_mean(place) || find_mean(place)) return;
    coordinates_.belongs_to("a place of body " + plan_.bodies[place.body].spec.name);
    add_axes(means_.emplace_back(MeanAxes{place, {}}).axes);
    axes_attitudes_.back().second->base = Eigen::Quaterniond(plan_.bodies[place.body].attitude).normalized();
  };
  for (const auto& joint : plan_.joints)
    for (const Anchor& place : joint) add(place);
  for (std::size_t l = 0; l < plan_.loads.size(); ++l)
    if (const Load& load = plan_.scene.loads[l];
        (load.axes == Load::Axes::place || load.kind == Load::Kind::moment) && !load.spread())
      for (const LoadPart& part : parts_of_load(plan_, l)) add(part.at);
  for (std::size_t p = 0; p < plan_.probes.size(); ++p)
    if (has_place(plan_.scene.probes[p]))
      for (const Anchor& place : plan_.probes[p]) add(place);
}

std::vector<CarriedMass> SpatialAssembly::corotated_masses(int b) const {
  const PlannedBody& body = plan_.bodies[b];
  std::vector<CarriedMass> all;
  for (const auto& [at, inertia, x] : slots_[b].corotated->masses())
    all.push_back({axes_of(at), {}, inertia, body.origin + body.axes * x, body.axes});
  return all;
}

/// With A_f'A = exp(theta) of a node, X its place and x that of the mean, both undeformed in the axes of the body,
///
///   sum (share A_f'(R - R_f) + A_f'A lead + (arm + ~lead) theta) = 0,
///   sum (rotation theta + turn (A_f'(R - R_f) - (X - x))) = 0,
///
/// theta by the skew part of A_f'A: sums of small motions from f as the mean has them, and exact where nodes lead
/// others. On the last rank.
AxesTerms SpatialAssembly::rows_of_mean(const WholeAxes& mean, const Anchor& place) const {
  const reference::CorotationalBody& body = *slots_[place.body].corotated;
  AxesTerms terms;
  for (const AveragingWeight& weight : place.averaging_weights) {
    const Matrix3d rotation = body.of_rotation(weight.node, weight.rotation),
                   arm = body.of_rotation(weight.node, weight.arm) + skew(weight.lead);
    std::vector<AccompanyingAxes::Row> rows;
    for (int i = 0; i < 6; ++i) {
      const Vector3d e = Vector3d::Unit(i % 3), m = (i < 3 ? arm : rotation).transpose() * e;
      Matrix3d B = 0.5 * skew(m);
      if (i < 3) B += e * weight.lead.transpose();
      rows.push_back({i < 3 ? Vector3d(weight.share * e) : Vector3d(weight.turn.row(i - 3)), B.reshaped()});
    }
    terms.push_back(std::make_unique<AccompanyingAxes>(axes_of(body.place(weight.node)), std::vector<int>{}, mean.f,
                                                       mean.multipliers, std::move(rows)));
  }
  return terms;
}

void SpatialAssembly::set_shared(int first, const Eigen::VectorXd& values, Vec into) const {
  for (Eigen::Index i = 0; i < values.size() && owner_; ++i)
    check(VecSetValue(into, coordinates_.global()[first + static_cast<int>(i)], values[i], INSERT_VALUES));
  check(VecAssemblyBegin(into));
  check(VecAssemblyEnd(into));
}

/// Places the axes where their rows put them, with the velocity that these have.
void SpatialAssembly::start_axes(int body, const WholeAxes& axes, AxesTerms rows, Model& model) {
  const auto attitude = std::find_if(axes_attitudes_.begin(), axes_attitudes_.end(),
                                     [&](const auto& one) { return one.first == axes.f.rotation; });
  place_axes(axes, rows, "body " + plan_.bodies[body].spec.name, attitude->second.get(), start_, coordinates_.comm());
  set_shared(axes.f.position, start_.segment<6>(axes.f.position), model.U);
  const dynamics::System layout(coordinates_, {});
  Eigen::VectorXd v;
  layout.gather(model.V, v);
  set_shared(axes.f.position, rates_of(axes, rows, start_, v, coordinates_.comm()), model.V);
  for (auto& term : rows) terms_.push_back(std::move(term));
}

void SpatialAssembly::start_corotated_axes(Model& model) {
  for (const auto& [b, axes] : body_axes_)
    start_axes(b, axes,
               conditions(
                   axes, 6, [&](int body) { return corotated_masses(body); },
                   [&, &whole = axes](int body) { return constrained_places(whole, body); }),
               model);
  for (const auto& [place, axes] : means_)
    start_axes(place.body, axes, owner_ ? rows_of_mean(axes, place) : AxesTerms{}, model);
}

}  // namespace floe::assembly
