#include "whole_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "floe/assembly/damping.h"
#include "floe/assembly/offline.h"
#include "floe/assembly/residual_loads.h"
#include "floe/dynamics/damping.h"
#include "floe/error.h"
#include "floe/fem/assembly.h"
#include "floe/petsc/all_ranks.h"
#include "floe/petsc/values.h"
#include "floe/reference/modal_damping.h"
#include "whole_axes.h"

namespace floe::assembly {

using Eigen::Vector3d;
using Eigen::VectorXd;
using petsc::check;

namespace {

using Point = std::array<double, 3>;

/// Translations and rotations of a node, in mesh axes.
using Motion6 = std::array<double, 6>;

Vector3d place(const PlannedBody& body, PetscInt node) {
  return undeformed_origin(body) + undeformed_axes(body) * body.structure.mesh.positions[node];
}

/// The nodes of a whole body and its modes there, on every rank.
class Field {
 public:
  /// Collective.
  Field(const PlannedBody& body, const std::vector<petsc::VecHandle>& shapes) : name_(body.spec.name) {
    const fem::Mesh& mesh = body.structure.mesh;
    const int n = body.structure.dofs_per_node;
    const Eigen::Matrix3d A = undeformed_axes(body);
    std::vector<Point> places;
    for (PetscInt node = 0; node < mesh.owned_nodes; ++node) {
      const Vector3d X = place(body, node);
      places.push_back({X[0], X[1], X[2]});
    }
    const std::vector<Point> all = petsc::of_all_ranks(mesh.comm, places);
    for (const petsc::VecHandle& shape : shapes) {
      const petsc::ConstValues values(shape);
      std::vector<Motion6> own;
      for (PetscInt node = 0; node < mesh.owned_nodes; ++node) {
        Eigen::Matrix<double, 6, 1> u = Eigen::Matrix<double, 6, 1>::Zero();
        for (int d = 0; d < n; ++d) u[n == 3 && d == 2 ? 5 : d] = values[n * (mesh.first_node + node) + d];
        u << A * u.head<3>().eval(), A * u.tail<3>().eval();
        Motion6& motion = own.emplace_back();
        std::copy(u.begin(), u.end(), motion.begin());
      }
      shapes_.push_back(petsc::of_all_ranks(mesh.comm, own));
    }
    const double extent = fem::extent(body.structure);
    small_ = 1e-8 * extent;
    for (std::size_t i = 0; i < all.size(); ++i) nodes_.emplace_back(all[i], i);
    std::sort(nodes_.begin(), nodes_.end());
  }

  /// The mode at a place.
  const Motion6& at(std::size_t mode, const Vector3d& X) const { return shapes_[mode][node_at(X)]; }

 private:
  std::size_t node_at(const Vector3d& X) const {
    std::vector<std::size_t> found;
    const auto before = [](const auto& node, double x) { return node.first[0] < x; };
    for (auto at = std::lower_bound(nodes_.begin(), nodes_.end(), X[0] - small_, before);
         at != nodes_.end() && at->first[0] <= X[0] + small_; ++at)
      if ((Eigen::Map<const Vector3d>(at->first.data()) - X).norm() <= small_) found.push_back(at->second);
    if (found.size() != 1)
      throw RunError(
          fmt::format("body {}: damping.modal in several frames needs its modes as a whole, and {} of its nodes are at "
                      "({:.6g}, {:.6g}, {:.6g}); expected frames: 1, or damping: {{stiffness: BETA}}",
                      name_, found.empty() ? "none" : "several", X[0], X[1], X[2]));
    return found.front();
  }

  std::string name_;
  double small_ = 0;
  std::vector<std::pair<Point, std::size_t>> nodes_;  // ascending
  std::vector<std::vector<Motion6>> shapes_;
};

/// K phi / omega^2 of a piece. Collective.
std::vector<petsc::VecHandle> forces_on(const PlannedBody& piece, const Field& field,
                                        const std::vector<double>& omega) {
  const fem::Structure& s = piece.structure;
  const int n = s.dofs_per_node;
  const Eigen::Matrix3d A = undeformed_axes(piece).transpose();
  const petsc::MatHandle K = fem::stiffness(s, {});
  std::vector<petsc::VecHandle> forces;
  for (std::size_t i = 0; i < omega.size(); ++i) {
    const petsc::VecHandle shape = fem::field(s);
    petsc::agree(s.mesh.comm, [&] {
      petsc::Values own(shape);
      for (PetscInt node = 0; node < s.mesh.owned_nodes; ++node) {
        const Motion6& u = field.at(i, place(piece, node));
        Eigen::Matrix<double, 6, 1> v;
        v << A * Eigen::Map<const Vector3d>(u.data()), A * Eigen::Map<const Vector3d>(u.data() + 3);
        for (int d = 0; d < n; ++d) own[n * (s.mesh.first_node + node) + d] = v[n == 3 && d == 2 ? 5 : d];
      }
    });
    forces.push_back(fem::field(s));
    check(MatMult(K, shape, forces.back()));
    check(VecScale(forces.back(), 1 / (omega[i] * omega[i])));
  }
  return forces;
}

WholeModes modes_of(const Plan& plan, std::vector<int> pieces) {
  const std::string name = plan.bodies[pieces.front()].spec.whole;
  Scene unsplit = *plan.scene.unsplit;
  unsplit.probes.clear();
  const Plan whole = prepare(unsplit, plan.comm);
  const auto at = std::find_if(whole.bodies.begin(), whole.bodies.end(),
                               [&](const PlannedBody& body) { return body.spec.name == name; });
  const int index = static_cast<int>(at - whole.bodies.begin());
  const reduction::Modes damped = all_modes_for_damping(whole, index);
  const std::vector<double>& ratios = at->spec.damping.modal;
  std::vector<double> omega = damped.omega;
  omega.resize(std::min(ratios.size(), omega.size()));
  WholeModes modes;
  modes.viscosity.resize(static_cast<Eigen::Index>(omega.size()));
  for (std::size_t i = 0; i < omega.size(); ++i)
    modes.viscosity[static_cast<Eigen::Index>(i)] = 2 * ratios[i] * omega[i];
  const Field field(*at, damped.shapes);
  for (const int b : pieces) modes.forces.push_back(forces_on(plan.bodies[b], field, omega));
  modes.bodies = std::move(pieces);
  return modes;
}

}  // namespace

std::vector<WholeModes> modes_of_wholes(const Plan& plan) {
  std::map<std::string, std::vector<int>> pieces;
  for (std::size_t b = 0; b < plan.bodies.size(); ++b)
    if (const Body& spec = plan.bodies[b].spec; spec.piece > 0 && is_meshed(spec) && has_modal_damping(spec))
      pieces[spec.whole].push_back(static_cast<int>(b));
  std::vector<WholeModes> all;
  for (auto& [name, bodies] : pieces) all.push_back(modes_of(plan, std::move(bodies)));
  return all;
}

Offline::Offline(Scene whole, MPI_Comm comm) : scene(std::move(whole)), plan(prepare(scene, comm)) {
  plan.whole_modes = modes_of_wholes(plan);
}

WholeDamping::WholeDamping(const Plan& plan, const WholeModes& modes, bool full, dynamics::Coordinates& coordinates)
    : plan_(plan), modes_(modes) {
  if (!full) return;
  const int count = static_cast<int>(modes.viscosity.size());
  coordinates.belongs_to("damping of body " + plan.bodies[modes.bodies.front()].spec.whole);
  y_ = coordinates.add_shared(count), multipliers_ = coordinates.add_shared(count, true);
}

std::vector<std::unique_ptr<dynamics::Term>> WholeDamping::terms(const std::function<PieceUnknowns(int)>& piece,
                                                                 bool owner) const {
  std::vector<std::unique_ptr<dynamics::Term>> all;
  std::vector<int> coordinates;
  Eigen::MatrixXd G(modes_.viscosity.size(), 0);
  for (std::size_t p = 0; p < modes_.bodies.size(); ++p) {
    const PieceUnknowns at = piece(modes_.bodies[p]);
    const std::vector<petsc::VecHandle>& forces = modes_.forces[p];
    if (y_ >= 0) {
      std::ranges::move(reference::modal_rows(plan_.bodies[modes_.bodies[p]].structure, forces, *at.constrained,
                                              multipliers_, *at.nodes),
                        std::back_inserter(all));
      continue;
    }
    const int k = at.reduced->body.coordinates();
    if (k == 0) continue;
    G.conservativeResize(Eigen::NoChange, G.cols() + k);
    for (std::size_t i = 0; i < forces.size(); ++i)
      G.row(static_cast<Eigen::Index>(i)).tail(k) = products(*at.reduced->basis, forces[i]).transpose();
    for (int i = 0; i < k; ++i) coordinates.push_back(at.elastic + i);
  }
  if (!owner) return all;
  if (y_ >= 0)
    std::ranges::move(reference::modal_dampers(modes_.viscosity, y_, multipliers_), std::back_inserter(all));
  else if (!coordinates.empty())
    all.push_back(std::make_unique<dynamics::LinearDamping>(std::move(coordinates),
                                                            G.transpose() * modes_.viscosity.asDiagonal() * G));
  return all;
}

void WholeDamping::set_start(const dynamics::Coordinates& coordinates, bool owner, Vec U, Vec V) const {
  if (y_ < 0) return;
  VectorXd y = VectorXd::Zero(modes_.viscosity.size()), rate = y;
  for (std::size_t p = 0; p < modes_.bodies.size(); ++p) {
    const PlannedBody& body = plan_.bodies[modes_.bodies[p]];
    y += reference::modal_coordinates(modes_.forces[p], body.deformation);
    rate += reference::modal_coordinates(modes_.forces[p], body.deformation_rate);
  }
  for (int i = 0; i < static_cast<int>(y.size()) && owner; ++i) {
    check(VecSetValue(U, coordinates.global()[y_ + i], y[i], INSERT_VALUES));
    check(VecSetValue(V, coordinates.global()[y_ + i], rate[i], INSERT_VALUES));
  }
}

}  // namespace floe::assembly
