#pragma once
#include <Eigen/Sparse>
#include <cmath>
#include <functional>
#include <map>

#include "eigenvalues.h"
#include "floe/fem/quadratic_shell.h"
#include "random.h"

/// A flat rectangle of shell elements with a small assembler of its own: what convergence of the elements is measured
/// on, without the program's assembly.
namespace floe::testing {

using SparseMatrix = Eigen::SparseMatrix<double>;

enum class Cells { triangles, crossed, quadrilaterals };  ///< one diagonal, diagonals in turn, no diagonal

struct Plate {
  std::vector<Eigen::Vector3d> nodes;
  std::vector<std::vector<int>> cells;  ///< three or four nodes, or six or eight of second order
  std::vector<bool> constrained;        ///< per dof

  int dofs() const { return 6 * static_cast<int>(nodes.size()); }
  void hold(const std::function<bool(const Eigen::Vector3d&)>& where, std::initializer_list<int> which) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (where(nodes[i]))
        for (int d : which) constrained[6 * i + d] = true;
  }
  int nearest(const Eigen::Vector3d& place) const {
    int best = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if ((nodes[i] - place).norm() < (nodes[best] - place).norm()) best = static_cast<int>(i);
    return best;
  }
};

/// nx x ny cells on [0, a] x [0, b]; inner nodes move by up to `distortion` of a cell.
inline Plate plate(double a, double b, int nx, int ny, Cells cells, double distortion = 0) {
  Plate p;
  Random random;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const bool inner = i > 0 && j > 0 && i < nx && j < ny;
      const double dx = inner ? distortion * random.number() : 0, dy = inner ? distortion * random.number() : 0;
      p.nodes.emplace_back(a * (i + dx) / nx, b * (j + dy) / ny, 0);
    }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int n = i + j * (nx + 1), up = n + nx + 1;
      if (cells == Cells::quadrilaterals) {
        p.cells.push_back({n, n + 1, up + 1, up});
      } else if (cells == Cells::crossed && (i + j) % 2 == 1) {
        p.cells.push_back({n, n + 1, up});
        p.cells.push_back({n + 1, up + 1, up});
      } else {
        p.cells.push_back({n, n + 1, up + 1});
        p.cells.push_back({n, up + 1, up});
      }
    }
  p.constrained.assign(p.dofs(), false);
  return p;
}

/// n x m elements of second order on the image of the unit square, all nodes on it. @param at  (u, v) -> position
inline Plate curved_plate(int n, int m, bool triangles, const std::function<Eigen::Vector3d(double, double)>& at) {
  Plate p;
  std::map<std::pair<int, int>, int> numbers;
  const auto node = [&](int i, int j) {
    const auto [found, made] = numbers.try_emplace({i, j}, static_cast<int>(p.nodes.size()));
    if (made) p.nodes.push_back(at(i / (2. * n), j / (2. * m)));
    return found->second;
  };
  for (int a = 0; a < 2 * n; a += 2)
    for (int b = 0; b < 2 * m; b += 2) {
      const int c[4] = {node(a, b), node(a + 2, b), node(a + 2, b + 2), node(a, b + 2)};
      const int e[4] = {node(a + 1, b), node(a + 2, b + 1), node(a + 1, b + 2), node(a, b + 1)};
      if (!triangles) {
        p.cells.push_back({c[0], c[1], c[2], c[3], e[0], e[1], e[2], e[3]});
        continue;
      }
      const int middle = node(a + 1, b + 1);
      p.cells.push_back({c[0], c[1], c[2], e[0], e[1], middle});
      p.cells.push_back({c[0], c[2], c[3], middle, e[2], e[3]});
    }
  p.constrained.assign(p.dofs(), false);
  return p;
}

/// Middle nodes into the middles of their chords.
inline void straighten(Plate& p) {
  for (const auto& c : p.cells)
    for (std::size_t i = 0, n = c.size() / 2; i < n; ++i)
      p.nodes[c[n + i]] = (p.nodes[c[i]] + p.nodes[c[(i + 1) % n]]) / 2;
}

inline std::vector<Eigen::Vector3d> nodes_of(const Plate& p, const std::vector<int>& c) {
  std::vector<Eigen::Vector3d> x;
  for (const int node : c) x.push_back(p.nodes[node]);
  return x;
}

inline fem::ElementMaps maps_of(const Plate& p, const std::vector<int>& c, const fem::ShellSection& section) {
  if (c.size() > 4) return fem::quadratic_shell(nodes_of(p, c), section);
  if (c.size() == 3) return fem::shell_triangle({p.nodes[c[0]], p.nodes[c[1]], p.nodes[c[2]]}, section);
  return fem::shell_quadrilateral({p.nodes[c[0]], p.nodes[c[1]], p.nodes[c[2]], p.nodes[c[3]]}, section);
}

inline std::vector<fem::SurfacePoint> surface_of(const Plate& p, const std::vector<int>& c) {
  if (c.size() > 4) {
    std::vector<fem::SurfacePoint> points;
    for (const fem::CurvedPoint& point : fem::quadratic_shell_surface(nodes_of(p, c))) points.push_back(point.at);
    return points;
  }
  if (c.size() == 3) return fem::shell_triangle_surface({p.nodes[c[0]], p.nodes[c[1]], p.nodes[c[2]]});
  return fem::shell_quadrilateral_surface({p.nodes[c[0]], p.nodes[c[1]], p.nodes[c[2]], p.nodes[c[3]]});
}

/// Sum of dense element matrices of(cell); constrained dofs have a diagonal of `kept` and nothing else.
inline SparseMatrix assembled(const Plate& p, double kept,
                              const std::function<Eigen::MatrixXd(const std::vector<int>&)>& of) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& c : p.cells) {
    const Eigen::MatrixXd E = of(c);
    for (Eigen::Index i = 0; i < E.rows(); ++i)
      for (Eigen::Index j = 0; j < E.cols(); ++j) {
        const int row = 6 * c[i / 6] + static_cast<int>(i % 6), col = 6 * c[j / 6] + static_cast<int>(j % 6);
        if (!p.constrained[row] && !p.constrained[col]) entries.emplace_back(row, col, E(i, j));
      }
  }
  for (int d = 0; d < p.dofs(); ++d)
    if (p.constrained[d]) entries.emplace_back(d, d, kept);
  SparseMatrix sum(p.dofs(), p.dofs());
  sum.setFromTriplets(entries.begin(), entries.end());
  return sum;
}

inline SparseMatrix stiffness(const Plate& p, const fem::ShellSection& section) {
  return assembled(p, 1, [&](const auto& c) { return maps_of(p, c, section).stiffness(); });
}

inline SparseMatrix mass(const Plate& p, const fem::ShellSection& section) {
  return assembled(p, 0, [&](const auto& c) { return maps_of(p, c, section).mass_matrix(); });
}

inline Eigen::VectorXd gathered(const std::vector<int>& c, const Eigen::VectorXd& q) {
  Eigen::VectorXd part(6 * c.size());
  for (std::size_t i = 0; i < c.size(); ++i) part.segment<6>(6 * i) = q.segment<6>(6 * c[i]);
  return part;
}

/// Load of a uniform force per area; zero at constrained dofs.
inline Eigen::VectorXd uniform_load(const Plate& p, const Eigen::Vector3d& force) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(p.dofs());
  for (const auto& c : p.cells)
    for (const fem::SurfacePoint& point : surface_of(p, c)) {
      const Eigen::VectorXd part = point.area * point.N.transpose() * force;
      for (std::size_t i = 0; i < c.size(); ++i) f.segment<6>(6 * c[i]) += part.segment<6>(6 * i);
    }
  for (int d = 0; d < p.dofs(); ++d)
    if (p.constrained[d]) f[d] = 0;
  return f;
}

inline Eigen::VectorXd solved(const SparseMatrix& K, const Eigen::VectorXd& f) {
  return Eigen::SimplicialLDLT<SparseMatrix>(K).solve(f);
}

/// Forces and tangent of the whole von Karman energy at q, by its definition; constrained dofs have zero and one.
inline void add_tension(const fem::ElementMaps& maps, const Eigen::VectorXd& q, Eigen::VectorXd& f,
                        Eigen::MatrixXd& K) {
  f = maps.bending * q;
  K = maps.bending;
  for (const fem::StrainPoint& g : maps.membrane) {
    const Eigen::VectorXd slope = g.G * q;
    Eigen::MatrixXd J = g.L;
    for (Eigen::Index s = 0; s < J.rows(); ++s) J.row(s) += slope.transpose() * g.P[s] * g.G;
    const Eigen::VectorXd stress = g.weight * g.D * (g.L * q + g.bilinear(slope, slope) / 2);
    f += J.transpose() * stress;
    K += g.weight * J.transpose() * g.D * J;
    for (Eigen::Index s = 0; s < J.rows(); ++s) K += stress[s] * g.G.transpose() * g.P[s] * g.G;
  }
}

inline std::vector<fem::ElementMaps> all_maps(const Plate& p, const fem::ShellSection& section) {
  std::vector<fem::ElementMaps> maps;
  for (const auto& c : p.cells) maps.push_back(maps_of(p, c, section));
  return maps;
}

/// Equilibrium of the energy with `load`, by Newton in `stages` of equal growth. @param maps  of the cells
inline Eigen::VectorXd equilibrium(const Plate& p, const std::vector<fem::ElementMaps>& maps,
                                   const Eigen::VectorXd& load, int stages) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(p.dofs());
  for (int stage = 1; stage <= stages; ++stage)
    for (int round = 0; round < 40; ++round) {
      Eigen::VectorXd rest = load * (double(stage) / stages);
      std::size_t cell = 0;
      const SparseMatrix K = assembled(p, 1, [&](const std::vector<int>& c) {
        Eigen::VectorXd f;
        Eigen::MatrixXd tangent;
        add_tension(maps[cell++], gathered(c, q), f, tangent);
        for (Eigen::Index i = 0; i < f.size(); ++i)
          if (const int d = 6 * c[i / 6] + static_cast<int>(i % 6); !p.constrained[d]) rest[d] -= f[i];
        return tangent;
      });
      const Eigen::VectorXd step = solved(K, rest);
      q += step;
      if (step.norm() < 1e-9 * q.norm()) break;
    }
  return q;
}

inline Eigen::VectorXd equilibrium(const Plate& p, const fem::ShellSection& section, const Eigen::VectorXd& load,
                                   int stages) {
  return equilibrium(p, all_maps(p, section), load, stages);
}

/// The lowest angular frequencies, by subspace iteration [rad/s].
inline Eigen::VectorXd frequencies(const Plate& p, const fem::ShellSection& section, int count) {
  const SparseMatrix K = stiffness(p, section), M = mass(p, section);
  const Eigen::SimplicialLDLT<SparseMatrix> factor(K);
  const int columns = 2 * count + 4;
  Eigen::MatrixXd X = Random().matrix(p.dofs(), columns);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(count);
  for (int round = 0; round < 60; ++round) {
    const Eigen::MatrixXd MX = M * X, Y = factor.solve(MX), MY = M * Y;
    const Eigen::MatrixXd small = Y.transpose() * MX, inertia = Y.transpose() * MY;
    X = Y * eigenvectors(small, inertia);
    const Eigen::VectorXd now = eigenvalues(small, inertia).head(count).cwiseSqrt();
    if ((now - before).cwiseAbs().maxCoeff() < 1e-10 * now[count - 1]) return now;
    before = now;
  }
  return Eigen::VectorXd::Constant(count, std::nan(""));
}

}  // namespace floe::testing
