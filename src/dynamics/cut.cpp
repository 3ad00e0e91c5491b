#include "floe/dynamics/cut.h"

#include "floe/dynamics/local_indices.h"

namespace floe::dynamics {

Wrench on_part(const Cut& cut, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a) {
  const int size = cut.attitude ? 6 : 3;
  Eigen::Matrix<double, 6, 1> rows = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::VectorXd own, rate, second, r;
  const auto add = [&](const Term& term) {
    pick(term.coordinates(), q, own);
    pick(term.coordinates(), v, rate);
    pick(term.coordinates(), a, second);
    r.setZero(own.size());
    term.residual({t, own, rate, second}, r);
    for (std::size_t i = 0; i < term.coordinates().size(); ++i)
      if (const int row = term.coordinates()[i] - cut.frame; row >= 0 && row < size)
        rows[row] += r[static_cast<Eigen::Index>(i)];
  };
  for (const auto& term : cut.own) add(*term);
  for (const Term* term : cut.shared) add(*term);
  Wrench wrench = Wrench::Zero();
  if (cut.attitude) {
    wrench.head<3>() = rows.head<3>();
    wrench.tail<3>() = cut.attitude->axes(q.segment<3>(cut.frame + 3)) * rows.tail<3>();
  } else {
    wrench.head<2>() = rows.head<2>(), wrench[5] = rows[2];
  }
  return wrench;
}

}  // namespace floe::dynamics
