#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "floe/math/nearest.h"
#include "floe/math/rotation.h"
#include "floe/mesh/exchange.h"
#include "floe/plan/place_weights.h"
#include "floe/plan/prepare_spatial.h"

namespace floe::plan {
namespace {

/// What moves the weighted mean of the nodes. Collective.
std::vector<AveragingWeight> averaging_weights(const fem::Mesh& mesh,
                                               const std::vector<reduction::WeightedNode>& nodes) {
  std::vector<PetscInt> sorted;
  for (const reduction::WeightedNode& at : nodes) sorted.push_back(at.node);
  std::sort(sorted.begin(), sorted.end());
  struct Carried {
    PetscInt node, independent_node;
    double arm[3], own[9];
  };
  std::vector<Carried> mine, copies;
  for (const fem::Mesh::DependentNode& f : mesh.dependent_nodes)
    if (std::binary_search(sorted.begin(), sorted.end(), mesh.global_node(f.node))) {
      const fem::Mesh::Spin* spin = spin_of(mesh, f.node);
      Carried& one = mine.emplace_back(Carried{mesh.global_node(f.node), mesh.global_node(f.independent_node), {}, {}});
      Eigen::Vector3d::Map(one.arm) = mesh.positions[f.node] - mesh.positions[f.independent_node];
      if (spin) Eigen::Matrix3d::Map(one.own) = spin->own();
    }
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  for (int r = 0; r < ranks; ++r) copies.insert(copies.end(), mine.begin(), mine.end());
  std::map<PetscInt, Carried> carried;
  for (const Carried& c :
       mesh::exchange(mesh.comm, copies, std::vector<int>(ranks, static_cast<int>(mine.size()))).values)
    carried.emplace(c.node, c);
  std::vector<AveragingWeight> all;
  std::map<PetscInt, std::size_t> place;
  const auto weight = [&](PetscInt node) -> AveragingWeight& {
    const auto [at, fresh] = place.emplace(node, all.size());
    if (fresh) all.push_back({node, 0, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()});
    return all[at->second];
  };
  for (const auto& [node, share, arm, turn, twist] : nodes) {
    const Eigen::Matrix3d rotation = share * Eigen::Matrix3d::Identity() + twist;
    const auto c = carried.find(node);
    AveragingWeight& moves = weight(c == carried.end() ? node : c->second.independent_node);
    moves.share += share;
    moves.turn += turn;
    if (c == carried.end()) {
      moves.arm += arm;
      moves.rotation += rotation;
      continue;
    }
    const Eigen::Map<const Eigen::Matrix3d> S(c->second.own);
    const Eigen::Matrix3d led =
        Eigen::Matrix3d::Identity() - S * S.transpose();  // of its rotation, by the independent node
    const Eigen::Map<const Eigen::Vector3d> lead(c->second.arm);
    moves.arm += arm * led - share * math::skew(lead);
    moves.lead += share * lead;
    moves.rotation += rotation * led - turn * math::skew(lead);
    if (S.isZero(0)) continue;
    moves.apart -= share;
    AveragingWeight& own = weight(node);
    own.apart += share;
    own.arm += arm * S;
    own.rotation += rotation * S;
  }
  return all;
}

/// body::PlaceMap::H of a place that these nodes move. Collective.
std::vector<Eigen::Matrix3d> second_order_rotation(const fem::Mesh& mesh, const std::vector<AveragingWeight>& weights) {
  const auto turns = [](const AveragingWeight& weight) { return !weight.turn.isZero(0); };
  if (std::none_of(weights.begin(), weights.end(), turns)) return {};
  std::vector<PetscInt> numbers;
  for (const AveragingWeight& weight : weights) numbers.push_back(weight.node);
  const std::vector<Eigen::Vector3d> x = fem::positions_of(mesh, numbers);
  std::vector<Eigen::Matrix3d> H(3, Eigen::Matrix3d::Zero());
  for (std::size_t i = 0; i < weights.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a)
      H[a] -= math::arm_form(weights[i].turn.row(static_cast<Eigen::Index>(a)).transpose(), x[i]);
  return H;
}

/// Whether the nodes are those of a hinge line: which follow one of them, and rotate about it by themselves.
/// Collective.
bool on_hinge_line(const fem::Mesh& mesh, const Anchor& place) {
  int mine = 0;
  for (const fem::Mesh::Spin& spin : mesh.spins)
    if (spin.node < mesh.owned_nodes &&
        std::count(place.nodes.begin(), place.nodes.end(), mesh.global_node(spin.node)) > 0)
      ++mine;
  MPI_Allreduce(MPI_IN_PLACE, &mine, 1, MPI_INT, MPI_SUM, mesh.comm);
  const auto leads = [](const AveragingWeight& weight) { return weight.share > 0; };
  return place.nodes.size() > 1 && mine > 0 &&
         std::count_if(place.averaging_weights.begin(), place.averaging_weights.end(), leads) == 1;
}

void refuse_measure(const Load& load, const PlaceMeasure& measure) {
  using Of = PlaceMeasure::Of;
  const bool edges = load.per == Load::Per::length;
  if (measure.of == (edges ? Of::edges : Of::areas)) return;
  throw InputError(fmt::format("{}: is per {}, and its place {}; expected {}", load.where.text(),
                               edges ? "length" : "area",
                               measure.of == Of::points  ? "is no edge and no area of the mesh"
                               : measure.of == Of::edges ? "consists of edges"
                                                         : "is an area of shells",
                               edges ? "the nodes of edges of shells or beams" : "all nodes of shells"));
}

}  // namespace

std::vector<LoadPart> spread_load(const Load& load, const fem::Structure& structure, const Anchor& place,
                                  const MeshAxes& axes) {
  if (place.weights)
    throw InputError(
        fmt::format("{}.per: the nodes of the place have weights in its file; expected a force or moment "
                    "as a resultant, or a place without weights",
                    load.where.text()));
  PlaceMeasure measure;
  place_weights(structure, place.nodes, &measure);
  refuse_measure(load, measure);
  const bool moment = load.kind == Load::Kind::moment;
  if (!load.shape && !moment) return {{place, measure.size}};
  const std::vector<Eigen::Vector3d> x = fem::positions_of(structure.mesh, place.nodes);
  std::vector<double> shape;
  double largest = 0;
  for (const Eigen::Vector3d& each : x) {
    const Eigen::Vector3d at = axes.origin + axes.axes * each;
    shape.push_back(load.shape ? (*load.shape)(at.x(), at.y(), at.z()) : 1);
    largest = std::max(largest, std::abs(shape.back()));
  }
  const std::vector<reduction::WeightedNode> weights = shaped_weights(structure, place.nodes, measure.of, shape);
  const double small = 1e-14 * largest * measure.size;
  std::vector<LoadPart> parts;
  for (const double sign : {1., -1.}) {  // nodes without weight, which may have arms, belong to the first part
    std::vector<std::size_t> which;
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const bool none = std::abs(weights[i].weight) <= small;
      if (none ? !parts.empty() : sign * weights[i].weight < 0) continue;
      which.push_back(i);
      sum += none ? 0 : std::abs(weights[i].weight);
    }
    if (!(sum > small)) continue;
    LoadPart part{{}, sign * sum};
    std::vector<reduction::WeightedNode> own;
    for (const std::size_t i : which) {
      own.push_back({weights[i].node, weights[i].weight / part.size, weights[i].arm / part.size});
      part.at.nodes.push_back(weights[i].node);
      part.at.x += own.back().weight * x[i];
    }
    set_rotation(structure, own, moment ? RotationBy::shares : RotationBy::nearest_motion);
    part.at.body = place.body;
    part.at.averaging_weights = averaging_weights(structure.mesh, own);
    part.at.H = second_order_rotation(structure.mesh, part.at.averaging_weights);
    part.at.node = part.at.averaging_weights.front().node;
    part.at.weights = std::make_shared<const std::vector<reduction::WeightedNode>>(std::move(own));
    parts.push_back(std::move(part));
  }
  if (parts.empty())
    throw InputError(fmt::format("{}.shape: is zero at all nodes of the place; expected a shape", load.where.text()));
  return parts;
}

Anchor spatial_place(const Body& body, const fem::Structure& structure, const mesh::NodeSets& places,
                     const Place& place, const MeshAxes& axes) {
  Anchor found;
  const bool named_centre = body.mass && !place.point && place.name == "centre";
  if (named_centre && places.contains("centre"))
    throw InputError(
        fmt::format("{}: centre is the centre of mass of body {}, and its mesh has a group of this name; "
                    "expected coordinates (node) for the group",
                    place.where.text(), place.body));
  if ((place.point && body.rigid) || named_centre) {
    const Point& x = named_centre ? body.mass->centre : *place.point;
    found.x = axes.axes.transpose() * (Eigen::Vector3d::Map(x.data()) - axes.origin);
    found.nodes = {0};  // of no account
    found.averaging_weights = {{0, 1, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity()}};
    return found;
  }
  mesh::NodeSet set;
  if (place.point) {
    const fem::NearestNode nearest = fem::nearest_node(
        structure.mesh, axes.axes.transpose() * (Eigen::Vector3d::Map(place.point->data()) - axes.origin));
    const Eigen::Vector3d there = axes.origin + axes.axes * nearest.position;
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (const Eigen::Vector3d& x : structure.mesh.positions) low = low.cwiseMin(x), high = high.cwiseMax(x);
    MPI_Allreduce(MPI_IN_PLACE, low.data(), 3, MPI_DOUBLE, MPI_MIN, structure.mesh.comm);
    MPI_Allreduce(MPI_IN_PLACE, high.data(), 3, MPI_DOUBLE, MPI_MAX, structure.mesh.comm);
    if (nearest.distance > 1e-6 * (high - low).norm())
      throw InputError(fmt::format("{}: no node of {} at ({}, {}, {}); the nearest node is at ({:.9g}, {:.9g}, {:.9g})",
                                   place.where.text(), place.body, (*place.point)[0], (*place.point)[1],
                                   (*place.point)[2], there.x(), there.y(), there.z()));
    set.nodes = {nearest.node};
  } else {
    const auto named = places.find(place.name);
    if (body.mass && !body.mass->has_mesh)
      throw InputError(fmt::format("{}: {} has no mesh and no place \"{}\"; expected centre or coordinates",
                                   place.where.text(), place.body, place.name));
    if (named == places.end()) {
      std::vector<std::string> names;
      for (const auto& entry : places) names.push_back(entry.first);
      const std::string near = math::nearest(place.name, names);
      throw InputError(fmt::format("{}: {} has no place \"{}\"; expected {}coordinates{}", place.where.text(),
                                   place.body, place.name,
                                   names.empty() ? "" : fmt::format("one of {} or ", fmt::join(names, ", ")),
                                   near.empty() ? "" : "; did you mean \"" + near + "\"?"));
    }
    if (named->second.nodes.empty())
      throw InputError(
          fmt::format("{}: the place \"{}\" of {} has no node", place.where.text(), place.name, body.name));
    set = named->second;
  }
  found.nodes = set.nodes;
  const fem::Mesh& m = structure.mesh;
  const std::vector<reduction::WeightedNode> weights = weights_of(structure, set);
  if (!set.weights.empty()) found.weights = std::make_shared<const std::vector<reduction::WeightedNode>>(weights);
  found.averaging_weights = averaging_weights(m, weights);
  found.H = second_order_rotation(m, found.averaging_weights);
  found.node = found.averaging_weights.front().node;
  found.line = on_hinge_line(m, found);
  const std::vector<Eigen::Vector3d> x = fem::positions_of(m, found.nodes);
  for (std::size_t i = 0; i < weights.size(); ++i) found.x += weights[i].weight * x[i];
  return found;
}

}  // namespace floe::plan
