#include "moderate_rotations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

#include "floe/math/rotation.h"
#include "floe/petsc/all_ranks.h"

namespace floe::assess {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

double bending_stiffness(const fem::Section& section) {
  if (const auto* plane = std::get_if<fem::BeamSection>(&section)) return plane->EI;
  const auto* space = std::get_if<fem::SpatialBeam>(&section);
  const bool bends = space && space->releases.none();  // of released ends the nodes do not know the slope
  return bends ? std::sqrt(space->section.EIy * space->section.EIz) : 0;
}

constexpr int numbers = 13;  // of an element on its way between ranks

std::array<double, numbers> packed(const fem::Structure& structure, const fem::Mesh::Cell& cell,
                                   const std::array<int, 2>& ends, const Eigen::VectorXd& local) {
  const fem::Mesh& mesh = structure.mesh;
  const int a = cell.moved[ends[0]], b = cell.moved[ends[1]], n = structure.dofs_per_node;
  const Vector3d along = mesh.positions[cell.place[ends[1]]] - mesh.positions[cell.place[ends[0]]];
  const auto rotation = [&](int node) {
    return n == 3 ? Vector3d(0, 0, local[3 * node + 2]) : Vector3d(local.segment<3>(6 * node + 3));
  };
  std::array<double, numbers> out{static_cast<double>(mesh.original_node(a)),
                                  static_cast<double>(mesh.original_node(b)), along.norm(),
                                  bending_stiffness(structure.sections[cell.part])};
  Eigen::Map<Vector3d>(out.data() + 4) = along.normalized();
  Eigen::Map<Vector3d>(out.data() + 7) = rotation(a);
  Eigen::Map<Vector3d>(out.data() + 10) = rotation(b);
  return out;
}

BentElement unpacked(const double* in) {
  BentElement one;
  one.node[0] = static_cast<PetscInt>(in[0]), one.node[1] = static_cast<PetscInt>(in[1]);
  one.length = in[2], one.stiffness = in[3];
  one.direction = Eigen::Map<const Vector3d>(in + 4);
  one.rotation[0] = Eigen::Map<const Vector3d>(in + 7), one.rotation[1] = Eigen::Map<const Vector3d>(in + 10);
  return one;
}

/// An element of a path, from the node nearer to the root on; `frame` from its floating frame to that of the first.
struct Link {
  BentElement element;
  Matrix3d frame = Matrix3d::Identity();
  Vector3d slope(int end) const { return element.rotation[end].cross(element.direction); }
  Vector3d moment() const {
    return frame * ((element.rotation[1] - element.rotation[0]) * (element.stiffness / element.length));
  }
};
using Path = std::vector<Link>;

BentElement reversed(BentElement one) {
  std::swap(one.node[0], one.node[1]), std::swap(one.rotation[0], one.rotation[1]);
  one.direction = -one.direction;
  return one;
}

/// t(p) = cos|p| e + sin|p| p/|p|
Vector3d tangent(const Vector3d& e, const Vector3d& p) {
  const double angle = p.norm();
  return std::cos(angle) * e + (angle > 0 ? std::sin(angle) / angle : 1) * p;
}

/// Of a path: what the moments change by, and what is wrong of its places.
class PathError {
 public:
  PathError(Path path, int degree) : path_(std::move(path)), degree_(degree) {
    for (const Link& link : path_) moments_.push_back(link.moment());
    gradients_ = gradients();
    hinged_ = find_hinged();
  }
  double operator()() {
    find_rotations();
    return greatest_shift();
  }
  double moment_at(bool end) const {
    const std::size_t n = moments_.size();
    if (n < 2) return moments_[0].norm();
    return (end ? 1.5 * moments_[n - 1] - 0.5 * moments_[n - 2] : 1.5 * moments_[0] - 0.5 * moments_[1]).norm();
  }

 private:
  bool find_hinged() const {
    double most = 0;
    for (const Vector3d& moment : moments_) most = std::max(most, moment.norm());
    return moment_at(false) < 0.1 * most && moment_at(true) < 0.1 * most;
  }

  /// M' h of each element from a polynomial through M, least squares with weights that vanish at both ends: what modes
  /// make of a moment at an end, waves that drop to zero there, is no force.
  std::vector<Vector3d> gradients() const {
    const Eigen::Index n = static_cast<Eigen::Index>(path_.size()), terms = std::min<Eigen::Index>(degree_ + 1, n);
    double length = 0, at = 0;
    for (const Link& link : path_) length += link.element.length;
    Eigen::MatrixXd powers(n, terms), slopes = Eigen::MatrixXd::Zero(n, terms), M(n, 3);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double h = path_[k].element.length, x = (at + h / 2) / length, weight = x * (1 - x);
      for (Eigen::Index i = 0; i < terms; ++i) {
        powers(k, i) = weight * std::pow(2 * x - 1, i);
        if (i > 0) slopes(k, i) = 2 * h / length * static_cast<double>(i) * std::pow(2 * x - 1, i - 1);
      }
      M.row(k) = weight * moments_[k].transpose(), at += h;
    }
    const Eigen::MatrixXd change = slopes * Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(powers).solve(M);
    std::vector<Vector3d> all;
    for (Eigen::Index k = 0; k < n; ++k) all.push_back(change.row(k).transpose());
    return all;
  }

  /// (cos|p + d| - 1) M' h/2 of element k at one of its ends, and what its derivative adds to the stiffness there.
  std::pair<Vector3d, double> arm(std::size_t k, int end) const {
    const Link& link = path_[k];
    const Vector3d d = link.frame.transpose() * rotations_[k + end], f = gradients_[k] / 2;
    const Vector3d p = (link.element.rotation[end] + d).cross(link.element.direction);
    const double angle = p.norm(), across = p.dot((link.frame.transpose() * f).cross(link.element.direction));
    return {(std::cos(angle) - 1) * f, std::max(0.0, -(angle > 0 ? std::sin(angle) / angle : 1) * across)};
  }

  /// d at the nodes by Newton's method, with the part of the tangent that keeps it positive.
  void find_rotations() {
    const std::size_t n = path_.size();
    rotations_.assign(n + 1, Vector3d::Zero());
    if (hinged_) return;
    for (int iteration = 0; iteration < 50; ++iteration) {
      std::vector<double> diagonal(n + 1);
      std::vector<Vector3d> right(n + 1, Vector3d::Zero());
      const auto stiff = [&](std::size_t k) { return path_[k].element.stiffness / path_[k].element.length; };
      for (std::size_t i = 1; i <= n; ++i) {
        const auto [moment, more] = arm(i - 1, 1);
        diagonal[i] = stiff(i - 1) + more;
        right[i] = -moment - stiff(i - 1) * (rotations_[i] - rotations_[i - 1]);
        if (i == n) continue;
        const auto [next, next_more] = arm(i, 0);
        diagonal[i] += stiff(i) + next_more;
        right[i] += stiff(i) * (rotations_[i + 1] - rotations_[i]) - next;
      }
      for (std::size_t i = n; i > 1; --i) {  // tridiagonal, from the tip on
        const double factor = stiff(i - 1) / diagonal[i];
        diagonal[i - 1] -= factor * stiff(i - 1), right[i - 1] += factor * right[i];
      }
      double step = 0;
      Vector3d before = Vector3d::Zero();
      for (std::size_t i = 1; i <= n; ++i) {
        before = (right[i] + stiff(i - 1) * before) / diagonal[i];
        rotations_[i] += before, step = std::max(step, before.norm());
      }
      if (step < 1e-6) return;
    }
  }

  /// Shift of the tip, of the length; between hinges the greatest of a node.
  double greatest_shift() const {
    std::vector<Vector3d> shift{Vector3d::Zero()}, place{Vector3d::Zero()};
    double length = 0;
    for (std::size_t k = 0; k < path_.size(); ++k) {
      const Link& link = path_[k];
      const Vector3d& e = link.element.direction;
      Vector3d wrong = Vector3d::Zero(), along = Vector3d::Zero();
      for (int i = 0; i < 3; ++i) {  // Simpson
        const double s = 0.5 * i, weight = (i == 1 ? 4. : 1.) / 6;
        const Vector3d p = (1 - s) * link.slope(0) + s * link.slope(1),
                       d = link.frame.transpose() * ((1 - s) * rotations_[k] + s * rotations_[k + 1]);
        const Vector3d karman = (1 - p.squaredNorm() / 2) * e + p;
        wrong += weight * (tangent(e, p + d.cross(e)) - karman), along += weight * karman;
      }
      shift.push_back(shift.back() + link.element.length * (link.frame * wrong));
      place.push_back(place.back() + link.element.length * (link.frame * along));
      length += link.element.length;
    }
    const Vector3d chord = place.back();
    const Vector3d rotation = hinged_ && chord.norm() > 1e-6 * length
                                  ? Vector3d(chord.cross(shift.back()) / chord.squaredNorm())
                                  : Vector3d(Vector3d::Zero());
    double most = shift.back().norm();
    if (hinged_) most = 0;
    for (std::size_t i = 0; hinged_ && i < shift.size(); ++i)
      most = std::max(most, (shift[i] - rotation.cross(place[i])).norm());
    return length > 0 ? most / length : 0;
  }

  Path path_;
  int degree_;
  std::vector<Vector3d> moments_, gradients_, rotations_;
  bool hinged_ = false;
};

/// Elements by the nodes that they meet at.
using Meeting = std::map<PetscInt, std::vector<const BentElement*>>;

Meeting meeting_of(const std::vector<BentElement>& elements) {
  Meeting meeting;
  for (const BentElement& one : elements)
    for (const PetscInt node : one.node) meeting[node].push_back(&one);
  return meeting;
}

/// Paths from `root` to every tip; where there is none (a ring), to the node that was reached last.
std::vector<Path> paths_from(PetscInt root, const Meeting& meeting) {
  std::map<PetscInt, BentElement> reached;  // by the element that leads there
  std::vector<PetscInt> order{root};
  for (std::size_t i = 0; i < order.size(); ++i)
    for (const BentElement* one : meeting.at(order[i])) {
      const BentElement way = one->node[0] == order[i] ? *one : reversed(*one);
      if (way.node[1] == root || !reached.emplace(way.node[1], way).second) continue;
      order.push_back(way.node[1]);
    }
  std::vector<Path> paths;
  for (const PetscInt tip : order) {
    if (tip == root || (meeting.at(tip).size() > 1 && tip != order.back())) continue;
    Path& path = paths.emplace_back();
    for (PetscInt node = tip; node != root; node = path.back().element.node[0])
      path.push_back({reached.at(node), Matrix3d::Identity()});
    std::reverse(path.begin(), path.end());
  }
  return paths;
}

/// From the first to the last of several straight lines.
Path joined(const std::vector<std::vector<BentElement>>& parts) {
  Path whole;
  Matrix3d frame = Matrix3d::Identity();
  for (const std::vector<BentElement>& part : parts) {
    const std::vector<Path> paths = paths_from(0, meeting_of(part));
    if (paths.empty()) return {};
    Path path = paths.front();
    if (!whole.empty())
      frame = frame * math::rotation(whole.back().element.rotation[1]) *
              math::rotation(path.front().element.rotation[0]).transpose();
    for (Link& link : path) link.frame = frame, whole.push_back(link);
  }
  return whole;
}

Path reversed(Path path) {
  std::reverse(path.begin(), path.end());
  for (std::size_t i = 0; i < path.size(); ++i) path[i].element = reversed(path[i].element);
  return path;
}

/// From its end with the greater moment on.
double error_of(const Path& path, int degree) {
  if (path.empty()) return 0;
  PathError forth(path, degree);
  if (forth.moment_at(false) >= 0.99 * forth.moment_at(true)) return forth();
  return PathError(reversed(path), degree)();
}

}  // namespace

std::vector<BentElement> bent_elements(const fem::Structure& structure, Vec deformation) {
  const Eigen::VectorXd local = structure.exchange.gather(deformation);
  std::vector<double> own;
  int shells = 0;
  for (const fem::Mesh::Cell& cell : structure.mesh.cells) {
    if (!mesh::is_line(cell.kind)) {
      shells = shells || mesh::is_shell(cell.kind);
      continue;
    }
    using Ends = std::vector<std::array<int, 2>>;
    for (const auto& ends : mesh::is_quadratic(cell.kind) ? Ends{{0, 2}, {2, 1}} : Ends{{0, 1}}) {
      const auto values = packed(structure, cell, ends, local);
      if (cell.moved[ends[0]] != cell.moved[ends[1]] && values[3] > 0)
        own.insert(own.end(), values.begin(), values.end());
    }
  }
  const MPI_Comm comm = structure.mesh.comm;
  MPI_Allreduce(MPI_IN_PLACE, &shells, 1, MPI_INT, MPI_MAX, comm);
  if (shells) return {};
  const std::vector<double> all = petsc::of_all_ranks(comm, own);
  std::vector<BentElement> elements;
  for (std::size_t i = 0; i < all.size(); i += numbers) elements.push_back(unpacked(all.data() + i));
  std::sort(elements.begin(), elements.end(), [](const BentElement& a, const BentElement& b) {
    return std::minmax(a.node[0], a.node[1]) < std::minmax(b.node[0], b.node[1]);
  });
  return elements;
}

double rotation_error(const std::vector<std::vector<BentElement>>& parts, int degree) {
  if (parts.size() > 1) return error_of(joined(parts), degree);
  if (parts.empty() || parts[0].empty()) return 0;
  const Meeting meeting = meeting_of(parts[0]);
  PetscInt root = meeting.begin()->first;
  double most = -1;
  for (const auto& [node, elements] : meeting) {  // of the ends, the one with the greatest moment
    if (elements.size() != 1) continue;
    const BentElement& one = *elements[0];
    const double moment = ((one.rotation[1] - one.rotation[0]) * (one.stiffness / one.length)).norm();
    if (moment > 1.01 * most) most = moment, root = node;
  }
  double error = 0;
  for (const Path& path : paths_from(root, meeting)) error = std::max(error, PathError(path, degree)());
  return error;
}

}  // namespace floe::assess
