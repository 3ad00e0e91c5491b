#include "floe/plan/ground_axes.h"

#include "floe/math/rotation.h"

namespace floe::plan {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::optional<Vector3d> line_of(const fem::Mesh& mesh, const Anchor& place) {
  if (place.nodes.size() < 2) return {};
  const auto own = [&](PetscInt node) -> const Vector3d* {
    const PetscInt local = node - mesh.first_node;
    return local >= 0 && local < mesh.owned_nodes ? &mesh.positions[local] : nullptr;
  };
  Matrix3d spread = Matrix3d::Zero();
  for (PetscInt node : place.nodes)
    if (const Vector3d* x = own(node)) spread += (*x - place.x) * (*x - place.x).transpose();
  MPI_Allreduce(MPI_IN_PLACE, spread.data(), 9, MPI_DOUBLE, MPI_SUM, mesh.comm);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(spread);
  const Vector3d& moments = principal.eigenvalues();
  if (!(moments[2] > 0 && moments[1] <= 1e-12 * moments[2])) return {};
  Vector3d line = Vector3d::Zero();
  if (const Vector3d* x = own(place.nodes.front())) line = place.x - *x;
  MPI_Allreduce(MPI_IN_PLACE, line.data(), 3, MPI_DOUBLE, MPI_SUM, mesh.comm);
  if (line.squaredNorm() > 1e-2 * moments[2] / static_cast<double>(place.nodes.size())) return line.normalized();
  Eigen::Index greatest = 0;  // the first node is in the middle
  line = principal.eigenvectors().col(2);
  line.cwiseAbs().maxCoeff(&greatest);
  return line[greatest] < 0 ? Vector3d(-line) : line;
}

Matrix3d axes_along(Matrix3d axes, int kept, const std::vector<Vector3d>& directions) {
  const auto complete = [&](Eigen::Index i) { axes.col(i) = axes.col((i + 1) % 3).cross(axes.col((i + 2) % 3)); };
  for (const Vector3d& e : directions) {
    const Vector3d within = axes.transpose() * e;
    const double greatest = within.cwiseAbs().maxCoeff();
    Eigen::Index k = 0;
    while (std::abs(within[k]) < greatest - 1e-9) ++k;  // the first of equal ones, whatever their round-off
    const bool aligned = greatest > 1 - 1e-12;
    if (aligned && (kept < 0 || kept == k)) kept = static_cast<int>(k);
    if (aligned && kept != k) return axes;
    if (aligned || (kept >= 0 && std::abs(within[kept]) > 1e-6)) continue;
    Vector3d along = within[k] < 0 ? -e : e;
    if (kept >= 0) {  // about it
      along -= axes.col(kept) * axes.col(kept).dot(along);
      axes.col(k) = along.normalized();
      complete(3 - kept - k);
      return axes;
    }
    axes = math::rotation_between(axes.col(k), along).toRotationMatrix() * axes;
    axes.col(k) = along;
    axes.col((k + 2) % 3) = along.cross(axes.col((k + 1) % 3)).normalized();
    complete((k + 1) % 3);
    kept = static_cast<int>(k);
  }
  return axes;
}

std::optional<Vector3d> axis_of_shape(const fem::Mesh& mesh) {
  Vector3d middle = Vector3d::Zero();
  for (int i = 0; i < mesh.owned_nodes; ++i) middle += mesh.positions[i];
  MPI_Allreduce(MPI_IN_PLACE, middle.data(), 3, MPI_DOUBLE, MPI_SUM, mesh.comm);
  middle /= static_cast<double>(mesh.node_count);
  Matrix3d spread = Matrix3d::Zero();
  for (int i = 0; i < mesh.owned_nodes; ++i)
    spread += (mesh.positions[i] - middle) * (mesh.positions[i] - middle).transpose();
  MPI_Allreduce(MPI_IN_PLACE, spread.data(), 9, MPI_DOUBLE, MPI_SUM, mesh.comm);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(spread);
  const Vector3d& moments = principal.eigenvalues();  // ascending
  if (!(moments[2] > 0)) return {};
  if (moments[1] <= 1e-12 * moments[2]) return Vector3d(principal.eigenvectors().col(2));
  if (moments[0] <= 1e-12 * moments[2]) return Vector3d(principal.eigenvectors().col(0));
  return {};
}

std::vector<Vector3d> ground_axes(const Scene& scene, const Body& body, const SpatialMesh& mesh) {
  using Kind = Joint::Kind;
  const auto vector = [](const Point& p) { return Vector3d(p[0], p[1], p[2]); };
  const Matrix3d to_mesh = math::rotation(vector(body.initial.rotation)).transpose();
  std::vector<Vector3d> edges, nodes;
  for (const Joint& joint : scene.joints)
    if (joint.kind == Kind::support && (joint.first.body == body.name || joint.second.body == body.name))
      return {Vector3d::UnitX(), Vector3d::UnitY()};  // its components are those of the mesh
  for (const Joint& joint : scene.joints) {
    const bool in_part = joint.kind == Kind::revolute || joint.kind == Kind::cylindrical ||
                         joint.kind == Kind::prismatic || joint.kind == Kind::planar;
    if (!in_part || joint.first.ground() == joint.second.ground()) continue;
    const Place& constrained = joint.first.ground() ? joint.second : joint.first;
    if (constrained.body != body.name) continue;
    const Anchor place = spatial_place(body, mesh.structure, mesh.places, constrained);
    const std::optional<Vector3d> line = line_of(mesh.structure.mesh, place);
    if (!joint.axis_given && !line) continue;
    const Vector3d axis = joint.axis_given ? to_mesh * vector(joint.axis).normalized() : *line;
    (place.nodes.size() > 1 ? edges : nodes).push_back(line && line->cross(axis).norm() < 1e-6 ? *line : axis);
  }
  edges.insert(edges.end(), nodes.begin(), nodes.end());
  return edges;
}

}  // namespace floe::plan
