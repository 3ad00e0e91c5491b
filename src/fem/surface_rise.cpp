#include "surface_rise.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace floe::fem {
namespace {

using Eigen::Vector3d;
using petsc::check;

bool is_flat_shell(const Mesh::Cell& cell) { return mesh::is_shell(cell.kind) && !mesh::is_quadratic(cell.kind); }

/// An element at its corners: their places, its unit normals there (zero where an edge has no length) and its angles.
struct Facet {
  std::vector<Vector3d> corner, normal;
  std::vector<double> angle;

  Facet(const Mesh& mesh, const Mesh::Cell& cell) {
    for (const int node : cell.corners()) corner.push_back(mesh.positions[node]);
    for (std::size_t i = 0, n = corner.size(); i < n; ++i) {
      const Vector3d next = corner[(i + 1) % n] - corner[i], previous = corner[(i + n - 1) % n] - corner[i];
      const Vector3d across = next.cross(previous);
      normal.push_back(across.stableNormalized());
      angle.push_back(std::atan2(across.norm(), next.dot(previous)));
    }
  }
};

/// sum angle n n' of the elements at each node, of this rank and then of all: xx, xy, xz, yy, yz, zz. It does not know
/// which way normals point.
class Normals {
 public:
  explicit Normals(const Mesh& mesh) {
    check(VecCreateGhostBlock(mesh.comm, 6, 6 * mesh.owned_nodes, PETSC_DECIDE,
                              static_cast<PetscInt>(mesh.foreign.size()), mesh.foreign.data(), sums_.out()));
    check(VecGhostGetLocalForm(sums_, &local_));
    check(VecSet(local_, 0));
    add(mesh);
    check(VecGhostUpdateBegin(sums_, ADD_VALUES, SCATTER_REVERSE));
    check(VecGhostUpdateEnd(sums_, ADD_VALUES, SCATTER_REVERSE));
    check(VecGhostUpdateBegin(sums_, INSERT_VALUES, SCATTER_FORWARD));
    check(VecGhostUpdateEnd(sums_, INSERT_VALUES, SCATTER_FORWARD));
    check(VecGetArrayRead(local_, &values_));
  }
  ~Normals() {
    VecRestoreArrayRead(local_, &values_);
    VecGhostRestoreLocalForm(sums_, &local_);
  }
  Normals(const Normals&) = delete;
  Normals& operator=(const Normals&) = delete;

  /// Zero where the surface is folded.
  Vector3d at(int node) const {
    constexpr double folded = 0.13;  // sin^2 of half of 42 degrees
    const PetscScalar* s = values_ + 6 * node;
    Eigen::Matrix3d sum;
    sum << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum);
    const Vector3d& of = eigen.eigenvalues();
    return of[0] + of[1] < folded * sum.trace() ? Vector3d(eigen.eigenvectors().col(2)) : Vector3d::Zero();
  }

 private:
  void add(const Mesh& mesh) {
    PetscScalar* values = nullptr;
    check(VecGetArray(local_, &values));
    for (const Mesh::Cell& cell : mesh.cells) {
      if (!is_flat_shell(cell)) continue;
      const Facet facet(mesh, cell);
      for (std::size_t i = 0; i < facet.corner.size(); ++i) {
        const Vector3d& n = facet.normal[i];
        PetscScalar* sum = values + 6 * cell.corners()[i];
        for (int a = 0; a < 3; ++a)
          for (int b = a; b < 3; ++b) *sum++ += facet.angle[i] * n[a] * n[b];
      }
    }
    check(VecRestoreArray(local_, &values));
  }

  petsc::VecHandle sums_;
  Vec local_ = nullptr;
  const PetscScalar* values_ = nullptr;
};

}  // namespace

void set_rises(Mesh& mesh) {
  constexpr double round_off = 1e-8;
  const Normals normals(mesh);
  for (Mesh::Cell& cell : mesh.cells) {
    if (!is_flat_shell(cell)) continue;
    const Facet facet(mesh, cell);
    const auto count = static_cast<double>(facet.corner.size());
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& x : facet.corner) middle += x / count;
    cell.rise = 0;
    for (std::size_t i = 0; i < facet.corner.size(); ++i) {
      const double slope = facet.normal[i].cross(normals.at(cell.corners()[i])).norm();
      if (slope > round_off) cell.rise += (facet.corner[i] - middle).norm() * slope / 2 / count;
    }
  }
}

}  // namespace floe::fem
