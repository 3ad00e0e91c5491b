#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "floe/assembly/damping.h"
#include "floe/assembly/reduce_bodies.h"
#include "floe/assembly/reduced_bodies_file.h"
#include "floe/fem/element_count.h"
#include "floe/fem/pressure.h"
#include "floe/math/nearest.h"
#include "floe/output/claim.h"
#include "floe/petsc/values.h"
#include "floe/plan/held_by_modes.h"
#include "floe/plan/mesh_copy.h"
#include "floe/plan/place_weights.h"
#include "floe/reduction/place_set.h"
#include "floe/reduction/pressure.h"
#include "floe/scene/places.h"

namespace floe::assembly {

using petsc::check;

namespace {

int index_of(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const Body& body : scene.bodies) names.push_back(body.name);
  if (name.empty() && names.size() != 1)
    throw InputError(fmt::format("{}: has {} bodies ({}); expected the name of one (--body NAME)", scene.file,
                                 names.size(), fmt::join(names, ", ")));
  const auto found = name.empty() ? names.begin() : std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    const std::string near = math::nearest(name, names);
    throw InputError(fmt::format("{}: there is no body \"{}\"; expected one of {}{}", scene.file, name,
                                 fmt::join(names, ", "), near.empty() ? "" : "; did you mean \"" + near + "\"?"));
  }
  const Body& body = scene.bodies[found - names.begin()];
  if (body.rigid) throw InputError(fmt::format("{}: is rigid; expected a body with modes", body.where.text()));
  if (body.reduced)
    throw InputError(fmt::format("{}: is reduced already; expected a body with a mesh", body.reduced->where.text()));
  return static_cast<int>(found - names.begin());
}

/// Scene with the body alone, and what the ground and loads do to it.
Scene alone(const Scene& scene, int index) {
  Scene part = scene;
  const std::string& name = scene.bodies[index].name;
  part.bodies = {scene.bodies[index]};
  const auto stays = [&](const Place& place) { return place.ground() || place.body == name; };
  std::erase_if(part.joints,
                [&](const Joint& joint) { return (joint.first.body != name && joint.second.body != name); });
  for (Joint& joint : part.joints)  // another body is, for this one, a place that is not constrained
    for (Place* place : {&joint.first, &joint.second})
      if (!stays(*place)) *place = Place{}, place->where = joint.where;
  std::erase_if(part.loads, [&](const Load& load) {
    if (!load.joint.empty())
      return std::none_of(part.joints.begin(), part.joints.end(),
                          [&](const Joint& joint) { return joint.name == load.joint; });
    return load.spread() ? load.body != name : load.at.body != name;
  });
  for (Load& load : part.loads)
    if (!load.joint.empty() && !stays(load.at)) load.at = Place{}, load.at.where = load.where;
  std::erase_if(part.probes, [&](const Probe& probe) {
    return probe.at.body != name || (probe.relative_to && !stays(*probe.relative_to));
  });
  return part;
}

/// |eta_i eta_j| of fields that loads move alike: eta_i = 1 / phi_i' K phi_i, the static answer to a unit generalised
/// force, 1 / omega_i^2 of a mode. No motion is known that could show more.
Eigen::MatrixXd interaction_at_unit_force(const ReducedBody& linear) {
  const Eigen::MatrixXd fields = linear.of_fields.inverse();  // in the coordinates of the basis
  const Eigen::VectorXd stiffness =
      (fields.transpose() * linear.body.elasticity.linear_stiffness() * fields).diagonal();
  const Eigen::VectorXd eta = (stiffness.array() > 0).select(stiffness.array().inverse(), 0);
  return eta * eta.transpose();
}

output::ReducedFrame frame_of(const PlannedBody& body) {
  if (body.structure.dimension() == 3) return {name_of(body.frame.kind), body.origin, body.axes};
  return {name_of(body.frame.kind), body.frame_origin, rotation_matrix(body.frame_angle)};
}

std::vector<output::ReducedPlace> places_of(const Plan& plan, const PlannedBody& body, const reduction::Basis& basis) {
  mesh::NodeSets sets = body.places;
  const auto add = [&](const Place& place, const Anchor& found) {
    if (found.body < 0) return;
    sets.emplace(name_in_file(place, body.structure.dimension()),
                 mesh::NodeSet{found.nodes.empty() ? std::vector<PetscInt>{found.node} : found.nodes});
  };
  const Scene& scene = plan.scene;
  for (std::size_t j = 0; j < scene.joints.size(); ++j)
    add(scene.joints[j].first, plan.joints[j][0]), add(scene.joints[j].second, plan.joints[j][1]);
  for (std::size_t l = 0; l < scene.loads.size(); ++l)
    if (!scene.loads[l].spread()) add(scene.loads[l].at, plan.loads[l]);
  for (std::size_t p = 0; p < scene.probes.size(); ++p) add(scene.probes[p].at, plan.probes[p][0]);
  if (body.structure.dimension() == 2) {
    for (const std::string& name : place_names(body.spec.mesh)) {
      const Point p = place_point(body.spec.mesh, {body.spec.name, name, {}, {}});
      const Eigen::Vector2d x = rotation_matrix(-body.frame_angle) * (Eigen::Vector2d(p[0], p[1]) - body.frame_origin);
      sets.emplace(name, mesh::NodeSet{{fem::nearest_node(body.structure.mesh, {x.x(), x.y(), 0}).node}});
    }
  }
  std::vector<output::ReducedPlace> places;
  for (const auto& [name, set] : sets)
    if (!set.nodes.empty())
      places.push_back({name, reduction::place_map(body.structure, basis, weights_of(body.structure, set))});
  return places;
}

/// Of every part that has shells. Collective.
std::vector<output::ReducedPressure> pressures_of(const PlannedBody& body, const reduction::Basis& basis) {
  std::vector<output::ReducedPressure> pressures;
  const fem::Mesh& mesh = body.structure.mesh;
  std::vector<int> shells(body.parts.size(), 0);
  for (const fem::Mesh::Cell& cell : mesh.cells)
    if (fem::is_shell(cell)) shells[cell.part] = 1;
  MPI_Allreduce(MPI_IN_PLACE, shells.data(), static_cast<int>(shells.size()), MPI_INT, MPI_MAX, mesh.comm);
  for (std::size_t part = 0; part < shells.size(); ++part) {
    if (shells[part] == 0) continue;
    const auto here = [&](const fem::Mesh::Cell& cell) { return cell.part == static_cast<int>(part); };
    body::Pressure unit = reduction::pressure(body.structure, basis, here);
    const auto same = std::find_if(pressures.begin(), pressures.end(),
                                   [&](const output::ReducedPressure& one) { return one.part == body.parts[part]; });
    if (same == pressures.end())
      pressures.push_back({body.parts[part], std::move(unit)});
    else  // parts of one name count together
      same->unit += unit;
  }
  return pressures;
}

std::vector<output::ReducedColumn> columns_of(const BodyReport& report) {
  using Kind = reduction::ColumnOrigin::Kind;
  std::vector<output::ReducedColumn> columns;
  for (const reduction::ColumnOrigin& o : report.origins)
    columns.push_back({o.kind == Kind::mode         ? "mode"
                       : o.kind == Kind::derivative ? "derivative"
                                                    : "attachment",
                       o.label, o.omega, o.new_part, o.kept, o.interaction, o.dropped});
  return columns;
}

/// With the sets of nodes; the columns are read from the basis when they are written.
output::ReducedShapes shapes_of(const PlannedBody& body, const reduction::Basis& basis) {
  const fem::Mesh& mesh = body.structure.mesh;
  output::ReducedShapes shapes = mesh_copy(body);
  for (const auto& [name, set] : body.places) {
    std::vector<std::int64_t>& mine = shapes.sets[name];
    for (const PetscInt node : set.nodes)
      if (node >= mesh.first_node && node < mesh.first_node + mesh.owned_nodes)
        mine.push_back(mesh.original_node(static_cast<int>(node - mesh.first_node)));
  }
  shapes.column = [&basis, &structure = body.structure](int j, std::span<double> values) {
    Vec column = nullptr;
    check(BVGetColumn(basis.V, j, &column));
    {
      petsc::Values own(column);
      std::copy(own.begin(), own.begin() + values.size(), values.begin());
    }
    check(BVRestoreColumn(basis.V, j, &column));
    const Eigen::Index n = structure.dofs_per_node;
    for (const fem::Mesh::DependentNode& f : structure.mesh.dependent_nodes)
      Eigen::Map<Eigen::VectorXd>(values.data() + n * f.node, n) = fem::nodal_motion(structure, values.data(), f.node);
  };
  return shapes;
}

/// The body on its columns, for the file.
output::ReducedBodyFile file_of(const Plan& plan, const PlannedBody& body, const ReducedBody& reduced) {
  const BodyReport& report = reduced.report;
  output::ReducedBodyFile file;
  file.name = body.spec.name;
  file.dimension = body.structure.dimension();
  file.dofs = body.structure.dofs(), file.nodes = body.structure.mesh.node_count;
  file.cells = fem::element_count(body.structure.mesh);
  file.body = reduced.body;
  file.omitted_products = report.omitted_products;
  for (std::size_t b = 0; b < plan.bodies.size(); ++b)
    if (plan.bodies[b].spec.name == body.spec.name) {
      file.damping = linear_damping(plan, static_cast<int>(b), reduced);
      file.held = held_by_modes(plan, static_cast<int>(b));
    }
  file.strain_rate_damping = body.spec.damping.stiffness;
  file.places = places_of(plan, body, *reduced.basis);
  file.pressures = pressures_of(body, *reduced.basis);
  file.columns = columns_of(report);
  file.omega = report.omega, file.residual = report.residual;
  file.frame = frame_of(body);
  file.made = output::made_here(plan.comm, plan.scene.text);
  file.made.seconds = {{"modes", report.seconds_modes},
                       {"derivatives", report.seconds_derivatives},
                       {"projection", report.seconds_projection}};
  return file;
}

}  // namespace

void write_body(const Plan& plan, const PlannedBody& body, const ReducedBody& reduced,
                const std::filesystem::path& path, bool overwrite) {
  const output::ReducedBodyFile file = file_of(plan, body, reduced);
  const output::ReducedShapes shapes = shapes_of(body, *reduced.basis);
  output::write_reduced_body(plan.comm, path, file, overwrite, &shapes);
}

output::ReducedBodyFile reduce_body(const Scene& scene, const std::string& name, MPI_Comm comm,
                                    const std::filesystem::path& path, bool overwrite,
                                    std::vector<std::string>& warnings) {
  const int index = index_of(scene, name);
  const output::Claim claim = output::claim_file(comm, path);
  output::check_reduced_path(comm, path, overwrite);
  const double start = MPI_Wtime();
  if (scene.bodies[index].reduction.responses > 0)
    throw InputError(
        fmt::format("{}: needs a simulation of the whole scene; floe reduce has the body alone, and expects no "
                    "responses",
                    scene.bodies[index].reduction.responses_where.text()));
  const Scene part = alone(scene, index);
  const Plan plan = prepare(part, comm);
  const PlannedBody& body = plan.bodies[0];
  warnings = body.notices;
  const DampingSpec& damping = body.spec.damping;
  if ((damping.mass != 0 || !damping.modal.empty()) && scene.bodies.size() > 1)
    warnings.push_back(fmt::format(
        "body {}: the file stores {} for the body with its joints to the ground; joints to the other {} bodies of the "
        "scene are not included",
        body.spec.name,
        damping.modal.empty() ? "damping.mass"
        : damping.mass == 0   ? "damping.modal"
                              : "damping.mass and damping.modal",
        scene.bodies.size() - 1));
  if (scene.bodies[index].frames > 1)
    warnings.push_back(fmt::format("body {}: frames: {} is not used: the file has the whole body in one frame",
                                   body.spec.name, scene.bodies[index].frames));
  std::vector<std::string> supports;
  for (const Joint& joint : part.joints)
    if (joint.kind == Joint::Kind::support) supports.push_back(joint.name);
  if (!supports.empty())
    warnings.push_back(
        fmt::format("body {}: its basis vectors satisfy its supports ({}), which scenes that use the file cannot have",
                    body.spec.name, fmt::join(supports, ", ")));
  const double meshed = MPI_Wtime();
  const std::vector<ReducedBody> reduced = reduce_bodies(
      plan, Formulation::vm_md,
      [](const std::vector<ReducedBody>& linear) { return std::vector{interaction_at_unit_force(linear[0])}; },
      warnings);
  output::ReducedBodyFile file = file_of(plan, body, reduced[0]);
  file.made.seconds["mesh"] = meshed - start;
  const output::ReducedShapes shapes = shapes_of(body, *reduced[0].basis);
  output::write_reduced_body(comm, path, file, overwrite, &shapes);
  file.has_shapes = true;
  return file;
}

}  // namespace floe::assembly
