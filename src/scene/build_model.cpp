#include <fmt/format.h>

#include "build_assembly.h"
#include "build_space.h"
#include "drive.h"
#include "floe/dynamics/simulation.h"
#include "floe/scene/places.h"
#include "floe/scene/variation.h"
#include "offline.h"
#include "start_vectors.h"

namespace floe::scene {

Model assemble(const Prepared& prepared, Formulation formulation, const std::vector<ReducedBody>& reduced) {
  return prepared.scene.dimension == 3 ? SpaceAssembly(prepared, formulation, reduced).model()
                                       : Assembly(prepared, formulation, reduced).model();
}

namespace {

/// Moves the linear bodies as the scene says and integrates |eta_i eta_j|, eta the coordinates of the generating
/// fields.
std::vector<Eigen::MatrixXd> interactions(const Prepared& prepared, const std::vector<ReducedBody>& linear) {
  Model model = assemble(prepared, Formulation::vm, linear);
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
    dynamics::Integration how{motion.end, motion.step, motion.spectral_radius, {}, "ranking_"};
    how.kinks = kinks_of(prepared.scene, motion.end);
    dynamics::simulate(*model.system, how, model.U, model.V, observe);
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

struct ReducedBodies {
  Formulation formulation;
  MPI_Comm comm;
  std::vector<ReducedBody> bodies;
  std::vector<std::string> warnings;
};

namespace {

Scene in_parts(const Scene& whole, Formulation formulation) {
  return formulation == Formulation::cfr ? whole : split_frames(whole);
}

ReducedBodies reduced_bodies(const Prepared& prepared, Formulation formulation, bool keep_offline = false) {
  ReducedBodies all{formulation, prepared.comm, std::vector<ReducedBody>(prepared.bodies.size()), {}};
  if (is_reduced(formulation)) {
    all.bodies = reduce_bodies(
        prepared, formulation, [&](const std::vector<ReducedBody>& linear) { return interactions(prepared, linear); },
        all.warnings, keep_offline);
    for (std::size_t b = 0; b < all.bodies.size(); ++b) join_start(prepared.bodies[b], all.bodies[b]);
    return all;
  }
  for (std::size_t b = 0; b < all.bodies.size(); ++b)
    if (prepared.bodies[b].spec.rigid)
      all.bodies[b] = rigid(prepared.bodies[b]);
    else if (prepared.bodies[b].spec.reduced)
      all.bodies[b] = from_file(prepared.bodies[b], formulation);
  return all;
}

Model assembled(const Prepared& prepared, const ReducedBodies& reduced) {
  Model model = assemble(prepared, reduced.formulation, reduced.bodies);
  model.warnings.insert(model.warnings.end(), reduced.warnings.begin(), reduced.warnings.end());
  for (std::string& words : middles_beside_nodes(prepared.scene)) model.warnings.push_back(std::move(words));
  for (std::string& words : smoothed_drives(prepared.scene)) model.warnings.push_back(std::move(words));
  return model;
}

}  // namespace

void give_structures(const std::shared_ptr<const Offline>& offline, Model& model) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (const PreparedBody& body = offline->prepared.bodies[b]; !body.spec.rigid && !body.spec.reduced)
      model.bodies[b].structure = {offline, &body.structure};
}

Model build(const Scene& whole, Formulation formulation, MPI_Comm comm, bool keep_offline) {
  refuse_meshless(whole, formulation);
  const auto offline = std::make_shared<Offline>(in_parts(whole, formulation), comm);
  ReducedBodies reduced = reduced_bodies(offline->prepared, formulation, keep_offline);
  Model model = assembled(offline->prepared, reduced);
  give_structures(offline, model);
  if (!keep_offline) return model;
  offline->reduced = std::move(reduced.bodies);
  model.offline = offline;
  return model;
}

std::shared_ptr<const ReducedBodies> reduce_once(const Scene& whole, Formulation formulation, MPI_Comm comm) {
  const Scene scene = in_parts(whole, formulation);
  refuse_meshless(scene, formulation);
  return std::make_shared<const ReducedBodies>(reduced_bodies(prepare(scene, comm), formulation));
}

Model build_on(const ReducedBodies& bodies, const Scene& whole) {
  const auto offline = std::make_shared<Offline>(in_parts(whole, bodies.formulation), bodies.comm);
  Model model = assembled(offline->prepared, bodies);
  give_structures(offline, model);
  if (!is_reduced(bodies.formulation)) return model;
  offline->reduced = bodies.bodies;
  model.offline = offline;
  return model;
}

}  // namespace floe::scene
