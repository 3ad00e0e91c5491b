#include "full_order_modes.h"

#include <algorithm>

#include "floe/assembly/damping.h"

namespace floe::assembly {

using petsc::check;

std::optional<reference::ModalDamping> full_order_modal_damping(const Plan& plan, int index,
                                                                const fem::Conditions& constrained,
                                                                dynamics::Coordinates& coordinates) {
  const PlannedBody& body = plan.bodies[index];
  const std::vector<double>& ratios = body.spec.damping.modal;
  if (ratios.empty() || body.spec.piece > 0) return std::nullopt;  // of pieces: WholeModes
  const reduction::Modes modes = all_modes_for_damping(plan, index);
  const petsc::MatHandle K = fem::stiffness(body.structure, {});
  reference::ModalDamping damping;
  damping.constrained = constrained;
  const std::size_t count = std::min(ratios.size(), modes.omega.size());
  damping.viscosity.resize(static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const double omega = modes.omega[i];
    damping.viscosity[static_cast<Eigen::Index>(i)] = 2 * ratios[i] * omega;
    damping.forces.push_back(fem::field(body.structure));
    check(MatMult(K, modes.shapes[i], damping.forces.back()));
    check(VecScale(damping.forces.back(), 1 / (omega * omega)));
  }
  damping.y = coordinates.add_shared(static_cast<int>(count));
  damping.multipliers = coordinates.add_shared(static_cast<int>(count), true);
  return damping;
}

void set_modal_coordinates(const reference::ModalDamping& damping, const PlannedBody& body,
                           const dynamics::Coordinates& coordinates, bool owner, Vec U, Vec V) {
  for (const auto& [field, into] : {std::pair(body.deformation.get(), U), {body.deformation_rate.get(), V}}) {
    const Eigen::VectorXd y = reference::modal_coordinates(damping.forces, field);
    for (int i = 0; i < static_cast<int>(y.size()) && owner; ++i)
      check(VecSetValue(into, coordinates.global()[damping.y + i], y[i], INSERT_VALUES));
  }
}

}  // namespace floe::assembly
