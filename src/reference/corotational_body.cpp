#include "floe/reference/corotational_body.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "corotational_mass.h"
#include "floe/dynamics/spatial_body.h"
#include "floe/dynamics/spatial_joint.h"
#include "floe/dynamics/spatial_spring.h"
#include "floe/fem/element.h"
#include "floe/fem/shell.h"
#include "floe/math/rotation.h"
#include "floe/petsc/all_ranks.h"
#include "floe/petsc/values.h"

namespace floe::reference {

using dynamics::SpatialMarker;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using petsc::check;

namespace {

bool is_last(MPI_Comm comm) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  return rank == size - 1;
}

/// Six numbers of each node, of all ranks; empty where there is no field. Collective.
Eigen::VectorXd whole(Vec field) {
  if (!field) return {};
  VecScatter scatter = nullptr;
  petsc::VecHandle all;
  check(VecScatterCreateToAll(field, &scatter, all.out()));
  check(VecScatterBegin(scatter, field, all, INSERT_VALUES, SCATTER_FORWARD));
  check(VecScatterEnd(scatter, field, all, INSERT_VALUES, SCATTER_FORWARD));
  check(VecScatterDestroy(&scatter));
  petsc::Values values(all);
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), values.end - values.first);
}

Eigen::Matrix<double, 6, 1> of_node(const Eigen::VectorXd& field, PetscInt node) {
  if (field.size() == 0) return Eigen::Matrix<double, 6, 1>::Zero();
  return field.segment<6>(6 * node);
}

/// Axes of which `column` is along e, where it has a length.
Matrix3d axes_about(const Vector3d& e, int column) {
  Matrix3d W = Matrix3d::Identity();
  if (e.isZero(0)) return W;
  W.col(column) = e.normalized();
  W.col((column + 1) % 3) = W.col(column).unitOrthogonal();
  W.col((column + 2) % 3) = W.col(column).cross(W.col((column + 1) % 3));
  return W;
}

bool follows(const fem::Mesh& mesh, int local) {
  return std::any_of(mesh.dependent_nodes.begin(), mesh.dependent_nodes.end(),
                     [&](const auto& f) { return f.node == local; }) &&
         !fem::spin_of(mesh, local);
}

}  // namespace

CorotationalBody::CorotationalBody(dynamics::Coordinates& coordinates, const fem::Structure& structure,
                                   std::vector<PetscInt> visited, const std::vector<std::vector<PetscInt>>& pieces,
                                   const CorotationalStart& at, bool everywhere)
    : structure_(structure), owner_(is_last(structure.mesh.comm)) {
  const fem::Mesh& mesh = structure.mesh;
  find_links(pieces);
  int rows = 0;
  for (const Link& link : links_)
    visited.insert(visited.end(), {link.node, link.independent_node}), rows += link.rows();
  nodes_ = std::make_unique<NodeCoordinates>(coordinates, mesh, visited, 6, everywhere);
  link_multipliers_ = coordinates.add_shared(rows, true);
  std::set<PetscInt> moving;
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i)
    if (!follows(mesh, static_cast<int>(i))) moving.insert(mesh.first_node + i);
  for (const fem::Mesh::Cell& cell : mesh.cells)
    for (int node : cell.nodes()) moving.insert(mesh.global_node(node));
  if (owner_ || everywhere) moving.insert(visited.begin(), visited.end());
  for (PetscInt node : moving)
    attitude_[node] = std::make_shared<dynamics::Attitude>(dynamics::Attitude{.of_node = true});
  start(at);
}

/// Nodes with rotations of their own, then pieces. Collective.
void CorotationalBody::find_links(const std::vector<std::vector<PetscInt>>& pieces) {
  const fem::Mesh& mesh = structure_.mesh;
  const auto integer = [](double number) { return static_cast<PetscInt>(std::lround(number)); };
  std::vector<double> mine;
  for (const fem::Mesh::DependentNode& f : mesh.dependent_nodes)
    if (const fem::Mesh::Spin* spin = fem::spin_of(mesh, f.node)) {
      const Vector3d arm = mesh.positions[f.node] - mesh.positions[f.independent_node], &e = spin->axis;
      mine.insert(mine.end(), {double(mesh.global_node(f.node)), double(mesh.global_node(f.independent_node)), arm.x(),
                               arm.y(), arm.z(), e.x(), e.y(), e.z(), spin->others ? 1. : 0.});
    }
  const std::vector<double> hinges = petsc::of_all_ranks(mesh.comm, mine);
  for (std::size_t i = 0; i < hinges.size(); i += 9)
    links_.push_back({integer(hinges[i]), integer(hinges[i + 1]), Vector3d(hinges[i + 2], hinges[i + 3], hinges[i + 4]),
                      Vector3d(hinges[i + 5], hinges[i + 6], hinges[i + 7]), hinges[i + 8] != 0});
  mine.clear();
  for (const auto& piece : pieces)
    for (PetscInt node : piece)
      if (const PetscInt local = node - mesh.first_node; local >= 0 && local < mesh.owned_nodes) {
        const Vector3d& X = mesh.positions[local];
        mine.insert(mine.end(), {double(node), X.x(), X.y(), X.z()});
      }
  const std::vector<double> places = petsc::of_all_ranks(mesh.comm, mine);
  std::map<PetscInt, Vector3d> X;
  for (std::size_t i = 0; i < places.size(); i += 4)
    X[integer(places[i])] = {places[i + 1], places[i + 2], places[i + 3]};
  for (const auto& piece : pieces) {
    const PetscInt independent_node = piece.front();
    for (PetscInt node : piece) {
      piece_[node] = static_cast<int>(independent_node_.size());
      if (node != independent_node)
        links_.push_back({node, independent_node, X.at(node) - X.at(independent_node), Vector3d::Zero(), false});
    }
    independent_node_.emplace_back(independent_node, X.at(independent_node));
  }
}

void CorotationalBody::start(const CorotationalStart& at) {
  const fem::Mesh& mesh = structure_.mesh;
  const Eigen::VectorXd shape = whole(at.deformation), rates = whole(at.deformation_rate);
  const auto rotated = [&](const Vector3d& theta) {
    return (Eigen::Quaterniond(at.attitude) * math::quaternion(theta)).normalized();
  };
  const auto moving = [&](const Vector3d& x, const Vector3d& xd, const Vector3d& theta, const Vector3d& thetad) {
    const Vector3d spin = math::rotation(theta).transpose() * at.spin + math::rotation_tangent(theta) * thetad;
    return Moving{at.place + at.attitude * x, at.rate + at.attitude * (at.spin.cross(x) + xd), spin};
  };
  for (auto& [node, attitude] : attitude_) {
    attitude->base = rotated(of_node(shape, node).tail<3>());
    const PetscInt local = node - mesh.first_node;
    if (local < 0 || local >= mesh.owned_nodes) continue;
    const auto u = of_node(shape, node), ud = of_node(rates, node);
    start_[node] = moving(mesh.positions[local] + u.head<3>(), ud.head<3>(), u.tail<3>(), ud.tail<3>());
  }
  for (const Link& hinge : links_) {  // fields have of such nodes their own rotations only
    const auto found = attitude_.find(hinge.node);
    if (found == attitude_.end() || !hinge.spins()) continue;
    const auto u = of_node(shape, hinge.independent_node), ud = of_node(rates, hinge.independent_node);
    const Matrix3d S = hinge.own();
    const Vector3d theta = u.tail<3>(), own = S * (of_node(shape, hinge.node).tail<3>() - S.transpose() * theta),
                   ownd = S * (of_node(rates, hinge.node).tail<3>() - S.transpose() * ud.tail<3>()),
                   arm = math::rotation(theta) * hinge.arm;
    found->second->base = (rotated(theta) * math::quaternion(own)).normalized();
    if (!start_.contains(hinge.node)) continue;
    const PetscInt local = hinge.node - mesh.first_node;
    const Vector3d X = mesh.positions[local] - hinge.arm;
    const Vector3d w = math::rotation_tangent(theta) * ud.tail<3>();
    Moving& m = start_[hinge.node];
    m = moving(X + u.head<3>() + arm, ud.head<3>() + math::rotation(theta) * w.cross(hinge.arm), theta, ud.tail<3>());
    m.spin = math::rotation(own).transpose() * m.spin + ownd;
  }
}

/// About y, the rotation that a universal joint holds, where its others are free.
dynamics::SpatialConstraint CorotationalBody::Link::constraint() const {
  using Constraint = dynamics::SpatialConstraint;
  if (!spins()) return Constraint::fixed();
  if (!others) return Constraint::revolute();
  return axis.isZero(0) ? Constraint::spherical() : Constraint::universal();
}

int CorotationalBody::piece_of(PetscInt node) const {
  const auto found = piece_.find(node);
  return found == piece_.end() ? -1 : found->second;
}

Matrix3d CorotationalBody::of_rotation(PetscInt node, const Matrix3d& of_dofs) const {
  for (const Link& link : links_)
    if (link.node == node && link.spins()) return of_dofs * link.own().transpose();
  return of_dofs;
}

SpatialMarker CorotationalBody::place_on_piece(int piece, const Vector3d& x) const {
  const auto& [independent_node, X] = independent_node_[piece];
  SpatialMarker at = place(independent_node);
  at.x0 = x - X;
  return at;
}

SpatialMarker CorotationalBody::place(PetscInt node) const {
  SpatialMarker at;
  const int first = nodes_->of_node(node);
  for (int i = 0; i < 6; ++i) at.coordinates.push_back(first + i);
  at.attitude = attitude_.at(node);
  return at;
}

std::vector<SpatialMarker> CorotationalBody::places(const fem::Mesh::Cell& cell) const {
  const fem::Mesh& mesh = structure_.mesh;
  std::vector<SpatialMarker> all;
  for (std::size_t i = 0; i < cell.places().size(); ++i) {
    const int mover = cell.moved[i], corner = cell.place[i];
    SpatialMarker at = place(mesh.global_node(mover));
    at.x0 += mesh.positions[corner] - mesh.positions[mover];
    all.push_back(std::move(at));
  }
  return all;
}

namespace {

bool one_frame(const std::vector<SpatialMarker>& places) {
  return std::all_of(places.begin(), places.end(),
                     [&](const SpatialMarker& at) { return at.coordinates[0] == places.front().coordinates[0]; });
}

}  // namespace

std::unique_ptr<CorotationalElement> CorotationalBody::element(const fem::Mesh::Cell& cell, std::size_t i,
                                                               double viscosity) const {
  std::vector<SpatialMarker> at = places(cell);
  std::vector<Vector3d> X;
  for (int corner : cell.places()) X.push_back(structure_.mesh.positions[corner]);
  fem::CellKind kind = cell.kind;
  fem::ElementMaps maps;
  if (cell.kind == fem::CellKind::quadrilateral) {
    const auto& [a, b, c] = fem::quadrilateral_triangles[i];
    kind = fem::CellKind::triangle;
    const auto& section = std::get<fem::ShellSection>(structure_.sections[cell.part]);
    maps = fem::shell_quadrilateral_part({X[0], X[1], X[2], X[3]}, static_cast<int>(i),
                                         fem::on_curved_surface(section, cell.rise));
    at = {at[a], at[b], at[c]}, X = {X[a], X[b], X[c]};
  } else {
    maps = structure_.maps(cell.alone());
  }
  if (one_frame(at)) return nullptr;
  Eigen::Matrix3Xd x(3, static_cast<Eigen::Index>(X.size()));
  for (std::size_t n = 0; n < X.size(); ++n) x.col(static_cast<Eigen::Index>(n)) = X[n];
  // A triangle keeps its corners in its plane: its slopes are zero, and it is linear in its own axes.
  body::Elasticity elasticity = fem::elasticity(maps, Eigen::MatrixXd::Identity(6 * x.cols(), 6 * x.cols()));
  if (kind == fem::CellKind::triangle) elasticity = body::linearised(elasticity);
  const double share = cell.kind == fem::CellKind::quadrilateral ? 0.5 : 1;
  elasticity.bending *= share, elasticity.F *= std::sqrt(share);
  return std::make_unique<CorotationalElement>(kind, std::move(at), x, std::move(elasticity), viscosity);
}

/// The linear spring between two nodes, of its length or in axes that rotate with the first one (fem::node_spring for
/// moderate rotations).
std::unique_ptr<dynamics::Term> CorotationalBody::spring(const fem::Mesh::Cell& cell, double viscosity) const {
  const auto& own = std::get<fem::NodeSpring>(structure_.sections[cell.part]);
  std::vector<SpatialMarker> at = places(cell);
  if (one_frame(at)) return nullptr;
  const Vector3d along = structure_.mesh.positions[cell.place[1]] - structure_.mesh.positions[cell.place[0]];
  if (own.kind == mesh::SpringKind::line) {
    dynamics::SpatialSpringProperties line{own.stiffness[0], viscosity * own.stiffness[0], along.norm()};
    return std::make_unique<dynamics::SpatialSpring>(std::move(at[0]), std::move(at[1]), line);
  }
  at[0].x0 += own.at * along, at[1].x0 += (own.at - 1) * along;
  at[0].D0 = at[1].D0 = own.axes;
  dynamics::BushingProperties properties;
  properties.stiffness = own.stiffness, properties.viscosity = viscosity * own.stiffness;
  properties.name = "between two nodes";
  return std::make_unique<dynamics::SpatialBushing>(std::move(at[0]), std::move(at[1]), properties);
}

void CorotationalBody::add_elements(double viscosity, std::vector<std::unique_ptr<dynamics::Term>>& terms,
                                    CellsOfPart part) const {
  const fem::Mesh& mesh = structure_.mesh;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const fem::Mesh::Cell& cell = mesh.cells[c];
    if (!counts(part, c)) continue;
    if (cell.kind == fem::CellKind::spring)
      if (auto one = spring(cell, viscosity)) terms.push_back(std::move(one));
    if (!mesh::has_extent(cell.kind)) continue;
    const std::size_t pieces = cell.kind == fem::CellKind::quadrilateral ? fem::quadrilateral_triangles.size() : 1;
    for (std::size_t i = 0; i < pieces; ++i)
      if (auto one = element(cell, i, viscosity)) terms.push_back(std::move(one));
  }
}

std::vector<CorotationalBody::NodeMass> CorotationalBody::carried(Density density, CellsOfPart part) const {
  std::map<int, NodeMass> all;
  for (std::size_t c = 0; c < structure_.mesh.cells.size(); ++c) {
    if (!counts(part, c)) continue;
    const fem::Mesh::Cell& cell = structure_.mesh.cells[c];
    const std::vector<SpatialMarker> places = this->places(cell);
    for (const CarriedMass& mass : carried_mass(structure_, cell, density)) {
      const SpatialMarker& at = places[mass.corner];
      const Vector3d& x = structure_.mesh.positions[cell.moved[mass.corner]];
      body::Inertia& sum = all.try_emplace(at.coordinates[0], at, body::Inertia(3, 0), x).first->second.inertia;
      const Vector3d arm = at.x0 + mass.arm;
      sum.m += mass.mass;
      sum.s0 += mass.mass * arm;
      sum.C0 += mass.mass * arm * arm.transpose() + mass.spread;
    }
  }
  std::vector<NodeMass> list;
  for (auto& [first, one] : all)
    if (one.inertia.m != 0) list.push_back(std::move(one));
  return list;
}

std::vector<SpatialMarker> CorotationalBody::density(Density density, CellsOfPart part) const {
  std::vector<SpatialMarker> markers;
  for (NodeMass& one : carried(density, part)) {
    one.at.mass = one.inertia.m, one.at.x0 = one.inertia.s0;
    markers.push_back(std::move(one.at));
  }
  return markers;
}

void CorotationalBody::add_links(std::vector<std::unique_ptr<dynamics::Term>>& terms) const {
  if (!owner_) return;
  int multiplier = link_multipliers_;
  for (const Link& link : links_) {
    SpatialMarker independent_node = place(link.independent_node), node = place(link.node);
    independent_node.x0 += link.arm;
    if (link.spins()) independent_node.D0 = node.D0 = axes_about(link.axis, link.others ? 1 : 2);
    terms.push_back(std::make_unique<dynamics::SpatialJoint>(std::move(independent_node), std::move(node),
                                                             link.constraint(), multiplier));
    multiplier += link.rows();
  }
}

/// Dofs of nodes that follow others stay zero.
void CorotationalBody::add_idle(std::vector<std::unique_ptr<dynamics::Term>>& terms) const {
  const fem::Mesh& mesh = structure_.mesh;
  double stiffest = 0;
  for (const fem::Mesh::Cell& cell : mesh.cells)
    if (mesh::has_extent(cell.kind))
      stiffest = std::max(stiffest, structure_.matrix(cell.alone(), 1, 0).diagonal().maxCoeff());
  MPI_Allreduce(MPI_IN_PLACE, &stiffest, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i) {
    if (start_.contains(mesh.first_node + i)) continue;
    for (int d = 0; d < 6; ++d)
      terms.push_back(std::make_unique<ConstrainedDof>(nodes_->of_local_node(static_cast<int>(i)) + d,
                                                       stiffest > 0 ? stiffest : 1));
  }
}

std::vector<std::unique_ptr<dynamics::Term>> CorotationalBody::terms_of(CellsOfPart part, double viscosity) const {
  std::vector<std::unique_ptr<dynamics::Term>> all;
  add_elements(viscosity, all, part);
  const body::Elasticity rigid{Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 0), {}};
  for (const NodeMass& one : carried(Density::mass, part))
    all.push_back(std::make_unique<dynamics::SpatialBody>(one.at.coordinates, one.at.attitude,
                                                          body::spatial(one.inertia), rigid));
  return all;
}

std::vector<std::unique_ptr<dynamics::Term>> CorotationalBody::terms(double viscosity) const {
  std::vector<std::unique_ptr<dynamics::Term>> all = terms_of(nullptr, viscosity);
  add_links(all);
  add_idle(all);
  return all;
}

void CorotationalBody::add_attitudes(dynamics::Attitudes& attitudes) const {
  for (const auto& [node, attitude] : attitude_) attitudes.emplace_back(nodes_->of_node(node) + 3, attitude);
}

void CorotationalBody::set_start(const std::vector<PetscInt>& global, Vec U, Vec V) const {
  const auto set = [&](int first, const Moving& m) {
    for (int i = 0; i < 3; ++i) {
      check(VecSetValue(U, global[first + i], m.R[i], INSERT_VALUES));
      check(VecSetValue(V, global[first + i], m.rate[i], INSERT_VALUES));
      check(VecSetValue(V, global[first + 3 + i], m.spin[i], INSERT_VALUES));
    }
  };
  for (const auto& [node, m] : start_) set(nodes_->of_node(node), m);
}

}  // namespace floe::reference
