#include "build_held.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/dynamics/held_body.h"
#include "floe/dynamics/start.h"
#include "floe/reference/full_order.h"
#include "prepare_reduced.h"

namespace floe::scene {
namespace {

Eigen::Vector3d vector(const Point& p) { return {p[0], p[1], p[2]}; }

/// Whether a place of a body from a file has no motion in the body's frame.
bool at_rest(const PreparedBody& body, const body::PlaceMap& map) {
  const output::ReducedBodyFile& file = *body.spec.reduced->file;
  const double small = 1e-9 / std::sqrt(file.body.inertia.m);  // columns are normalised to unit mass
  return map.S.cwiseAbs().sum() <= small && map.psi.cwiseAbs().sum() * extent_of(file) <= small;
}

/// Whether the ground clamps the body, as it did when it was reduced.
bool clamped_from_file(const Prepared& prepared, const PreparedBody& body) {
  for (std::size_t j = 0; j < prepared.joints.size(); ++j)
    for (const PreparedPlace& place : prepared.joints[j])
      if (place.map && &prepared.bodies[place.body] == &body && prepared.scene.joints[j].kind == Joint::Kind::fixed &&
          at_rest(body, *place.map))
        return true;
  return false;
}

/// A clamped frame, whose place the ground clamps.
bool stands_still(const Prepared& prepared, const PreparedBody& body) {
  if (body.frame.kind != fem::ReferenceFrame::Kind::clamped) return false;
  if (body.spec.reduced) return clamped_from_file(prepared, body);
  return std::includes(body.held.begin(), body.held.end(), body.frame.conditions.begin(), body.frame.conditions.end());
}

void check_held(const Prepared& prepared, Formulation formulation) {
  std::vector<std::string> faults;
  for (const PreparedBody& body : prepared.bodies) {
    if (!stands_still(prepared, body))
      faults.push_back(
          fmt::format("{}: floats; bodies in space move, so far, in a frame that stands still: expected a "
                      "joint of type fixed from the ground to one of its places, and frame: clamped there",
                      body.spec.where.text()));
    const InitialSpec& start = body.spec.initial;
    if (start.position != Point{} || start.velocity != Point{} || start.angle != 0 || start.angular_velocity != 0 ||
        start.deformation || start.deformation_rate)
      faults.push_back(fmt::format("{}: does not apply to a body in space", start.where.text()));
  }
  for (std::size_t j = 0; j < prepared.joints.size(); ++j)
    if (prepared.scene.joints[j].kind != Joint::Kind::fixed ||
        (prepared.joints[j][0].body >= 0) == (prepared.joints[j][1].body >= 0))
      faults.push_back(fmt::format("{}: in space joints of type fixed to the ground can move a scene, so far",
                                   prepared.scene.joints[j].where.text()));
  for (std::size_t j = 0; j < prepared.joints.size(); ++j)
    for (const PreparedPlace& place : prepared.joints[j])
      if (place.map && !at_rest(prepared.bodies[place.body], *place.map))
        faults.push_back(
            fmt::format("{}: holds body {} where its columns move; expected a place where it was held when {} was made",
                        prepared.scene.joints[j].where.text(), prepared.bodies[place.body].spec.name,
                        prepared.bodies[place.body].spec.reduced->path));
  if (formulation == Formulation::cfr)
    faults.push_back(prepared.scene.file + ": formulation cfr is known for planar beams only");
  if (!faults.empty()) throw InputError(faults);
}

/// A shell's rotations about its normal carry no mass, and a motion of full order needs some: they get as much as those
/// about the other axes have, half the trace of a node's rotary inertia. Frequencies change by the order of
/// (thickness/length)^2.
Eigen::MatrixXd with_drilling_inertia(const fem::Structure& structure, const fem::Mesh::Cell& cell, Eigen::MatrixXd M) {
  if (cell.kind != fem::CellKind::triangle && cell.kind != fem::CellKind::quadrilateral) return M;
  const auto at = [&](int i) { return structure.mesh.positions[cell.corner[i]]; };
  const Eigen::Vector3d n = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
  const Eigen::MatrixXd own =  // of its corners, whomever they follow: a follower's rotations are its leader's
      cell.follows() ? structure.matrix(fem::Mesh::Cell(cell.kind, cell.part, cell.corner), 0, 1) : M;
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(cell.nodes().size()); ++i)
    M.block<3, 3>(6 * i + 3, 6 * i + 3) += 0.5 * own.block<3, 3>(6 * i + 3, 6 * i + 3).trace() * n * n.transpose();
  return M;
}

/// Builds the terms of one formulation; local coordinates of each body begin at `first`.
struct HeldAssembly {
  const Prepared& prepared;
  Formulation formulation;
  const std::vector<ReducedBody>& reduced;
  MPI_Comm comm;
  dynamics::Coordinates coordinates;
  std::vector<int> first;
  std::vector<std::unique_ptr<reference::NodeCoordinates>> nodes;
  std::vector<std::unique_ptr<dynamics::Term>> terms;

  HeldAssembly(const Prepared& p, Formulation f, const std::vector<ReducedBody>& r)
      : prepared(p),
        formulation(f),
        reduced(r),
        comm(is_reduced(f) ? PETSC_COMM_SELF : p.comm),
        coordinates(comm),
        first(p.bodies.size(), 0),
        nodes(p.bodies.size()) {}

  std::vector<PetscInt> visited(int body) const {
    std::vector<PetscInt> all;
    for (const auto& probe : prepared.probes)
      for (const PreparedPlace& place : probe)
        if (place.body == body) all.insert(all.end(), place.nodes.begin(), place.nodes.end());
    return all;
  }

  /// Described by a ReducedBody; its terms are on the last rank where the system is on all.
  bool compact(int b) const { return is_reduced(formulation) || prepared.bodies[b].spec.reduced; }
  bool owner() const {
    int rank = 0, size = 1;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &size);
    return rank == size - 1;
  }

  void add_coordinates() {
    for (std::size_t b = 0; b < first.size(); ++b) {
      coordinates.belongs_to("body " + prepared.bodies[b].spec.name);
      if (compact(static_cast<int>(b)))
        first[b] = coordinates.add_shared(reduced[b].body.coordinates());
      else
        nodes[b] = std::make_unique<reference::NodeCoordinates>(coordinates, prepared.bodies[b].structure.mesh,
                                                                visited(static_cast<int>(b)), 6);
    }
    coordinates.number();
  }

  std::vector<int> reduced_coordinates(int b) const {
    std::vector<int> all(reduced[b].body.coordinates());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = first[b] + static_cast<int>(i);
    return all;
  }

  /// @param S  of the body's coordinates, f in world axes
  void add_force(int b, std::vector<int> of, Eigen::MatrixXd S, std::function<Eigen::Vector3d(double)> force,
                 bool conservative) {
    const Eigen::Matrix3d A = prepared.bodies[b].axes.transpose();
    auto term = std::make_unique<dynamics::DeadForce>(std::move(of), std::move(S),
                                                      [A, force](double t) -> Eigen::VectorXd { return A * force(t); });
    term->conservative = conservative;
    terms.push_back(std::move(term));
  }

  void add_reduced(int b) {
    const ReducedBody& body = reduced[b];
    const body::Inertia& inertia = body.body.inertia;
    const Eigen::MatrixXd M = inertia.M[0][0] + inertia.M[1][1] + inertia.M[2][2];
    const std::vector<int> all = reduced_coordinates(b);
    if (owner()) terms.push_back(std::make_unique<dynamics::HeldBody>(all, M, body.body.elasticity, body.damping));
    const Eigen::Vector3d g = vector(prepared.scene.gravity);
    if (!g.isZero() && owner())
      add_force(
          b, all, inertia.S, [g](double) { return g; }, true);
    for (std::size_t l = 0; l < prepared.loads.size(); ++l) {
      if (prepared.loads[l].body != b) continue;
      const bool distributed = prepared.scene.loads[l].kind == Load::Kind::distributed;
      const Eigen::MatrixXd S = distributed ? body.body.line.S : place_map(prepared, body, prepared.loads[l]).S;
      if (owner()) add_force(b, all, S, force_of(l), false);
    }
  }

  std::function<Eigen::Vector3d(double)> force_of(std::size_t l) const {
    const auto f = prepared.scene.loads[l].force;
    return [f](double t) { return Eigen::Vector3d(f[0](t), f[1](t), f[2](t)); };
  }

  std::vector<int> cell_coordinates(int b, const fem::Mesh::Cell& cell) const {
    std::vector<int> all;
    for (int node : cell.nodes())
      for (int d = 0; d < 6; ++d) all.push_back(nodes[b]->of_local_node(node) + d);
    return all;
  }

  void add_full(int b) {
    const PreparedBody& body = prepared.bodies[b];
    const fem::Structure& structure = body.structure;
    const DampingSpec& damping = body.spec.damping;
    if (!damping.modal.empty())
      throw InputError(fmt::format("{}: modal damping needs a reduced formulation (vm, vm+md)", damping.where.text()));
    const Eigen::Vector3d g = vector(prepared.scene.gravity);
    double stiffest = 1e-300;
    for (const fem::Mesh::Cell& cell : structure.mesh.cells) {
      const fem::ElementMaps maps = structure.maps(cell);
      stiffest = std::max(stiffest, maps.bending.diagonal().maxCoeff());
      const std::vector<int> all = cell_coordinates(b, cell);
      add_cell(body, cell, maps, all);
      if (!g.isZero())
        add_force(
            b, all, free(structure, body.held, cell, total(maps.mass)), [g](double) { return g; }, true);
      for (std::size_t l = 0; l < prepared.loads.size(); ++l)
        if (prepared.loads[l].body == b && prepared.scene.loads[l].kind == Load::Kind::distributed)
          add_force(b, all, free(structure, body.held, cell, total(structure.line(cell))), force_of(l), false);
    }
    MPI_Allreduce(MPI_IN_PLACE, &stiffest, 1, MPI_DOUBLE, MPI_MAX, comm);
    for (PetscInt dof : body.held) {
      const PetscInt local = dof - 6 * structure.mesh.first_node;
      if (local >= 0 && local < structure.owned_dofs())
        terms.push_back(std::make_unique<reference::HeldDof>(nodes[b]->first() + static_cast<int>(local), stiffest));
    }
    add_point_loads(b);
  }

  /// The element on those of its dofs that are not held.
  void add_cell(const PreparedBody& body, const fem::Mesh::Cell& cell, const fem::ElementMaps& maps,
                const std::vector<int>& all);

  static Eigen::MatrixXd total(const std::vector<body::MassPoint>& points) {
    Eigen::MatrixXd S;
    for (const body::MassPoint& point : points) {
      if (S.size() == 0) S = Eigen::MatrixXd::Zero(3, point.N.cols());
      S += point.mass * point.N;
    }
    return S;
  }

  static Eigen::MatrixXd free(const fem::Structure& structure, const fem::Conditions& held, const fem::Mesh::Cell& cell,
                              Eigen::MatrixXd S) {
    const std::vector<int> dofs = structure.cell_dofs(cell);
    if (S.size() == 0) S = Eigen::MatrixXd::Zero(3, static_cast<Eigen::Index>(dofs.size()));
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (std::binary_search(held.begin(), held.end(), structure.global_dof(dofs[i])))
        S.col(static_cast<Eigen::Index>(i)).setZero();
    return S;
  }

  void add_point_loads(int b) {
    const PreparedBody& body = prepared.bodies[b];
    const fem::Mesh& mesh = body.structure.mesh;
    for (std::size_t l = 0; l < prepared.loads.size(); ++l) {
      const PreparedPlace& place = prepared.loads[l];
      if (place.body != b || prepared.scene.loads[l].kind == Load::Kind::distributed) continue;
      for (PetscInt node : place.nodes) {
        if (node < mesh.first_node || node >= mesh.first_node + mesh.owned_nodes) continue;
        if (std::binary_search(body.held.begin(), body.held.end(), 6 * node)) continue;
        const int at = nodes[b]->of_node(node);
        add_force(b, {at, at + 1, at + 2}, Eigen::Matrix3d::Identity() / static_cast<double>(place.nodes.size()),
                  force_of(l), false);
      }
    }
  }

  HeldProbe probe(const PreparedPlace& place) const {
    const PreparedBody& body = prepared.bodies[place.body];
    HeldProbe held{body.origin, body.axes, place.x, {}, {}, {}};
    if (compact(place.body)) {
      const body::PlaceMap map = place_map(prepared, reduced[place.body], place);
      held.coordinates = reduced_coordinates(place.body);
      held.S = map.S, held.psi = map.psi;
      return held;
    }
    const double share = 1.0 / static_cast<double>(place.nodes.size());
    const Eigen::Index n = static_cast<Eigen::Index>(place.nodes.size());
    held.S = held.psi = Eigen::MatrixXd::Zero(3, 6 * n);
    if (!owner()) return held;  // the last rank evaluates probes
    for (Eigen::Index i = 0; i < n; ++i) {
      for (int d = 0; d < 6; ++d) held.coordinates.push_back(nodes[place.body]->of_node(place.nodes[i]) + d);
      held.S.block<3, 3>(0, 6 * i).setIdentity();
      held.psi.block<3, 3>(0, 6 * i + 3).setIdentity();
    }
    held.S *= share, held.psi *= share;
    return held;
  }
};

void HeldAssembly::add_cell(const PreparedBody& body, const fem::Mesh::Cell& cell, const fem::ElementMaps& maps,
                            const std::vector<int>& all) {
  const std::vector<int> dofs = body.structure.cell_dofs(cell);
  std::vector<int> kept, of;
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    if (std::binary_search(body.held.begin(), body.held.end(), body.structure.global_dof(dofs[i]))) continue;
    kept.push_back(static_cast<int>(i));
    of.push_back(all[i]);
  }
  if (kept.empty()) return;
  const Eigen::Index n = static_cast<Eigen::Index>(dofs.size()), k = static_cast<Eigen::Index>(kept.size());
  Eigen::MatrixXd V = Eigen::MatrixXd::Zero(n, k);
  for (Eigen::Index j = 0; j < k; ++j) V(kept[j], j) = 1;
  body::Elasticity elasticity = fem::elasticity(maps, V);
  if (formulation == Formulation::lffr) elasticity = body::linearised(elasticity);
  const Eigen::MatrixXd M = V.transpose() * with_drilling_inertia(body.structure, cell, maps.mass_matrix()) * V;
  const DampingSpec& damping = body.spec.damping;
  Eigen::MatrixXd C;
  if (damping.mass != 0 || damping.stiffness != 0)
    C = damping.mass * M + damping.stiffness * elasticity.linear_stiffness();
  terms.push_back(std::make_unique<dynamics::HeldBody>(of, M, std::move(elasticity), std::move(C)));
}

}  // namespace

Model held_model(const Prepared& prepared, Formulation formulation, const std::vector<ReducedBody>& reduced) {
  check_held(prepared, formulation);
  HeldAssembly assembly(prepared, formulation, reduced);
  assembly.add_coordinates();
  Model model;
  model.formulation = formulation;
  for (std::size_t b = 0; b < prepared.bodies.size(); ++b) {
    const int index = static_cast<int>(b);
    assembly.compact(index) ? assembly.add_reduced(index) : assembly.add_full(index);
    const PreparedBody& body = prepared.bodies[b];
    BodyReport report = reduced[b].report;
    const fem::Mesh& mesh = body.structure.mesh;
    report.name = body.spec.name;
    if (!body.spec.reduced)
      report.nodes = mesh.node_count, report.elements = mesh.cell_count, report.dofs = body.structure.dofs();
    report.dimension = 3;
    report.first_coordinate = -1, report.first_elastic = assembly.first[b];
    report.first_node = mesh.first_node;
    for (PetscInt i = 0; i < mesh.owned_nodes; ++i)
      report.positions.insert(report.positions.end(), mesh.positions[i].data(), mesh.positions[i].data() + 3);
    model.bodies.push_back(std::move(report));
    model.warnings.insert(model.warnings.end(), body.notices.begin(), body.notices.end());
  }
  for (std::size_t p = 0; p < prepared.probes.size(); ++p) {
    const Probe& spec = prepared.scene.probes[p];
    if (spec.relative_to) throw InputError(spec.where.text() + ".relative_to: does not apply in space");
    ModelProbe probe{spec.name,
                     spec.quantity,
                     {},
                     {},
                     {},
                     Eigen::Vector3d::Zero(),
                     Eigen::Vector3d::Zero(),
                     assembly.probe(prepared.probes[p][0])};
    model.probes.push_back(std::move(probe));
  }
  const dynamics::System layout(assembly.coordinates, {});
  model.U = layout.create_vector();
  model.V = layout.create_vector();
  model.coordinates = assembly.coordinates.global_size();
  model.system = std::make_unique<dynamics::System>(std::move(assembly.coordinates), std::move(assembly.terms));
  return model;
}

}  // namespace floe::scene
