#include "floe/plan/spatial_start.h"

#include "floe/error.h"
#include "floe/fem/element_stiffness.h"
#include "floe/fem/quadratic_beam.h"
#include "floe/fem/quadratic_shell.h"
#include "floe/math/rotation.h"
#include "floe/petsc/error.h"
#include "floe/petsc/values.h"

namespace floe::plan {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using petsc::check;

namespace {

using Formulas = std::optional<std::array<math::Formula, 3>>;

Vector3d vector(const Point& p) { return {p[0], p[1], p[2]}; }

Vector3d value(const Formulas& formulas, const Vector3d& X) {
  if (!formulas) return Vector3d::Zero();
  const auto& [u, v, w] = *formulas;
  return {u(X.x(), X.y(), X.z()), v(X.x(), X.y(), X.z()), w(X.x(), X.y(), X.z())};
}

/// d value / d along, along a unit vector, from values on one side: a formula need not go on behind the body.
/// Differences of fourth order. @param inward  that side: 1 along it, -1 against it
Vector3d slope(const Formulas& formulas, const Vector3d& X, const Vector3d& along, double inward, double h) {
  constexpr double weights[] = {-25, 48, -36, 16, -3};
  Vector3d sum = Vector3d::Zero();
  if (formulas)
    for (int k = 0; k < 5; ++k) sum += weights[k] * value(formulas, X + inward * k * h * along);
  return inward / (12 * h) * sum;
}

/// Where a place of the body is, and what becomes of its cell's directions; or rates of these.
struct Moved {
  Vector3d at;
  Matrix3d directions;  ///< of a line: the first; of a shell the first two
};

/// A corner of a cell: undeformed, deformed, and the rates, in mesh axes.
struct Corner {
  int node;  ///< local
  bool shell;
  Matrix3d cell;  ///< directions undeformed: of a line along it; of a shell two in its plane; normal to them
  Moved deformed, rate;
};

/// @param node  of the cell, where an element of second order is curved
Matrix3d directions_of(const fem::Mesh& mesh, const fem::Mesh::Cell& cell, std::size_t node, const Matrix3d& A) {
  const auto at = [&](int i) { return mesh.positions[cell.place[i]]; };
  if (mesh::is_quadratic(cell.kind)) {
    std::vector<Vector3d> x;
    for (const int place : cell.places()) x.push_back(mesh.positions[place]);
    return A * (mesh::is_line(cell.kind) ? fem::curve_axes(x)[node] : fem::surface_axes(x)[node]);
  }
  const Vector3d along = (at(1) - at(0)).normalized();
  Matrix3d D;
  D.col(0) = along;
  D.col(2) = cell.kind == fem::CellKind::line ? along.unitOrthogonal() : along.cross(at(2) - at(0)).normalized();
  D.col(1) = D.col(2).cross(along);
  return A * D;
}

/// The body's shape at the start.
struct Shape {
  const PlannedBody& body;
  std::vector<Moved> node, node_rate;  ///< of local nodes; directions are of no account
  std::vector<Corner> corners;

  /// @throws InputError  a formula yields no number somewhere on the body. Collective.
  explicit Shape(const PlannedBody& b) : body(b) {
    petsc::agree(b.structure.mesh.comm, [&] {
      try {
        sample();
      } catch (const math::FormulaError& error) {
        throw InputError(b.spec.initial.where.text() + ".deformation: " + error.what() +
                         "; expected a finite number at every point of the body (deformation_rate likewise)");
      }
    });
  }

 private:
  void sample() {
    const fem::Mesh& mesh = body.structure.mesh;
    const Formulas &d = body.spec.initial.spatial_deformation, &w = body.spec.initial.spatial_deformation_rate;
    const auto in_mesh = [&](int i) { return Vector3d(body.origin + body.axes * mesh.positions[i]); };
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const Vector3d X = in_mesh(static_cast<int>(i));
      node.push_back({X + value(d, X), Matrix3d::Zero()}), node_rate.push_back({value(w, X), Matrix3d::Zero()});
    }
    for (const auto& cell : mesh.cells) {
      if (!mesh::has_extent(cell.kind)) continue;
      const bool shell = mesh::is_shell(cell.kind);
      const double h = 1e-4 * (mesh.positions[cell.place[1]] - mesh.positions[cell.place[0]]).norm();
      Vector3d middle = Vector3d::Zero();
      for (int i : cell.corners()) middle += in_mesh(i) / static_cast<double>(cell.corners().size());
      for (std::size_t n = 0; n < cell.places().size(); ++n) {
        const int i = cell.places()[n];
        Corner c{i, shell, directions_of(mesh, cell, n, body.axes), node[i], node_rate[i]};
        for (int k = 0; k < (shell ? 2 : 1); ++k) {
          const double inward = c.cell.col(k).dot(middle - in_mesh(i)) < 0 ? -1 : 1;
          c.deformed.directions.col(k) = c.cell.col(k) + slope(d, in_mesh(i), c.cell.col(k), inward, h);
          c.rate.directions.col(k) = slope(w, in_mesh(i), c.cell.col(k), inward, h);
        }
        corners.push_back(c);
      }
    }
  }
};

/// The rotation of a corner from moved directions t, all in one frame's axes.
Vector3d rotation_of_shell(const Matrix3d& cell, const Vector3d& ta, const Vector3d& tb) {
  const Vector3d a = cell.col(0), b = cell.col(1), n = cell.col(2);
  return n.dot(ta) * a.cross(n) + n.dot(tb) * b.cross(n) + 0.5 * (b.dot(ta) - a.dot(tb)) * n;
}
Vector3d axial(const Matrix3d& M) { return 0.5 * Vector3d(M(2, 1) - M(1, 2), M(0, 2) - M(2, 0), M(1, 0) - M(0, 1)); }

/// Nodal values: displacements as given, rotations the mean of the corners'. Dependent nodes move with their
/// independent nodes.
template <class Displacement, class Rotation>
petsc::VecHandle nodal(const Shape& shape, Displacement displacement, Rotation rotation) {
  const fem::Structure& structure = shape.body.structure;
  const fem::Mesh& mesh = structure.mesh;
  Eigen::VectorXd local = Eigen::VectorXd::Zero(structure.local_dofs());
  for (const Corner& corner : shape.corners) {
    local[6 * corner.node] += 1;
    local.segment<3>(6 * corner.node + 3) += rotation(corner);
  }
  petsc::VecHandle field = fem::field(structure);
  structure.exchange.add(local, field);
  petsc::Values owned(field);
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i) {
    Eigen::Map<Eigen::Matrix<double, 6, 1>> q(owned.begin() + static_cast<std::ptrdiff_t>(6) * i);
    if (q[0] > 0) q.tail<3>() /= q[0];
    q.head<3>() = displacement(static_cast<int>(i));
  }
  for (const fem::Mesh::DependentNode& f : mesh.dependent_nodes) {
    Eigen::Map<Eigen::Matrix<double, 6, 1>> q(owned.begin() + static_cast<std::ptrdiff_t>(6) * f.node);
    const fem::Mesh::Spin* spin = fem::spin_of(mesh, f.node);
    const Vector3d theta = q.tail<3>();
    q.setZero();
    if (spin) q.tail<3>() = spin->own().transpose() * theta;
  }
  return field;
}

/// Of the frame in mesh axes.
struct Pose {
  Vector3d place;
  Matrix3d axes;
};

/// How the section of a beam is rotated in the frame.
Matrix3d section(const Corner& c, const Pose& pose, const Matrix3d& undeformed) {
  const Vector3d t = c.deformed.directions.col(0).normalized();
  return pose.axes.transpose() * math::rotation_between(c.cell.col(0), t).toRotationMatrix() * undeformed;
}

petsc::VecHandle displacement(const Shape& shape, const Pose& pose) {
  const Matrix3d to_frame = pose.axes.transpose(), &A = shape.body.axes;
  return nodal(
      shape,
      [&](int i) {
        return Vector3d(to_frame * (shape.node[i].at - pose.place) - shape.body.structure.mesh.positions[i]);
      },
      [&](const Corner& c) -> Vector3d {
        const Matrix3d cell = A.transpose() * c.cell, t = to_frame * c.deformed.directions;
        if (c.shell) return rotation_of_shell(cell, t.col(0), t.col(1));
        const Vector3d e = cell.col(0);
        return e.cross(t.col(0)) + e * e.dot(axial(section(c, pose, A)));
      });
}

/// A field of rates: of places, and of the directions of cells; spins of lines' sections. All in the frame's axes.
template <class Rate, class Rotated>
petsc::VecHandle rates(const Shape& shape, const Pose& pose, Rate rate, Rotated rotated) {
  const Matrix3d& A = shape.body.axes;
  return nodal(shape, rate, [&](const Corner& c) -> Vector3d {
    const Matrix3d cell = A.transpose() * c.cell;
    const auto [directions, spin] = rotated(c);
    if (c.shell) return rotation_of_shell(cell, directions.col(0), directions.col(1));
    const Vector3d e = cell.col(0);
    return e.cross(directions.col(0)) + e * e.dot(axial(math::skew(spin) * section(c, pose, A)));
  });
}

using Rotating = std::pair<Matrix3d, Vector3d>;

/// The deformed body rotates about the frame's origin at 1 rad/s.
petsc::VecHandle rotation(const Shape& shape, const Pose& pose, int about) {
  const Matrix3d rotation = math::skew(Vector3d::Unit(about)) * pose.axes.transpose();
  return rates(
      shape, pose, [&](int i) { return Vector3d(rotation * (shape.node[i].at - pose.place)); },
      [&](const Corner& c) { return Rotating(rotation * c.deformed.directions, Vector3d::Unit(about)); });
}

petsc::VecHandle given_rates(const Shape& shape, const Pose& pose) {
  const Matrix3d to_frame = pose.axes.transpose();
  return rates(
      shape, pose, [&](int i) { return Vector3d(to_frame * shape.node_rate[i].at); },
      [&](const Corner& c) {
        const Vector3d t = c.deformed.directions.col(0), change = c.rate.directions.col(0);
        return Rotating(to_frame * c.rate.directions, to_frame * t.cross(change) / t.squaredNorm());
      });
}

Eigen::Matrix<double, 6, 1> conditions(const fem::ReferenceFrame& frame, Vec field) {
  Eigen::Matrix<double, 6, 1> values;
  for (int i = 0; i < 6; ++i) check(VecDot(frame.functionals[i], field, &values[i]));
  return values;
}

Pose frame_pose(const Shape& shape, double size) {
  const PlannedBody& body = shape.body;
  Pose pose{body.origin, body.axes};
  for (int iteration = 0; iteration < 60; ++iteration) {
    const Eigen::Matrix<double, 6, 1> motion = body.frame.inverse * conditions(body.frame, displacement(shape, pose));
    if (!motion.allFinite() || motion.tail<3>().norm() > 1) break;
    pose.place += pose.axes * motion.head<3>();
    pose.axes = pose.axes * math::rotation(motion.tail<3>());
    if (motion.head<3>().norm() <= 1e-11 * size && motion.tail<3>().norm() <= 1e-11) return pose;
  }
  throw InputError(body.spec.initial.where.text() +
                   ".deformation: no position of the floating frame satisfies its conditions on the deformed body; "
                   "expected a smaller deformation, or another frame");
}

/// How the frame moves in its own axes; the body's rates lose it.
Eigen::Matrix<double, 6, 1> frame_rates(const Shape& shape, const Pose& pose, Vec field) {
  const fem::ReferenceFrame& frame = shape.body.frame;
  std::vector<petsc::VecHandle> rotations;
  std::array<Vec, 6> motions{};
  Eigen::Matrix<double, 6, 6> G;
  for (int j = 0; j < 3; ++j) rotations.push_back(rotation(shape, pose, j));
  for (int j = 0; j < 6; ++j) {
    motions[j] = j < 3 ? frame.rigid[j].get() : rotations[j - 3].get();
    G.col(j) = conditions(frame, motions[j]);
  }
  Eigen::Matrix<double, 6, 1> motion = G.fullPivLu().solve(conditions(frame, field));
  for (int j = 0; j < 6; ++j) check(VecAXPY(field, -motion[j], motions[j]));
  fem::to_frame(frame, field);
  return motion;
}

}  // namespace

void start_spatial_body(PlannedBody& body) {
  const InitialSpec& start = body.spec.initial;
  Pose pose{body.origin, body.axes};
  Eigen::Matrix<double, 6, 1> moves = Eigen::Matrix<double, 6, 1>::Zero();
  if (is_meshed(body.spec) && (start.spatial_deformation || start.spatial_deformation_rate)) {
    const Shape shape(body);
    if (start.spatial_deformation) {
      body.linear_start_energy = fem::ElementStiffness(body.structure).strain_energy(displacement(shape, pose));
      pose = frame_pose(shape, fem::extent(body.structure));
      body.deformation = displacement(shape, pose);
      fem::to_frame(body.frame, body.deformation);
    }
    if (start.spatial_deformation_rate) {
      body.deformation_rate = given_rates(shape, pose);
      moves = frame_rates(shape, pose, body.deformation_rate);
    }
  }
  const Matrix3d Q = math::rotation(vector(start.rotation));
  const Vector3d arm = Q * pose.place, spin = vector(start.angular_velocity);
  body.attitude = Q * pose.axes;
  body.place = vector(start.position) + arm;
  body.rate = vector(start.velocity) + spin.cross(arm) + body.attitude * moves.head<3>();
  body.spin = body.attitude.transpose() * spin + moves.tail<3>();
}

}  // namespace floe::plan
