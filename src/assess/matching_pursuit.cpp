#include "matching_pursuit.h"

#include <algorithm>

namespace floe::assess {

namespace {

constexpr double spent = 1e-8;  // what is left of a direction that those before it span

struct Candidates {
  Eigen::MatrixXd D;  // without what is taken, and its norms at the start
  Eigen::VectorXd norms;
  Eigen::MatrixXd G;  // sum of y y'
  std::vector<int> group;
};

bool is_spent(const Candidates& body, Eigen::Index c) { return !(body.D.col(c).norm() > spent * body.norms[c]); }

double gain(const Candidates& body, Eigen::Index c) {
  if (is_spent(body, c)) return 0;
  const double size = body.D.col(c).squaredNorm();
  return body.D.col(c).dot(body.G * body.D.col(c)) / size;
}

void take(Candidates& body, Eigen::Index c) {
  if (is_spent(body, c)) return;  // its direction would be round-off
  const Eigen::VectorXd d = body.D.col(c).normalized();
  for (int pass = 0; pass < 2; ++pass) body.D -= d * (d.transpose() * body.D).eval();
  body.D.col(c).setZero();
}

}  // namespace

std::vector<Taken> matching_pursuit(std::vector<Directions> bodies, int groups) {
  std::vector<Candidates> all;
  double whole = 0;
  for (Directions& body : bodies) {
    const Eigen::VectorXd norms = body.D.colwise().norm().transpose();
    all.push_back({std::move(body.D), norms, body.Y * body.Y.transpose(), std::move(body.group)});
    whole += all.back().G.trace();
  }
  std::vector<Taken> order;
  if (!(whole > 0)) return order;
  std::vector<char> used(groups, false);
  while (true) {
    std::vector<double> gains(groups, 0);
    for (const Candidates& body : all)
      for (Eigen::Index c = 0; c < body.D.cols(); ++c)
        if (!used[body.group[c]]) gains[body.group[c]] += gain(body, c);
    const int best = static_cast<int>(std::max_element(gains.begin(), gains.end()) - gains.begin());
    if (groups == 0 || !(gains[best] > 1e-14 * whole)) return order;
    used[best] = true;
    order.push_back({best, gains[best] / whole});
    for (Candidates& body : all)
      for (Eigen::Index c = 0; c < body.D.cols(); ++c)
        if (body.group[c] == best) take(body, c);
  }
}

}  // namespace floe::assess
