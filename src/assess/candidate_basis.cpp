#include "floe/assess/candidate_basis.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "candidate_basis_parts.h"
#include "candidate_basis_text.h"
#include "floe/assembly/body_stage.h"
#include "floe/assembly/offline.h"
#include "floe/assembly/start_vectors.h"
#include "floe/fem/field_rows.h"
#include "floe/output/claim.h"
#include "floe/output/folder.h"
#include "floe/output/reduced_file.h"
#include "floe/petsc/error.h"
#include "floe/petsc/rank.h"
#include "floe/solve/simulation.h"
#include "matching_pursuit.h"

namespace floe::assess {

using petsc::check;
using reduction::ColumnOrigin;

namespace {

/// Derivatives are taken of so many generators of a body at most: 28 pairs.
constexpr std::size_t most_generators = 7;

/// With all that the candidate basis may offer, and no choice of the scene's own.
Scene generous(const Scene& whole, MPI_Comm comm) {
  Scene scene = split_frames(whole, comm);
  for (Body& body : scene.bodies) {
    if (!is_meshed(body)) continue;
    body.reduction.attachment = ReductionSpec::Attachment::all;
    body.reduction.columns.clear();
    body.reduction.linear = false;
  }
  return scene;
}

}  // namespace

std::size_t Selection::count() const { return std::count(taken.begin(), taken.end(), 1); }

CandidateBasis::Parts::Parts(const Scene& scene, MPI_Comm communicator)
    : whole(scene),
      comm(communicator),
      offline(std::make_shared<Offline>(generous(scene, communicator), communicator)) {}

std::set<std::string> CandidateBasis::Parts::deformed() const {
  std::set<std::string> names;
  for (std::size_t b = 0; b < sources.size(); ++b)
    if (flexible(b) && starts_deformed(body(b))) names.insert(whole_name(body(b).spec));
  return names;
}

/// The body on those of its columns that are taken, in their order.
const ReducedBody& CandidateBasis::Parts::reduced_body(std::size_t b, const std::vector<char>& taken) const {
  const auto found = reduced.find({b, taken});
  if (found != reduced.end()) return found->second;
  if (reduced.size() > 64) reduced.clear();
  const Source& source = sources[b];
  const PlannedBody& plan = body(b);
  std::vector<Vec> some;
  std::vector<ColumnOrigin> origins;
  // Of a body with a start of its own, or a piece.
  const bool none = std::find(taken.begin(), taken.end(), 1) == taken.end();
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (taken[i] || (none && i == 0)) some.push_back(source.columns[i]), origins.push_back(source.origins[i]);
  ReducedBody one;
  one.report = source.report;
  const double start = MPI_Wtime();
  fem::FieldRows candidates =
      fem::gather(plan.structure, static_cast<Eigen::Index>(some.size()),
                  [&](Eigen::Index j, double* local) { plan.structure.exchange.gather(some[j], local); });
  auto basis = std::make_shared<reduction::Basis>(reduction::orthonormal_basis(
      plan.structure, std::move(candidates), std::move(origins), plan.spec.reduction.drop_tolerance));
  reduction::keep_without_mass(plan.structure, some, *basis);
  project_onto(plan, std::move(basis), *source.statics, source.stage.modes_of_damping(), one);
  one.report.seconds_projection = MPI_Wtime() - start;
  one.statics = source.statics;
  join_start(plan, one);
  return reduced.emplace(std::pair{b, taken}, std::move(one)).first->second;
}

/// The scene prepared with some more rigid bodies. Those that are not must stay as they are in the candidate basis: a
/// body that a joint makes one with a rigid one would get its frame (shared_frames), for which the columns are not
/// made.
std::shared_ptr<Offline> CandidateBasis::Parts::offline_of(const std::vector<char>& made_rigid) const {
  std::shared_ptr<Offline>& one = rigid[made_rigid];
  if (one) return one;
  const auto prepared_with = [&](bool share_frames) {
    Scene scene = offline->scene;
    scene.share_frames = scene.share_frames && share_frames;
    for (std::size_t b = 0; b < made_rigid.size(); ++b)
      if (made_rigid[b]) scene.bodies[b].rigid = true;
    return std::make_shared<Offline>(std::move(scene), comm);
  };
  const auto same_frames = [&](const Offline& other) {
    for (std::size_t b = 0; b < made_rigid.size(); ++b)
      if (!made_rigid[b] && other.plan.bodies[b].parent != body(b).parent) return false;
    return true;
  };
  one = prepared_with(true);
  if (!same_frames(*one)) one = prepared_with(false);
  if (!same_frames(*one)) {
    rigid.erase(made_rigid);
    throw RunError("a flexible body would be welded to one that is replaced by a rigid body");
  }
  return one;
}

/// Of the generators that take part most.
reduction::Pairs CandidateBasis::Parts::leading_pairs(std::size_t b,
                                                      const std::vector<EnergyContribution>& order) const {
  const Source& source = sources[b];
  const std::size_t count = source.stage.generators.fields.size();
  std::vector<int> first;
  for (const EnergyContribution& one : order)  // by the places of the groups in this body
    for (std::size_t i = 0; i < count && first.size() < most_generators; ++i)
      if (source.group[i] == one.column) first.push_back(static_cast<int>(i));
  if (order.empty()) {
    first.resize(std::min(count, most_generators));
    std::iota(first.begin(), first.end(), 0);
  }
  std::sort(first.begin(), first.end());
  reduction::Pairs pairs;
  for (std::size_t i = 0; i < first.size(); ++i)
    for (std::size_t j = i; j < first.size(); ++j) pairs.push_back({first[i], first[j]});
  return pairs;
}

/// What is offered of one piece of a body is offered of all.
void CandidateBasis::Parts::add_derivatives(std::size_t b, const std::set<std::string>& offered) {
  Source& source = sources[b];
  reduction::Pairs pairs;
  for (const auto& pair : reduction::all_pairs(static_cast<int>(source.stage.generators.fields.size())))
    if (offered.contains(reduction::derivative_label(source.stage.generators, pair[0], pair[1]))) pairs.push_back(pair);
  const double start = MPI_Wtime();
  reduction::DerivativeColumns derivatives =
      derivatives_of(body(b), source.stage, pairs, body(b).spec.reduction.derivatives.full);
  source.report.seconds_derivatives = MPI_Wtime() - start;
  for (std::size_t i = 0; i < derivatives.columns.size(); ++i) {
    double size = 0;
    check(VecNorm(derivatives.columns[i], NORM_2, &size));
    if (size > 0) add(b, std::move(derivatives.columns[i]), std::move(derivatives.origins[i]), false);
  }
}

std::vector<EnergyContribution> CandidateBasis::linear_energy_contribution(const Scene& scene) const {
  Selection linear = whole();
  linear.linear = true;
  const Model model = this->model(linear);
  KeptMotion motion(model);
  const Motion& how = scene.motion;
  try {
    solve::Integration with{how.end, how.step, how.spectral_radius, {}, "ranking_"};
    with.kinks = kinks_of(scene, how.end);
    solve::simulate(*model.system, with, model.U, model.V,
                    [&](const solve::Instant& instant) { motion.keep(instant); });
  } catch (const solve::MotionStopped&) {
    // A linear body that is rotated too fast diverges: what it did until then ranks its columns.
  }
  return energy_contribution(model, motion.states());
}

CandidateBasis::CandidateBasis(const Scene& scene, MPI_Comm comm) : parts_(std::make_unique<Parts>(scene, comm)) {
  Parts& parts = *parts_;
  const Plan& plan = parts.offline->plan;
  parts.sources.resize(plan.bodies.size());
  bool many = false;
  for (std::size_t b = 0; b < plan.bodies.size(); ++b) {
    if (!parts.flexible(b)) continue;
    Source& source = parts.sources[b];
    begin_stage(plan, static_cast<int>(b), count_of_modes(parts.body(b)), source.stage, source.report);
    source.stage.solver.reset();
    const auto& fields = source.stage.generators.fields;
    for (std::size_t i = 0; i < fields.size(); ++i)
      parts.add(b, reduction::copy(fields[i]), source.stage.generators.origins[i], false);
    many = many || fields.size() > most_generators;
  }
  std::vector<EnergyContribution> order;
  if (many) {
    try {
      order = linear_energy_contribution(scene);
    } catch (const InputError&) {
      // A shape at the start that only derivatives bring to the joints (it stretches the body): no ranking.
    }
  }
  std::map<std::string, std::set<std::string>> offered;  // derivatives of a body's pieces
  for (std::size_t b = 0; b < plan.bodies.size(); ++b)
    if (parts.flexible(b))
      for (const auto& [i, j] : parts.leading_pairs(b, order))
        offered[whole_name(parts.body(b).spec)].insert(
            reduction::derivative_label(parts.sources[b].stage.generators, i, j));
  for (std::size_t b = 0; b < plan.bodies.size(); ++b) {
    if (!parts.flexible(b)) continue;
    parts.add_derivatives(b, offered[whole_name(parts.body(b).spec)]);
    parts.sources[b].statics = std::move(parts.sources[b].stage.statics);
  }
  parts.reduced.clear();  // those of the ranking have no factors
}

CandidateBasis::~CandidateBasis() = default;

const std::vector<CandidateVector>& CandidateBasis::columns() const { return parts_->columns; }

Selection CandidateBasis::whole() const { return {std::vector<char>(columns().size(), 1), false}; }

Model CandidateBasis::model(const Selection& selection, bool keep_offline) const {
  const Parts& parts = *parts_;
  const std::size_t count = parts.sources.size();
  const std::shared_ptr<Offline> offline = parts.offline_of(selection);
  std::vector<ReducedBody> bodies(count);
  for (std::size_t b = 0; b < count; ++b) {
    const PlannedBody& body = offline->plan.bodies[b];
    if (body.spec.rigid)
      bodies[b] = rigid(body);
    else if (body.spec.reduced)
      bodies[b] = from_file(body, Formulation::vm_md);
    else
      bodies[b] = parts.reduced_body(b, parts.taken_of(b, selection));
    if (selection.linear && !body.spec.rigid) bodies[b].body.elasticity = body::linearised(bodies[b].body.elasticity);
  }
  Model model = assemble(offline->plan, Formulation::vm_md, bodies);
  give_structures(offline, model);
  warn_of_scene(offline->plan, model);
  if (!keep_offline) return model;
  offline->reduced = std::move(bodies);
  model.offline = offline;
  return model;
}

int CandidateBasis::add_responses(const Estimate& estimate) {
  Parts& parts = *parts_;
  int count = 0;
  for (std::size_t b = 0; b < parts.sources.size() && b < estimate.responses.size(); ++b) {
    if (!estimate.responses[b] || !parts.flexible(b)) continue;
    const auto before = std::count_if(parts.sources[b].group.begin(), parts.sources[b].group.end(),
                                      [&](std::size_t group) { return parts.columns[group].response; });
    int number = static_cast<int>(before);
    for (const petsc::VecHandle& column : *estimate.responses[b]) {
      const ColumnOrigin origin{ColumnOrigin::Kind::attachment, fmt::format("response {}", ++number)};
      parts.add(b, reduction::copy(column), origin, true);
      ++count;
    }
  }
  parts.reduced.clear();
  return count;
}

void CandidateBasis::keep(std::size_t count) {
  Parts& parts = *parts_;
  parts.columns.resize(count);
  for (Source& source : parts.sources)
    while (!source.group.empty() && source.group.back() >= count)
      source.group.pop_back(), source.columns.pop_back(), source.origins.pop_back();
  parts.reduced.clear();
}

std::vector<EnergyContribution> CandidateBasis::energy_contribution(const Model& whole,
                                                                    const std::vector<solve::State>& states) const {
  const Parts& parts = *parts_;
  std::vector<Directions> bodies;
  for (std::size_t b = 0; b < parts.sources.size(); ++b) {
    if (!parts.flexible(b)) continue;
    const Source& source = parts.sources[b];
    const ReducedBody& reduced = parts.reduced_body(b, std::vector<char>(source.columns.size(), 1));
    const int k = reduced.body.coordinates();
    const Eigen::MatrixXd K = reduced.body.elasticity.linear_stiffness();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(K);  // round-off may make the least ones negative
    const Eigen::MatrixXd root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
                                 eigen.eigenvectors().transpose();
    Directions one;
    one.D.resize(k, static_cast<Eigen::Index>(source.columns.size()));
    for (std::size_t i = 0; i < source.columns.size(); ++i) {
      Eigen::VectorXd column(k);
      check(BVDotVec(reduced.basis->V, source.columns[i], column.data()));  // in the inner product of M, V'MV = 1
      one.D.col(static_cast<Eigen::Index>(i)) = root * column;
      one.group.push_back(static_cast<int>(source.group[i]));
    }
    one.Y.resize(k, static_cast<Eigen::Index>(states.size()));
    for (std::size_t s = 0; s < states.size(); ++s)
      one.Y.col(static_cast<Eigen::Index>(s)) = root * states[s].q.segment(whole.bodies[b].first_elastic, k);
    bodies.push_back(std::move(one));
  }
  std::vector<EnergyContribution> order;
  for (const Taken& one : matching_pursuit(std::move(bodies), static_cast<int>(columns().size())))
    order.push_back({static_cast<std::size_t>(one.group), one.share});
  return order;
}

std::string CandidateBasis::text(const Selection& selection, const Motion& motion) const {
  return candidates_text(parts_->whole, columns(), selection, motion, {}, parts_->shares_frames(selection),
                         parts_->deformed());
}

std::vector<std::string> CandidateBasis::deformed() const {
  const std::set<std::string> names = parts_->deformed();
  return {names.begin(), names.end()};
}

bool CandidateBasis::has_responses(const Selection& selection) const {
  if (selection.responses > 0) return false;
  for (std::size_t i = 0; i < columns().size(); ++i)
    if (selection.taken[i] && columns()[i].response) return true;
  return false;
}

namespace {

void check_free(MPI_Comm comm, const std::string& path, bool overwrite) {
  petsc::agree(comm, [&] {
    if (!overwrite && std::filesystem::exists(path))
      throw InputError(path + ": exists; expected another name, or --force");
  });
}

void write_text(MPI_Comm comm, const std::string& path, const std::string& text) {
  petsc::agree(comm, [&] {
    if (petsc::first_rank(comm)) output::write_file_atomically(path, text + "\n");
  });
}

}  // namespace

std::vector<std::string> CandidateBasis::write(const Selection& selection, const Motion& motion,
                                               const std::string& path, bool overwrite) const {
  const Parts& parts = *parts_;
  std::map<std::string, std::string> files;
  const std::filesystem::path scene(path);
  for (std::size_t i = 0; i < columns().size(); ++i)
    if (selection.taken[i] && columns()[i].response && selection.responses == 0)
      files[columns()[i].body] = scene.stem().string() + "-" + columns()[i].body + ".h5";
  const auto loaded = [&](const std::string& name) {
    return std::any_of(parts.whole.loads.begin(), parts.whole.loads.end(),
                       [&](const Load& load) { return load.kind == Load::Kind::pressure && load.body == name; });
  };
  for (const Body& body : parts.whole.bodies)
    if (const InitialSpec& start = body.initial;
        files.contains(body.name) && (start.deformation || start.deformation_rate || start.spatial_deformation ||
                                      start.spatial_deformation_rate || loaded(body.name)))
      throw InputError(body.where.text() +
                       ": has correction vectors of the error estimate, which a scene cannot specify, and an initial "
                       "deformation or a pressure, which a body from a file cannot have; expected another accuracy");
  for (const Body& body : parts.whole.bodies)
    if (files.contains(body.name) && body.frames > 1)
      throw InputError(body.where.text() +
                       ": is split into frames and has correction vectors of the error estimate, which a scene cannot "
                       "specify; expected frames: 1, or another accuracy");
  std::vector<std::string> written{path};
  check_free(parts.comm, path, overwrite);
  for (const auto& [name, file] : files) {
    const std::filesystem::path beside = scene.parent_path() / file;
    const output::Claim claim = output::claim_file(parts.comm, beside);
    output::check_reduced_path(parts.comm, beside, overwrite);
    for (std::size_t b = 0; b < parts.sources.size(); ++b) {
      if (parts.body(b).spec.name != name) continue;
      ReducedBody reduced = parts.reduced_body(b, parts.taken_of(b, selection));
      if (selection.linear) reduced.body.elasticity = body::linearised(reduced.body.elasticity);
      write_body(parts.offline->plan, parts.body(b), reduced, beside, overwrite);
    }
    written.push_back(beside.string());
  }
  const std::string text =
      candidates_text(parts.whole, columns(), selection, motion, files, parts.shares_frames(selection),
                      parts.deformed(), std::filesystem::absolute(scene).parent_path());
  write_text(parts.comm, path, text);
  return written;
}

void write_scene(const Scene& scene, const std::string& path, bool overwrite, MPI_Comm comm) {
  check_free(comm, path, overwrite);
  write_text(comm, path, scene_text(scene, std::filesystem::absolute(path).parent_path()));
}

}  // namespace floe::assess
