#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "begin_motion.h"
#include "drive.h"
#include "floe/assembly/damping.h"
#include "floe/assembly/offline.h"
#include "floe/assembly/reduce_once.h"
#include "floe/assembly/start_vectors.h"
#include "floe/plan/load_scale.h"
#include "floe/scene/places.h"
#include "floe/solve/simulation.h"
#include "planar_assembly.h"
#include "residual_responses.h"
#include "spatial_assembly.h"
#include "stretched_start.h"

namespace floe::assembly {

namespace {

/// As scenes have it.
const char* name_of_kind(Joint::Kind kind) {
  constexpr std::array names{"fixed",        "revolute",  "prismatic", "driven", "spring",
                             "cylindrical",  "spherical", "universal", "planar", "distance",
                             "driven_slide", "bushing",   "support"};
  return names[static_cast<std::size_t>(kind)];
}

}  // namespace

Model assemble(const Plan& plan, Formulation formulation, const std::vector<ReducedBody>& reduced, Purpose purpose) {
  const bool apart = purpose == Purpose::residuals_of_elements_apart;
  Model model = plan.scene.dimension == 3 ? SpatialAssembly(plan, formulation, reduced, apart).model()
                                          : PlanarAssembly(plan, formulation, reduced).model();
  if (purpose == Purpose::motion) begin_motion(plan, model);
  model.force = force_of(plan);
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const auto& [one, two] = plan.joints[j];
    const Joint& joint = plan.scene.joints[j];
    model.joint_places.push_back({joint.name, name_of_kind(joint.kind), {{{one.body, one.x}, {two.body, two.x}}}});
  }
  return model;
}

namespace {

/// Moves the linear bodies as the scene says and integrates |eta_i eta_j|, eta the coordinates of the generating
/// fields.
std::vector<Eigen::MatrixXd> interactions(const Plan& plan, const std::vector<ReducedBody>& linear) {
  Model model = assemble(plan, Formulation::vm, linear);
  std::vector<Eigen::MatrixXd> sums;
  for (const ReducedBody& body : linear)
    sums.push_back(Eigen::MatrixXd::Zero(body.body.coordinates(), body.body.coordinates()));
  const Motion& motion = plan.scene.motion;
  Eigen::VectorXd q;
  auto observe = [&](const solve::Instant& instant) {
    model.system->gather(instant.U, q);
    for (std::size_t b = 0; b < sums.size(); ++b) {
      if (sums[b].rows() == 0 || linear[b].of_fields.rows() == 0) continue;
      const Eigen::VectorXd eta = linear[b].of_fields * q.segment(model.bodies[b].first_elastic, sums[b].rows());
      sums[b] += motion.step * (eta * eta.transpose()).cwiseAbs();
    }
  };
  try {
    solve::Integration how{motion.end, motion.step, motion.spectral_radius, {}, "ranking_"};
    how.kinks = kinks_of(plan.scene, motion.end);
    solve::simulate(*model.system, how, model.U, model.V, observe);
  } catch (const solve::MotionStopped&) {
    // A linear body that is rotated too fast diverges: what it did until then ranks the pairs.
  }
  return sums;
}

void refuse_meshless(const Scene& scene, Formulation formulation) {
  if (is_reduced(formulation) || formulation == Formulation::lffr) return;
  std::vector<std::string> faults;
  std::set<std::pair<int, int>> reported;  // lines and columns: copies of a body have those of the original
  for (const Body& body : scene.bodies)
    if (body.reduced && reported.emplace(body.reduced->where.line, body.reduced->where.column).second)
      faults.push_back(fmt::format("{}: has no mesh, but formulation {} needs one; expected vm+md, vm or lffr",
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

Scene in_parts(const Scene& whole, Formulation formulation, MPI_Comm comm) {
  if (formulation == Formulation::cfr) return whole;
  return split_frames(whole, comm);
}

/// Files of versions 2 and 3 have first moments and places at arms to first order only, and do not state whether there
/// are any; those before version 5 rotate places of shells to first order, or by the mean of their nodes.
void warn_of_files(ReducedBodies& all) {
  for (const ReducedBody& body : all.bodies)
    if (body.report.file_version > 1 && body.report.file_version < 4)
      all.warnings.push_back(fmt::format(
          "body {}: \"{}\" is of version {} of the format, which has masses at arms (centroids off the nodes, offset "
          "masses, rigid links) to first order only; if it has any, write it again with floe reduce",
          body.report.name, body.report.file, body.report.file_version));
  for (const ReducedBody& body : all.bodies)
    if (body.report.file_version >= 1 && body.report.file_version < 5 && body.report.file_has_shells)
      all.warnings.push_back(fmt::format(
          "body {}: \"{}\" is of version {} of the format, in which edges and areas of shells rotate to first order, "
          "or "
          "by the mean of their nodes; if joints, moments or probes of rotations are there, write it again with floe "
          "reduce",
          body.report.name, body.report.file, body.report.file_version));
}

/// Reactions of supports need what the elastic force was condensed over.
bool measures_reactions(const Scene& scene) {
  return std::any_of(scene.probes.begin(), scene.probes.end(), [](const Probe& probe) { return !probe.joint.empty(); });
}

ReducedBodies reduced_bodies(Offline& offline, Formulation formulation, bool keep_offline = false) {
  const Plan& plan = offline.plan;
  ReducedBodies all{formulation, plan.comm, std::vector<ReducedBody>(plan.bodies.size()), {}};
  if (is_reduced(formulation)) {
    const bool responding = formulation == Formulation::vm_md && has_responses(plan.scene);
    all.bodies = reduce_bodies(
        plan, formulation, [&](const std::vector<ReducedBody>& linear) { return interactions(plan, linear); },
        all.warnings, keep_offline || responding);
    for (std::size_t b = 0; b < all.bodies.size(); ++b) join_start(plan.bodies[b], all.bodies[b]);
    warn_of_files(all);
    if (responding) {
      offline.reduced = std::move(all.bodies);
      add_residual_responses(offline, all.warnings);
      all.bodies = std::exchange(offline.reduced, {});
    }
    for (ReducedBody& body : all.bodies) {
      if (!keep_offline) body.statics.reset();
      if (!keep_offline && !measures_reactions(plan.scene)) body.relief = {};
    }
    return all;
  }
  for (std::size_t b = 0; b < all.bodies.size(); ++b)
    if (plan.bodies[b].spec.rigid)
      all.bodies[b] = rigid(plan.bodies[b]);
    else if (plan.bodies[b].spec.reduced)
      all.bodies[b] = from_file(plan.bodies[b], formulation);
  warn_of_files(all);
  return all;
}

/// Loads whose directions depend on the number of frames.
std::vector<std::string> loads_in_axes_of_parts(const Scene& split) {
  std::vector<std::string> words;
  const auto look = [&](const Load& load, const std::string& name) {
    if (load.axes != Load::Axes::body || load.kind == Load::Kind::pressure) return;
    const auto part = std::find_if(split.bodies.begin(), split.bodies.end(),
                                   [&](const Body& body) { return body.name == name && body.piece > 0; });
    if (part == split.bodies.end()) return;
    const std::string text = fmt::format(
        "load {}: its axes are those of the floating frames of the parts of body {}, and with more frames those of its "
        "sections; for the same directions in any number of frames use axes: place or world",
        load.name, part->whole);
    if (words.empty() || words.back() != text) words.push_back(text);
  };
  for (const Load& load : split.loads) look(load, load.spread() ? load.body : load.at.body);
  return words;
}

Model assembled(const Plan& plan, const ReducedBodies& reduced) {
  Model model = assemble(plan, reduced.formulation, reduced.bodies);
  model.warnings.insert(model.warnings.end(), reduced.warnings.begin(), reduced.warnings.end());
  warn_of_scene(plan, model);
  return model;
}

}  // namespace

void warn_of_scene(const Plan& plan, Model& model) {
  for (std::string& words : middles_beside_nodes(plan.scene)) model.warnings.push_back(std::move(words));
  for (std::string& words : loads_in_axes_of_parts(plan.scene)) model.warnings.push_back(std::move(words));
  for (std::string& words : smoothed_drives(plan.scene)) model.warnings.push_back(std::move(words));
  for (std::string& words : damping_with_free_joints(plan)) model.warnings.push_back(std::move(words));
  model.stretched_start = stretched_start(plan, model);
  if (!model.stretched_start.empty()) model.warnings.push_back(model.stretched_start);
}

void give_structures(const std::shared_ptr<const Offline>& offline, Model& model) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (const PlannedBody& body = offline->plan.bodies[b]; is_meshed(body.spec))
      model.bodies[b].structure = {offline, &body.structure};
}

Model build(const Scene& whole, Formulation formulation, MPI_Comm comm, bool keep_offline) {
  refuse_meshless(whole, formulation);
  const auto offline = std::make_shared<Offline>(in_parts(whole, formulation, comm), comm);
  ReducedBodies reduced = reduced_bodies(*offline, formulation, keep_offline);
  Model model = assembled(offline->plan, reduced);
  give_structures(offline, model);
  if (!keep_offline) return model;
  offline->reduced = std::move(reduced.bodies);
  model.offline = offline;
  return model;
}

std::shared_ptr<const ReducedBodies> reduce_once(const Scene& whole, Formulation formulation, MPI_Comm comm) {
  Scene scene = in_parts(whole, formulation, comm);
  refuse_meshless(scene, formulation);
  Offline offline(std::move(scene), comm);
  return std::make_shared<const ReducedBodies>(reduced_bodies(offline, formulation));
}

Model build_on(const ReducedBodies& bodies, const Scene& whole) {
  const auto offline = std::make_shared<Offline>(in_parts(whole, bodies.formulation, bodies.comm), bodies.comm);
  Model model = assembled(offline->plan, bodies);
  give_structures(offline, model);
  if (!is_reduced(bodies.formulation)) return model;
  offline->reduced = bodies.bodies;
  model.offline = offline;
  return model;
}

}  // namespace floe::assembly
