#include "floe/assembly/body_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "floe/assembly/damping.h"
#include "floe/fem/field_rows.h"
#include "floe/fem/joint_frame.h"
#include "floe/math/nearest.h"
#include "floe/plan/attachments.h"
#include "floe/plan/interface.h"
#include "floe/reduction/condensation.h"
#include "floe/reduction/products.h"

namespace floe::assembly {

using petsc::check;

namespace {

/// Modal: C = sum 2 zeta_i / omega_i^3 (V'K phi_i)(V'K phi_i)'.
///
/// K does not see the rigid motion by which a mode in the frame differs from the mode in space, of unit mass: whatever
/// the frame, phi_i'K phi_i = omega_i^2.
Eigen::MatrixXd modal_damping(const PlannedBody& body, const ReducedBody& reduced, const reduction::Modes& modes) {
  const std::vector<double>& ratios = body.spec.damping.modal;
  const int k = reduced.body.coordinates();
  if (ratios.empty() || body.spec.piece > 0) return {};  // of pieces: WholeModes
  const Eigen::MatrixXd K = reduced.body.elasticity.linear_stiffness();
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(k, k);
  for (std::size_t i = 0; i < std::min(ratios.size(), modes.omega.size()); ++i) {
    Eigen::VectorXd phi(k);
    check(BVDotVec(reduced.basis->V, modes.shapes[i], phi.data()));  // in the inner product of M, V'MV = I
    const Eigen::VectorXd force = K * phi;
    C += 2 * ratios[i] / std::pow(modes.omega[i], 3) * force * force.transpose();
  }
  return C;
}

/// Of each coordinate whether it is a derivative's.
std::vector<char> following(const reduction::Basis& basis) {
  std::vector<char> follows;
  for (const reduction::ColumnOrigin& origin : basis.origins)
    if (origin.kept) follows.push_back(origin.kind == reduction::ColumnOrigin::Kind::derivative);
  return follows;
}

void omit_products(const ReductionSpec& spec, ReducedBody& reduced) {
  const std::size_t all = reduced.body.elasticity.pairs.size();
  if (const double share = spec.products.value_or(0); share > 0)
    reduced.body.elasticity = reduction::with_fewer_products(reduced.body, following(*reduced.basis), share);
  reduced.report.products = static_cast<int>(reduced.body.elasticity.pairs.size());
  reduced.report.omitted_products = static_cast<int>(all) - reduced.report.products;
}

}  // namespace

void find_relief(const PlannedBody& body, const reduction::Statics& statics, ReducedBody& reduced) {
  reduced.relief = {};
  if (body.spec.reduction.linear) return;
  reduction::Columns W =
      reduction::relief(body.structure, *reduced.basis, statics, reduced.body, following(*reduced.basis));
  if (!W.empty()) reduced.relief.W = std::make_shared<const reduction::Columns>(std::move(W));
}

void condense(const PlannedBody& body, ReducedBody& reduced) {
  reduced.body.elasticity =
      reduction::condensed(body.structure, *reduced.basis, reduced.body.elasticity, reduced.relief);
}

void finish_elasticity(const PlannedBody& body, ReducedBody& reduced) {
  if (body.spec.reduction.linear) {
    reduced.body.elasticity = body::linearised(reduced.body.elasticity);
    return;
  }
  condense(body, reduced);
  omit_products(body.spec.reduction, reduced);
}

const std::string& whole_name(const Body& body) { return body.piece > 0 ? body.whole : body.name; }

std::string label_of_piece(const Body& body, const std::string& label) {
  return body.piece > 0 ? fmt::format("#{} {}", body.piece, label) : label;
}

std::vector<std::string> named_columns(const Body& body) {
  const std::string own = label_of_piece(body, "");
  std::vector<std::string> all;
  for (const std::string& label : body.reduction.columns)
    if (!label.starts_with('#'))
      all.push_back(label);
    else if (!own.empty() && label.starts_with(own))
      all.push_back(label.substr(own.size()));
  return all;
}

int count_of_modes(const PlannedBody& body) {
  return body.spec.reduction.modes.given ? body.spec.reduction.modes.count : as_the_body_has;
}

void generate(const Plan& plan, int index, int modes, Stage& stage, BodyReport& report) {
  const PlannedBody& body = plan.bodies[index];
  const double start = MPI_Wtime();
  try {
    stage.generators = reduction::generators(body.structure, *stage.statics, stage.solver->solve(modes),
                                             stage.attachments, body.spec.reduction.drop_tolerance);
  } catch (const InputError& error) {
    throw InputError(body.spec.reduction.modes.where.text() + ": " + error.what());
  }
  report.omega = stage.generators.modes.omega;
  report.residual = stage.generators.modes.residual;
  report.left_out = stage.generators.modes.left_out;
  report.free_motions = static_cast<int>(stage.for_modes.left.cols());
  report.intra_deflection.clear();
  if (body.structure.dimension() == 3)
    for (const petsc::VecHandle& shape : stage.generators.modes.shapes)  // one by one, for their memory
      report.intra_deflection.push_back(
          fem::intra_deflections(body.structure, fem::gather(body.structure, 1, [&](Eigen::Index, double* local) {
                                   body.structure.exchange.gather(shape, local);
                                 }))[0]);
  report.seconds_modes = MPI_Wtime() - start;
}

fem::Holding holding_of_modes(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  return fem::holding(body.structure, body.frame,
                      of_frame(body) ? body.frame.conditions : constrained_by_modes(plan, index));
}

namespace {

/// fem::balance(), and zero where the joints react to all of the load but for round-off. Collective.
void balance_exactly(const fem::ReferenceFrame& joints, Vec load) {
  double before = 0, after = 0;
  check(VecNorm(load, NORM_INFINITY, &before));
  fem::balance(joints, load);
  check(VecNorm(load, NORM_INFINITY, &after));
  if (after <= 1e-12 * before) check(VecSet(load, 0));
}

}  // namespace

void begin_stage(const Plan& plan, int index, int modes, Stage& stage, BodyReport& report) {
  const PlannedBody& body = plan.bodies[index];
  check_interface(plan, index);
  stage.for_statics = fem::holding(body.structure, body.frame, constrained_by_modes(plan, index));
  stage.for_modes = of_frame(body) ? holding_of_modes(plan, index) : stage.for_statics;
  stage.statics = std::make_unique<reduction::Statics>(body.structure, body.frame, stage.for_statics);
  stage.solver = std::make_unique<reduction::ModeSolver>(body.structure, body.frame, stage.for_modes, *stage.statics);
  stage.attachments = attachments(plan, index);
  if (balanced_by_joints(plan, index)) {  // a torque at the end of a clamped shaft twists it uniformly
    const fem::ReferenceFrame joints = fem::joint_frame(body.structure, body.frame, constrained_by_modes(plan, index));
    for (const reduction::Attachment& attachment : stage.attachments)
      if (attachment.load) balance_exactly(joints, attachment.load);
  }
  if (modes == as_the_body_has)
    modes = static_cast<int>(std::min<PetscInt>(body.spec.reduction.modes.count, stage.solver->available()));
  generate(plan, index, modes, stage, report);
  stage.damped = modes_for_damping(plan, index);
  if (stage.damped) report.damped = stage.damped->omega;
}

reduction::Pairs pairs_of(const DerivativesSpec& spec, const reduction::Generators& generators) {
  using Choice = DerivativesSpec::Choice;
  reduction::Pairs pairs;
  if (spec.choice == Choice::all) {
    for (const auto& pair : reduction::all_pairs(static_cast<int>(generators.fields.size())))
      if (std::none_of(pair.begin(), pair.end(), [&](int i) { return generators.origins[i].of_higher_vector; }))
        pairs.push_back(pair);
    return pairs;
  }
  if (spec.choice == Choice::pairs)
    for (const auto& [i, j] : spec.pairs) {
      if (const int modes = static_cast<int>(generators.modes.omega.size()); j > modes)
        throw InputError(
            fmt::format("{}: [{}, {}] refers to mode {}; expected at most {}, the number of modes of the body",
                        spec.where.text(), i, j, j, modes));
      pairs.push_back({i - 1, j - 1});
    }
  return pairs;
}

std::vector<std::string> keep_named(const PlannedBody& body, Stage& stage) {
  const ReductionSpec& spec = body.spec.reduction;
  const std::vector<std::string> wanted = named_columns(body.spec);
  const auto take = [&](const std::string& label) {
    return std::find(wanted.begin(), wanted.end(), label) != wanted.end();
  };
  std::vector<std::string> all;
  stage.left_out.clear();
  for (const reduction::ColumnOrigin& origin : stage.generators.origins)
    all.push_back(origin.label), stage.left_out.push_back(!take(origin.label));
  stage.pairs.clear();
  for (const auto& pair : reduction::all_pairs(static_cast<int>(stage.generators.fields.size())))
    for (const bool rotated : {false, true}) {  // with inertia (i, j) and (j, i) differ
      if (rotated && (!spec.derivatives.full || pair[0] == pair[1])) continue;
      all.push_back(reduction::derivative_label(stage.generators, pair[rotated], pair[1 - rotated]));
      if (take(all.back()) && (stage.pairs.empty() || stage.pairs.back() != pair)) stage.pairs.push_back(pair);
    }
  return all;
}

void refuse_unknown(const Plan& plan, const std::vector<std::vector<std::string>>& labels) {
  std::map<std::string, std::vector<std::string>> known;  // of all pieces of a body
  for (std::size_t b = 0; b < labels.size(); ++b) {
    std::vector<std::string>& all = known[whole_name(plan.bodies[b].spec)];
    all.insert(all.end(), labels[b].begin(), labels[b].end());
    if (plan.bodies[b].spec.piece > 0)
      for (const std::string& label : labels[b]) all.push_back(label_of_piece(plan.bodies[b].spec, label));
  }
  std::vector<std::string> faults;
  std::set<std::pair<int, int>> reported;  // lines and columns: copies of a body have those of the original
  for (std::size_t b = 0; b < labels.size(); ++b) {
    const ReductionSpec& spec = plan.bodies[b].spec.reduction;
    const std::pair<int, int> line{spec.columns_where.line, spec.columns_where.column};
    const std::string name = whole_name(plan.bodies[b].spec);
    if (labels[b].empty() || (b > 0 && name == whole_name(plan.bodies[b - 1].spec)) || reported.count(line)) continue;
    const std::vector<std::string>& all = known[name];
    for (const std::string& label : spec.columns) {
      if (std::find(all.begin(), all.end(), label) != all.end()) continue;
      const std::string near = math::nearest(label, all);
      faults.push_back(fmt::format(
          "{}: body {} has no basis vector \"{}\"; expected one that `floe run` lists in summary.json{}",
          spec.columns_where.text(), name, label, near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
      reported.insert(line);
    }
  }
  if (!faults.empty()) throw InputError(faults);
}

reduction::DerivativeColumns derivatives_of(const PlannedBody& body, const Stage& stage, const reduction::Pairs& pairs,
                                            bool full) {
  reduction::DerivativeColumns all = reduction::derivative_columns(body.structure, body.frame, stage.for_modes,
                                                                   *stage.statics, stage.generators, pairs, full);
  if (body.spec.reduction.columns.empty()) return all;
  const std::vector<std::string> wanted = named_columns(body.spec);
  reduction::DerivativeColumns some;
  for (std::size_t i = 0; i < all.columns.size(); ++i) {
    if (std::find(wanted.begin(), wanted.end(), all.origins[i].label) == wanted.end()) continue;
    some.columns.push_back(std::move(all.columns[i]));
    some.origins.push_back(std::move(all.origins[i]));
  }
  return some;
}

void project_onto(const PlannedBody& body, std::shared_ptr<reduction::Basis> basis, const reduction::Statics& statics,
                  const reduction::Modes& modes, ReducedBody& reduced) {
  reduced.basis = std::move(basis);
  reduced.body = reduction::project(body.structure, *reduced.basis);
  find_relief(body, statics, reduced);
  finish_elasticity(body, reduced);
  reduced.damping = modal_damping(body, reduced, modes);
  reduced.report.columns = reduced.basis->columns;
  reduced.report.origins = reduced.basis->origins;
  reduced.report.basis = reduced.basis;
}

void end_stage(const PlannedBody& body, const Stage& stage, reduction::DerivativeColumns derivatives,
               ReducedBody& reduced) {
  const double start = MPI_Wtime();
  const double tolerance = body.spec.reduction.drop_tolerance;
  project_onto(body,
               std::make_shared<reduction::Basis>(reduction::basis_of(
                   body.structure, stage.generators, std::move(derivatives), tolerance, stage.left_out)),
               *stage.statics, stage.modes_of_damping(), reduced);
  reduced.report.seconds_projection = MPI_Wtime() - start;
}

}  // namespace floe::assembly
