#include <fmt/format.h>

#include "build_assembly.h"
#include "build_space.h"
#include "floe/dynamics/simulation.h"

namespace floe::scene {
namespace {

/// Moves the linear bodies as the scene says and integrates |eta_i eta_j|, eta the coordinates of the generating
/// fields.
std::vector<Eigen::MatrixXd> interactions(const Prepared& prepared, const std::vector<ReducedBody>& linear) {
  Model model = prepared.scene.dimension == 3 ? SpaceAssembly(prepared, Formulation::vm, linear).model()
                                              : Assembly(prepared, Formulation::vm, linear).model();
  std::vector<Eigen::MatrixXd> sums;
  for (const ReducedBody& body : linear)
    sums.push_back(Eigen::MatrixXd::Zero(body.body.coordinates(), body.body.coordinates()));
  const Motion& motion = prepared.scene.motion;
  Eigen::VectorXd q;
  auto observe = [&](const dynamics::Instant& instant) {
    model.system->gather(instant.U, q);
    for (std::size_t b = 0; b < sums.size(); ++b) {
      if (sums[b].rows() == 0 || linear[b].of_fields.rows() == 0) continue;
      const Eigen::VectorXd eta = linear[b].of_fields * q.segment(model.bodies[b].first_elastic, sums[b].rows());
      sums[b] += motion.step * (eta * eta.transpose()).cwiseAbs();
    }
  };
  try {
    dynamics::simulate(*model.system, {motion.end, motion.step, motion.spectral_radius, {}, "ranking_"}, model.U,
                       model.V, observe);
  } catch (const dynamics::MotionStopped&) {
    // A linear body that is turned too fast diverges: what it did until then ranks the pairs.
  }
  return sums;
}

void refuse_meshless(const Scene& scene, Formulation formulation) {
  if (is_reduced(formulation) || formulation == Formulation::lffr) return;
  std::vector<std::string> faults;
  for (const Body& body : scene.bodies)
    if (body.reduced)
      faults.push_back(fmt::format("{}: has no mesh, which formulation {} needs; expected vm+md, vm or lffr",
                                   body.reduced->where.text(), name_of(formulation)));
  if (!faults.empty()) throw InputError(faults);
}

}  // namespace

Model build(const Scene& whole, Formulation formulation, MPI_Comm comm) {
  const Scene scene = formulation == Formulation::cfr ? whole : split_frames(whole);
  refuse_meshless(scene, formulation);
  const Prepared prepared = prepare(scene, comm);
  std::vector<std::string> warnings;
  std::vector<ReducedBody> reduced(prepared.bodies.size());
  if (is_reduced(formulation)) {
    reduced = reduce_bodies(
        prepared, formulation, [&](const std::vector<ReducedBody>& linear) { return interactions(prepared, linear); },
        warnings);
  } else {
    for (std::size_t b = 0; b < reduced.size(); ++b)
      if (prepared.bodies[b].spec.rigid)
        reduced[b] = rigid(prepared.bodies[b]);
      else if (prepared.bodies[b].spec.reduced)
        reduced[b] = from_file(prepared.bodies[b], formulation);
  }
  Model model = scene.dimension == 3 ? SpaceAssembly(prepared, formulation, reduced).model()
                                     : Assembly(prepared, formulation, reduced).model();
  model.warnings.insert(model.warnings.end(), warnings.begin(), warnings.end());
  return model;
}

}  // namespace floe::scene
