#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "floe/output/reduced_file.h"

/// A body of no meaning with a number in every entry, also such that no decimal text would keep; the same on every
/// rank.
inline floe::output::ReducedBodyFile sample_body(int d, int k) {
  using namespace floe;
  std::mt19937_64 random(100 * d + k);
  std::normal_distribution<double> normal;
  const auto matrix = [&](Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); }));
  };
  const auto inertia = [&] {
    body::Inertia all(d, k);
    all.m = 1 + std::abs(normal(random));
    all.s0 = matrix(d, 1), all.C0 = matrix(d, d), all.S = matrix(d, k);
    for (int a = 0; a < d; ++a)
      for (int b = 0; b < d; ++b) all.h[a][b] = matrix(k, 1), all.M[a][b] = matrix(k, k);
    all.allocate_rotary();
    for (auto& row : all.W)
      for (auto& W : row) W = matrix(k, k);
    all.allocate_first();
    for (auto& Q : all.Q) Q = matrix(k, k);
    return all;
  };
  output::ReducedBodyFile file;
  file.name = "ärm";
  file.dimension = d;
  file.dofs = 12 * (d == 2 ? 3 : 6), file.nodes = 12, file.cells = 11;
  file.body.inertia = inertia(), file.body.line = inertia();
  file.body.elasticity.bending = matrix(k, k);
  for (int a = 0; a < k; a += 2)
    for (int b = a; b < k; b += 2) file.body.elasticity.pairs.emplace_back(a, b);
  file.body.elasticity.F = matrix(k + 3, k + std::ssize(file.body.elasticity.pairs));
  file.omitted_products = k > 1 ? 7 : 0;
  if (k > 0) file.body.elasticity.F(0, 0) = 5e-324, file.body.elasticity.F(1, 0) = -0.0;
  file.damping = matrix(k, k);
  if (k > 0) file.strain_rate_damping = 1e-4;
  for (const char* name : {"tip", "root/left", "lug"})
    file.places.push_back({name, {matrix(d, 1), matrix(d, k), matrix(d == 2 ? 1 : 3, k)}});
  if (k > 0)
    for (int a = 0; a < d; ++a) file.places[1].map.Q.push_back(matrix(k, k));
  for (int a = 0; a < 3 && d == 3; ++a) file.places[1].map.H.push_back(matrix(3, 3));
  for (int i = 0; i < k; ++i) file.columns.push_back({"mode", "mode " + std::to_string(i + 1), 10.0 + i, 0.5, true, 0});
  file.columns.push_back({"derivative", "derivative 1,1", 0, 1e-12, false, 0.25});
  file.columns.push_back({"attachment", "root.moment", 0, 0, false, 0, "repeats tip.moment"});
  file.omega = {10, 11, 1e5 / 3};
  file.residual = {1e-12, 2e-12, 1e-9 / 3};
  file.frame = {"chord", matrix(d, 1), Eigen::MatrixXd::Identity(d, d)};
  file.frame.axes.topLeftCorner(2, 2) << 0.6, -0.8, 0.8, 0.6;
  file.held = {"fixed at tip", "revolute about z at root/left"};
  file.made = {"0.1.0",
               "abc123",
               "2024-05-06T07:08:09Z",
               "floe reduce 'my arm.yaml'",
               "-modes_eps_tol 1e-9",
               "bodies:\n  ärm: {}\n",
               3,
               {{"modes", 1.25}, {"derivatives", 1.0 / 3}}};
  return file;
}

/// Equal to the bit, also the sign of zero and where the sizes are zero.
inline bool same(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::equal(a.data(), a.data() + a.size(), b.data(),
                    [](double x, double y) { return x == y && std::signbit(x) == std::signbit(y); });
}

inline void check_same(const floe::body::Inertia& a, const floe::body::Inertia& b) {
  CHECK(a.m == b.m);
  CHECK((same(a.s0, b.s0) && same(a.C0, b.C0) && same(a.S, b.S)));
  for (int i = 0; i < a.dimension(); ++i)
    for (int j = 0; j < a.dimension(); ++j) CHECK((same(a.h[i][j], b.h[i][j]) && same(a.M[i][j], b.M[i][j])));
  REQUIRE(a.Q.size() == b.Q.size());
  for (std::size_t i = 0; i < a.Q.size(); ++i) CHECK(same(a.Q[i], b.Q[i]));
  REQUIRE(a.W.size() == b.W.size());
  for (std::size_t i = 0; i < a.W.size(); ++i)
    for (std::size_t j = 0; j < a.W.size(); ++j) CHECK(same(a.W[i][j], b.W[i][j]));
}

inline void check_same(const floe::output::ReducedBodyFile& a, const floe::output::ReducedBodyFile& b) {
  CHECK((a.name == b.name && a.dimension == b.dimension && a.version == b.version));
  CHECK((a.dofs == b.dofs && a.nodes == b.nodes && a.cells == b.cells && a.has_shapes == b.has_shapes));
  check_same(a.body.inertia, b.body.inertia);
  check_same(a.body.line, b.body.line);
  CHECK((same(a.body.elasticity.bending, b.body.elasticity.bending) && same(a.body.elasticity.F, b.body.elasticity.F)));
  CHECK(a.body.elasticity.pairs == b.body.elasticity.pairs);
  CHECK(a.omitted_products == b.omitted_products);
  CHECK((same(a.damping, b.damping) && a.strain_rate_damping == b.strain_rate_damping));
  REQUIRE(a.places.size() == b.places.size());
  for (std::size_t i = 0; i < a.places.size(); ++i) {
    const auto &left = a.places[i], &right = b.places[i];
    CHECK(left.name == right.name);
    CHECK((same(left.map.x, right.map.x) && same(left.map.S, right.map.S) && same(left.map.psi, right.map.psi)));
    REQUIRE(left.map.Q.size() == right.map.Q.size());
    for (std::size_t j = 0; j < left.map.Q.size(); ++j) CHECK(same(left.map.Q[j], right.map.Q[j]));
    REQUIRE(left.map.H.size() == right.map.H.size());
    for (std::size_t j = 0; j < left.map.H.size(); ++j) CHECK(same(left.map.H[j], right.map.H[j]));
  }
  REQUIRE(a.columns.size() == b.columns.size());
  for (std::size_t i = 0; i < a.columns.size(); ++i) {
    const auto &left = a.columns[i], &right = b.columns[i];
    CHECK((left.kind == right.kind && left.label == right.label && left.kept == right.kept));
    CHECK((left.omega == right.omega && left.new_part == right.new_part && left.interaction == right.interaction));
    CHECK(left.dropped == right.dropped);
  }
  CHECK((a.omega == b.omega && a.residual == b.residual));
  CHECK(a.held == b.held);
  CHECK((a.frame.kind == b.frame.kind && same(a.frame.origin, b.frame.origin) && same(a.frame.axes, b.frame.axes)));
  CHECK((a.made.version == b.made.version && a.made.commit == b.made.commit && a.made.date == b.made.date));
  CHECK((a.made.command == b.made.command && a.made.options == b.made.options && a.made.scene == b.made.scene));
  CHECK((a.made.ranks == b.made.ranks && a.made.seconds == b.made.seconds));
}
