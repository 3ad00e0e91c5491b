#include "floe/plan/planar_start.h"

#include <cmath>

#include "floe/fem/element_stiffness.h"
#include "floe/petsc/values.h"

namespace floe::plan {

using petsc::check;

namespace {

using Formulas = std::optional<std::array<math::Formula, 2>>;
using CellEnds = std::array<Eigen::Vector2d, 2>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }
Eigen::Vector2d across(const Eigen::Vector2d& a) { return {-a.y(), a.x()}; }

/// A field of the plane on this rank, or the axis of the undeformed body, in mesh axes.
struct Samples {
  std::vector<Eigen::Vector2d> values;  ///< at owned nodes
  std::vector<CellEnds> slopes;         ///< along the cells, at both of their ends
};

Samples undeformed(const PlannedBody& body) {
  const fem::Mesh& mesh = body.structure.mesh;
  const Eigen::Matrix2d A = rotation_matrix(body.frame_angle);
  Samples axis;
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i)
    axis.values.push_back(body.frame_origin + A * mesh.positions[i].head<2>());
  for (const auto& cell : mesh.cells) {
    const Eigen::Vector2d along =
        A * (mesh.positions[cell.place[1]] - mesh.positions[cell.place[0]]).head<2>().normalized();
    axis.slopes.push_back({along, along});
  }
  return axis;
}

/// The derivative along the cell at its end `x`, from values within the cell: a formula need not go on behind it.
/// Differences of fourth order.
template <class Value>
Eigen::Vector2d slope_at(const Eigen::Vector2d& x, const Eigen::Vector2d& inward, double h, Value value) {
  constexpr double weights[] = {-25, 48, -36, 16, -3};
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int k = 0; k < 5; ++k) sum += weights[k] * value(x + k * h * inward);
  return sum / (12 * h);
}

/// @param key  of the formulas, for complaints. Collective.
/// @throws InputError  one of them yields no number somewhere on the body
Samples sampled(const PlannedBody& body, const Samples& axis, const Formulas& formulas, const char* key) {
  const fem::Mesh& mesh = body.structure.mesh;
  auto value = [&](const Eigen::Vector2d& X) -> Eigen::Vector2d {
    if (!formulas) return Eigen::Vector2d::Zero();
    return {(*formulas)[0](X.x(), X.y()), (*formulas)[1](X.x(), X.y())};
  };
  Samples field;
  petsc::agree(mesh.comm, [&] {
    try {
      for (const Eigen::Vector2d& X : axis.values) field.values.push_back(value(X));
      for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        const auto& nodes = mesh.cells[c].place;
        CellEnds& slopes = field.slopes.emplace_back();
        const double h = 1e-4 * (mesh.positions[nodes[1]] - mesh.positions[nodes[0]]).norm();
        for (int i = 0; i < 2; ++i) {
          const Eigen::Vector2d X =
              body.frame_origin + rotation_matrix(body.frame_angle) * mesh.positions[nodes[i]].head<2>();
          const double inward = i == 0 ? 1 : -1;
          slopes[i] = inward * slope_at(X, inward * axis.slopes[c][i], h, value);
        }
      }
    } catch (const math::FormulaError& error) {
      throw InputError(body.spec.initial.where.text() + "." + key + ": " + error.what() +
                       "; expected a finite number at every point of the body");
    }
  });
  return field;
}

/// Nodal values: displacements as given at owned nodes, rotations the mean of what the cells' ends give.
template <class Displacement, class Rotation>
petsc::VecHandle nodal(const fem::Structure& structure, Displacement displacement, Rotation rotation) {
  const fem::Mesh& mesh = structure.mesh;
  Eigen::VectorXd local = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(mesh.positions.size()));
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    for (int i = 0; i < 2; ++i) {
      local[3 * mesh.cells[c].place[i]] += 1;
      local[3 * mesh.cells[c].place[i] + 2] += rotation(c, i);
    }
  }
  petsc::VecHandle vector = fem::field(structure);
  structure.exchange.add(local, vector);
  petsc::Values owned(vector);
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i) {
    double* node = owned.begin() + static_cast<std::ptrdiff_t>(3) * i;
    node[2] /= node[0];
    Eigen::Map<Eigen::Vector2d>{node} = displacement(i);
  }
  return vector;
}

/// The deformed body: its axis in mesh axes, and what is made of it in the frame at a pose.
struct DeformedBody {
  const PlannedBody& body;
  Samples undeformed, axis;  ///< mesh axes

  DeformedBody(const PlannedBody& b) : body(b), undeformed(plan::undeformed(b)) {
    axis = sampled(b, undeformed, b.spec.initial.deformation, "deformation");
    for (std::size_t i = 0; i < axis.values.size(); ++i) axis.values[i] += undeformed.values[i];
    for (std::size_t c = 0; c < axis.slopes.size(); ++c)
      for (int i = 0; i < 2; ++i) axis.slopes[c][i] += undeformed.slopes[c][i];
  }
  Eigen::Vector2d rest(PetscInt node) const { return body.structure.mesh.positions[node].head<2>(); }
  Eigen::Vector2d along(std::size_t cell) const {
    return rotation_matrix(-body.frame_angle) * undeformed.slopes[cell][0];
  }

  petsc::VecHandle displacement(const Eigen::Vector3d& pose) const {
    const Eigen::Matrix2d At = rotation_matrix(-pose[2]);
    return nodal(
        body.structure, [&](PetscInt i) { return Eigen::Vector2d(At * (axis.values[i] - pose.head<2>()) - rest(i)); },
        [&](std::size_t c, int i) { return cross(along(c), At * axis.slopes[c][i]); });
  }
  /// J (x + u'): the body rotates about the frame's origin at 1 rad/s.
  petsc::VecHandle rotation(const Eigen::Vector3d& pose) const {
    const Eigen::Matrix2d At = rotation_matrix(-pose[2]);
    return nodal(
        body.structure, [&](PetscInt i) { return across(Eigen::Vector2d(At * (axis.values[i] - pose.head<2>()))); },
        [&](std::size_t c, int i) { return along(c).dot(At * axis.slopes[c][i]); });
  }
  petsc::VecHandle rate(const Eigen::Vector3d& pose, const Samples& w) const {
    const Eigen::Matrix2d At = rotation_matrix(-pose[2]);
    return nodal(
        body.structure, [&](PetscInt i) { return Eigen::Vector2d(At * w.values[i]); },
        [&](std::size_t c, int i) { return cross(along(c), At * w.slopes[c][i]); });
  }
};

/// Rigid motions (c, theta_t) of the deformed body that move the frame's conditions as `field` does.
struct RigidPart {
  Eigen::Vector3d motion;
  double regularity;  ///< determinant by which the conditions fix the frame, 1: as of the undeformed body
};

RigidPart rigid_part(const fem::ReferenceFrame& frame, Vec rotation, Vec field) {
  const Vec motions[3] = {frame.rigid[0], frame.rigid[1], rotation};
  Eigen::Matrix3d G;
  Eigen::Vector3d moved;
  for (int i = 0; i < 3; ++i) {
    check(VecDot(frame.functionals[i], field, &moved[i]));
    for (int j = 0; j < 3; ++j) check(VecDot(frame.functionals[i], motions[j], &G(i, j)));
  }
  return {G.fullPivLu().solve(moved), (frame.inverse * G).determinant()};
}

/// Where the deformed body lies on the whole: the rotation that takes the undeformed nodes nearest to the deformed
/// ones.
double mean_rotation(const DeformedBody& deformed) {
  Eigen::Matrix<double, 7, 1> sums = Eigen::Matrix<double, 7, 1>::Zero();
  for (std::size_t i = 0; i < deformed.axis.values.size(); ++i) {
    const Eigen::Vector2d &X = deformed.undeformed.values[i], &Y = deformed.axis.values[i];
    sums.head<2>() += X, sums.segment<2>(2) += Y;
    sums.tail<3>() += Eigen::Vector3d(cross(X, Y), X.dot(Y), 1);
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 7, MPI_DOUBLE, MPI_SUM, deformed.body.structure.mesh.comm);
  const Eigen::Vector2d X = sums.head<2>() / sums[6], Y = sums.segment<2>(2);
  return std::atan2(sums[4] - cross(X, Y), sums[5] - X.dot(Y));
}

Eigen::Vector3d frame_pose(const DeformedBody& deformed) {
  const PlannedBody& body = deformed.body;
  double size = 0;
  for (const Point& p : body.spec.mesh.points)
    for (const Point& q : body.spec.mesh.points) size = std::max(size, std::hypot(p[0] - q[0], p[1] - q[1]));
  Eigen::Vector3d pose;
  pose << body.frame_origin, body.frame_angle + mean_rotation(deformed);
  for (int iteration = 0; iteration < 30; ++iteration) {
    const auto [motion, regularity] = rigid_part(body.frame, deformed.rotation(pose), deformed.displacement(pose));
    if (!motion.allFinite()) break;
    pose.head<2>() += rotation_matrix(pose[2]) * motion.head<2>();
    pose[2] += motion[2];
    if (motion.head<2>().norm() > 1e-10 * size || std::abs(motion[2]) > 1e-10) continue;
    if (regularity < 1e-3) break;
    return pose;
  }
  throw InputError(body.spec.initial.where.text() +
                   ".deformation: no position of the floating frame satisfies its conditions on the deformed body; "
                   "expected a smaller deformation, or another frame");
}

}  // namespace

void start_body(PlannedBody& body) {
  const InitialSpec& start = body.spec.initial;
  Eigen::Vector3d pose, rates = Eigen::Vector3d::Zero();  // of the frame in mesh axes
  pose << body.frame_origin, body.frame_angle;
  if (!body.spec.rigid && (start.deformation || start.deformation_rate)) {
    const DeformedBody deformed(body);
    if (start.deformation) {
      body.linear_start_energy = fem::ElementStiffness(body.structure).strain_energy(deformed.displacement(pose));
      pose = frame_pose(deformed);
      body.deformation = deformed.displacement(pose);
      fem::to_frame(body.frame, body.deformation);
    }
    if (start.deformation_rate) {
      body.deformation_rate =
          deformed.rate(pose, sampled(body, deformed.undeformed, start.deformation_rate, "deformation_rate"));
      const petsc::VecHandle rotation = deformed.rotation(pose);
      const Eigen::Vector3d motion = rigid_part(body.frame, rotation, body.deformation_rate).motion;
      rates << rotation_matrix(pose[2]) * motion.head<2>(), motion[2];
      check(VecAXPY(body.deformation_rate, -motion[0], body.frame.rigid[0]));
      check(VecAXPY(body.deformation_rate, -motion[1], body.frame.rigid[1]));
      check(VecAXPY(body.deformation_rate, -motion[2], rotation));
      fem::to_frame(body.frame, body.deformation_rate);
    }
  }
  const Eigen::Matrix2d A = rotation_matrix(start.angle);
  const Eigen::Vector2d arm = A * pose.head<2>();
  body.pose << Eigen::Vector2d(start.position[0], start.position[1]) + arm, start.angle + pose[2];
  body.velocity << Eigen::Vector2d(start.velocity[0], start.velocity[1]) + start.angular_velocity[2] * across(arm) +
                       A * rates.head<2>(),
      start.angular_velocity[2] + rates[2];
}

Eigen::MatrixX2d section_angles(const PlannedBody& body) {
  const InitialSpec& start = body.spec.initial;
  Eigen::MatrixX2d angles = Eigen::MatrixX2d::Zero(body.structure.mesh.owned_nodes, 2);
  if (!start.deformation && !start.deformation_rate) return angles;
  const DeformedBody deformed(body);
  const Samples w = sampled(body, deformed.undeformed, start.deformation_rate, "deformation_rate");
  const Eigen::Matrix2d At = rotation_matrix(start.angle - body.pose[2]);
  const double rotated = body.velocity[2] - start.angular_velocity[2];  // of the frame in mesh axes
  auto none = [](PetscInt) { return Eigen::Vector2d(Eigen::Vector2d::Zero()); };
  const petsc::VecHandle fields[2] = {nodal(body.structure, none,
                                            [&](std::size_t c, int i) {
                                              const Eigen::Vector2d t = At * deformed.axis.slopes[c][i],
                                                                    e = deformed.along(c);
                                              return std::atan2(cross(e, t), e.dot(t));
                                            }),
                                      nodal(body.structure, none, [&](std::size_t c, int i) {
                                        const Eigen::Vector2d& t = deformed.axis.slopes[c][i];
                                        return cross(t, w.slopes[c][i]) / t.squaredNorm() - rotated;
                                      })};
  for (int k = 0; k < 2; ++k) {
    petsc::Values owned(fields[k]);
    for (Eigen::Index i = 0; i < angles.rows(); ++i) angles(i, k) = owned.begin()[3 * i + 2];
  }
  return angles;
}

}  // namespace floe::plan
