#include "floe/assembly/damping.h"
#include "floe/petsc/values.h"
#include "floe/plan/planar_start.h"
#include "planar_assembly.h"
#include "start_shape.h"

namespace floe::assembly {

using petsc::check;

void PlanarAssembly::set_full_order_start(int b, Vec U, Vec V) {
  const PlannedBody& body = plan_.bodies[b];
  const fem::Mesh& mesh = body.structure.mesh;
  const bool corotational = formulation_ == Formulation::cfr;
  const Eigen::Matrix2d A = corotational ? rotation_matrix(body.pose[2]) : Eigen::Matrix2d(Eigen::Matrix2d::Identity());
  auto local = [&](Vec field) {
    return field ? body.structure.exchange.gather(field)
                 : Eigen::VectorXd(Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(mesh.positions.size())));
  };
  const Eigen::VectorXd shape = local(body.deformation), rate = local(body.deformation_rate);
  Eigen::MatrixX2d sections;
  if (corotational) sections = section_angles(body);
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i) {
    Eigen::Vector3d u = shape.segment<3>(3 * i), v = rate.segment<3>(3 * i);
    u.head<2>() = (A * u.head<2>()).eval(), v.head<2>() = (A * v.head<2>()).eval();
    if (corotational) {
      const Eigen::Vector2d arm = rotation_matrix(body.pose[2]) * mesh.positions[i].head<2>() + u.head<2>();
      v.head<2>() += body.velocity.head<2>() + body.velocity[2] * Eigen::Vector2d(-arm.y(), arm.x());
      u[2] = sections(i, 0), v[2] = body.velocity[2] + sections(i, 1);
    }
    const PetscInt global = coordinates_.global()[slots_[b].nodes->of_local_node(static_cast<int>(i))];
    const PetscInt rows[3] = {global, global + 1, global + 2};
    check(VecSetValues(U, 3, rows, u.data(), INSERT_VALUES));
    check(VecSetValues(V, 3, rows, v.data(), INSERT_VALUES));
  }
}

void PlanarAssembly::set_start(Model& model) {
  const dynamics::System layout(coordinates_, {});
  model.U = layout.create_vector();
  model.V = layout.create_vector();
  for (const WholeDamping& whole : modal_wholes_) whole.set_start(coordinates_, owner_, model.U, model.V);
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    const PlannedBody& body = plan_.bodies[b];
    const Slot& slot = slots_[b];
    if (!compact(static_cast<int>(b))) set_full_order_start(static_cast<int>(b), model.U, model.V);
    if (slot.damping) set_rigid_part(*slot.damping, body, coordinates_, owner_, model.U, model.V);
    if (slot.modal) set_modal_coordinates(*slot.modal, body, coordinates_, owner_, model.U, model.V);
    Eigen::VectorXd shape, rate;
    const int k = compact(static_cast<int>(b)) ? reduced_[b].body.coordinates() : 0;
    shape.setZero(k), rate.setZero(k);
    if (k > 0 && body.deformation) shape = start_shape(plan_, static_cast<int>(b), reduced_[b], body.deformation);
    if (k > 0 && body.deformation_rate) check(BVDotVec(reduced_[b].basis->V, body.deformation_rate, rate.data()));
    if (!owner_) continue;
    const auto& global = coordinates_.global();
    for (int i = 0; i < 3 && slot.frame >= 0; ++i) {
      check(VecSetValue(model.U, global[slot.frame + i], body.pose[i], INSERT_VALUES));
      check(VecSetValue(model.V, global[slot.frame + i], body.velocity[i], INSERT_VALUES));
    }
    for (int i = 0; i < k; ++i) {
      check(VecSetValue(model.U, global[slot.elastic + i], shape[i], INSERT_VALUES));
      check(VecSetValue(model.V, global[slot.elastic + i], rate[i], INSERT_VALUES));
    }
  }
  for (Vec v : {model.U.get(), model.V.get()}) {
    check(VecAssemblyBegin(v));
    check(VecAssemblyEnd(v));
  }
}

}  // namespace floe::assembly
