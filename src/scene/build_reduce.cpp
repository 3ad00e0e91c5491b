#include "build_reduce.h"

#include <fmt/format.h>
#include <petsctime.h>

#include <algorithm>
#include <numeric>

#include "floe/petsc/values.h"

namespace floe::scene {

using petsc::check;

namespace {

bool of_frame(const PreparedBody& body) { return body.spec.reduction.modes.of == ModesSpec::Of::frame; }

reduction::Attachment unit_load(const PreparedBody& body, PetscInt node, int component, const std::string& where) {
  static const char* names[3] = {"fx", "fy", "moment"};
  reduction::Attachment attachment{where + "." + names[component], fem::field(body.structure)};
  petsc::Values values(attachment.load);
  const PetscInt dof = 3 * node + component;
  if (dof >= values.first && dof < values.end) values[dof] = 1;
  return attachment;
}

/// Unit loads where joints and loads act. Where the ground holds a body and its modes are those of the held body, the
/// joint brings no column of its own.
std::vector<reduction::Attachment> attachments(const Prepared& prepared, int index) {
  using Choice = ReductionSpec::Attachment;
  const PreparedBody& body = prepared.bodies[index];
  const Choice choice = body.spec.reduction.attachment;
  std::vector<reduction::Attachment> all;
  for (std::size_t j = 0; j < prepared.joints.size(); ++j) {
    if (choice != Choice::joints && choice != Choice::all) break;
    const Joint& joint = prepared.scene.joints[j];
    const bool to_ground = prepared.joints[j][0].body < 0 || prepared.joints[j][1].body < 0;
    if (to_ground && joint.kind != Joint::Kind::spring && !of_frame(body)) continue;
    const bool moment = joint.kind == Joint::Kind::spring
                            ? joint.torsional_stiffness != 0 || joint.torsional_viscosity != 0
                            : joint.kind != Joint::Kind::revolute;
    for (const PreparedPlace& place : prepared.joints[j])
      for (int c = 0; place.body == index && c < (moment ? 3 : 2); ++c)
        all.push_back(unit_load(body, place.node, c, joint.name));
  }
  for (std::size_t l = 0; l < prepared.loads.size(); ++l) {
    if (choice != Choice::loads && choice != Choice::all) break;
    const Load& load = prepared.scene.loads[l];
    if (prepared.loads[l].body != index || load.kind == Load::Kind::distributed) continue;
    const bool moment = load.kind == Load::Kind::moment;
    for (int c = moment ? 2 : 0; c < (moment ? 3 : 2); ++c)
      all.push_back(unit_load(body, prepared.loads[l].node, c, load.name));
  }
  return all;
}

/// C = sum 2 zeta_i omega_i (V'M phi_i)(V'M phi_i)' + alpha V'MV + beta V'KV.
Eigen::MatrixXd damping_matrix(const PreparedBody& body, const ReducedBody& reduced, const reduction::Modes& modes) {
  const DampingSpec& spec = body.spec.damping;
  const int k = reduced.body.coordinates();
  if (spec.mass == 0 && spec.stiffness == 0 && spec.modal.empty()) return {};
  Eigen::MatrixXd C = spec.stiffness * reduced.body.elasticity.linear_stiffness();
  C.diagonal().array() += spec.mass;
  for (std::size_t i = 0; i < std::min(spec.modal.size(), modes.omega.size()); ++i) {
    Eigen::VectorXd along(k);
    check(BVDotVec(reduced.basis->V, modes.shapes[i], along.data()));  // in the inner product of M
    C += 2 * spec.modal[i] * modes.omega[i] * along * along.transpose();
  }
  return C;
}

/// What one body carries through the stages of its reduction.
struct Stage {
  fem::Holding for_modes, for_statics;
  std::unique_ptr<reduction::Statics> statics;
  reduction::Generators generators;
  reduction::Pairs pairs;
};

void begin(const Prepared& prepared, int index, int modes, Stage& stage, BodyReport& report) {
  const PreparedBody& body = prepared.bodies[index];
  const double start = MPI_Wtime();
  stage.for_statics = fem::holding(body.structure, body.frame, body.held);
  stage.for_modes =
      of_frame(body) ? fem::holding(body.structure, body.frame, body.frame.conditions) : stage.for_statics;
  stage.statics = std::make_unique<reduction::Statics>(body.structure, body.frame, stage.for_statics);
  try {
    stage.generators = reduction::generators(body.structure, body.frame, stage.for_modes, *stage.statics, modes,
                                             attachments(prepared, index), body.spec.reduction.drop_tolerance);
  } catch (const InputError& error) {
    throw InputError(body.spec.reduction.modes.where.text() + ": " + error.what());
  }
  report.omega = stage.generators.modes.omega;
  report.residual = stage.generators.modes.residual;
  report.seconds_modes = MPI_Wtime() - start;
}

void end(const PreparedBody& body, const Stage& stage, reduction::DerivativeColumns derivatives, ReducedBody& reduced) {
  const double start = MPI_Wtime();
  reduced.basis = std::make_shared<reduction::Basis>(reduction::basis_of(
      body.structure, stage.generators, std::move(derivatives), body.spec.reduction.drop_tolerance));
  reduced.body = reduction::project(body.structure, *reduced.basis);
  reduced.damping = damping_matrix(body, reduced, stage.generators.modes);
  reduced.report.columns = reduced.basis->columns;
  reduced.report.origins = reduced.basis->origins;
  reduced.report.basis = reduced.basis;
  reduced.report.seconds_projection = MPI_Wtime() - start;
}

/// theta_ij by maximum modal interaction: int |eta_i eta_j| dt |theta_ij|_M, greatest first. Source: Tiso 2011.
void rank_pairs(const PreparedBody& body, Stage& stage, const Eigen::MatrixXd& interaction, int count,
                std::vector<double>& weights) {
  const reduction::Pairs all = reduction::all_pairs(static_cast<int>(stage.generators.fields.size()));
  const reduction::Columns theta =
      reduction::static_derivatives(body.structure, *stage.statics, stage.generators.fields, all);
  const petsc::MatHandle M = fem::mass(body.structure, {});
  std::vector<double> weight;
  for (std::size_t p = 0; p < all.size(); ++p)
    weight.push_back(interaction(all[p][0], all[p][1]) * reduction::mass_norm(M, theta[p]));
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return weight[a] > weight[b]; });
  stage.pairs.clear();
  for (std::size_t i = 0; i < order.size() && static_cast<int>(i) < count; ++i) {
    stage.pairs.push_back(all[order[i]]);
    weights.push_back(weight[order[i]] / weight[order[0]]);
  }
}

reduction::Pairs pairs_of(const DerivativesSpec& spec, int fields) {
  using Choice = DerivativesSpec::Choice;
  if (spec.choice == Choice::all) return reduction::all_pairs(fields);
  reduction::Pairs pairs;
  if (spec.choice == Choice::pairs)
    for (const auto& [i, j] : spec.pairs) pairs.push_back({i - 1, j - 1});
  return pairs;
}

/// How many modes stand in for modes and derivatives in formulation vm: as many as these had columns.
int modes_alone(const Prepared& prepared, int index) {
  const ReductionSpec& spec = prepared.bodies[index].spec.reduction;
  if (spec.modes.alone > 0) return spec.modes.alone;
  using Choice = DerivativesSpec::Choice;
  const int fields = spec.modes.count;
  int derivatives = 0;
  if (spec.derivatives.choice == Choice::all) derivatives = fields * (fields + 1) / 2;
  if (spec.derivatives.choice == Choice::count) derivatives = spec.derivatives.count;
  if (spec.derivatives.choice == Choice::pairs) derivatives = static_cast<int>(spec.derivatives.pairs.size());
  const PreparedBody& body = prepared.bodies[index];
  const PetscInt available = body.structure.dofs() - 3 - static_cast<PetscInt>(body.held.size());
  return static_cast<int>(std::min<PetscInt>(fields + derivatives, available));
}

void warn(const Prepared& prepared, int index, Formulation formulation, std::vector<std::string>& warnings) {
  const PreparedBody& body = prepared.bodies[index];
  const ReductionSpec& spec = body.spec.reduction;
  const bool no_columns =
      spec.attachment == ReductionSpec::Attachment::none || spec.attachment == ReductionSpec::Attachment::loads;
  for (std::size_t j = 0; j < prepared.joints.size(); ++j) {
    const Joint& joint = prepared.scene.joints[j];
    const bool touches = prepared.joints[j][0].body == index || prepared.joints[j][1].body == index;
    const bool to_ground = prepared.joints[j][0].body < 0 || prepared.joints[j][1].body < 0;
    const bool moment = joint.kind == Joint::Kind::fixed || joint.kind == Joint::Kind::driven;
    if (!touches || !moment || !no_columns) continue;
    if (body.spec.frame.kind == FrameSpec::Kind::clamped && to_ground) continue;
    if (to_ground && !of_frame(body)) continue;
    warnings.push_back(fmt::format(
        "body {}: its modes cannot carry the moment of joint {} (they have none there), and converge slowly. Choose "
        "{}attachment: joints",
        body.spec.name, joint.name, to_ground ? "modes: {of: joints}, or " : ""));
  }
  if (formulation == Formulation::vm || spec.derivatives.choice == DerivativesSpec::Choice::none)
    if (static_cast<PetscInt>(body.held.size()) > 3 && formulation != Formulation::vm)
      warnings.push_back(
          fmt::format("body {}: its joints hold it lengthwise, and without derivatives no column can give way to the "
                      "bending: its cubic "
                      "stiffness comes out too high (by half for a hinged beam)",
                      body.spec.name));
}

}  // namespace

ReducedBody rigid(const PreparedBody& body) {
  ReducedBody reduced;
  reduced.basis = std::make_shared<reduction::Basis>();
  reduced.body = reduction::rigid_body(body.structure);
  reduced.report.rigid = true;
  return reduced;
}

std::vector<BodyReport> modes_of_bodies(const Prepared& prepared) {
  std::vector<BodyReport> reports;
  for (std::size_t b = 0; b < prepared.bodies.size(); ++b) {
    const PreparedBody& body = prepared.bodies[b];
    BodyReport report;
    report.name = body.spec.name;
    report.rigid = body.spec.rigid;
    report.nodes = body.structure.mesh.node_count, report.elements = body.structure.mesh.cell_count;
    report.dofs = body.structure.dofs();
    Stage stage;
    if (!report.rigid) begin(prepared, static_cast<int>(b), body.spec.reduction.modes.count, stage, report);
    reports.push_back(std::move(report));
  }
  return reports;
}

std::vector<ReducedBody> reduce_bodies(const Prepared& prepared, Formulation formulation,
                                       const InteractionRun& linear_run, std::vector<std::string>& warnings) {
  const int count = static_cast<int>(prepared.bodies.size());
  std::vector<Stage> stages(count);
  std::vector<ReducedBody> all(count);
  bool ranked = false;
  for (int b = 0; b < count; ++b) {
    const Body& spec = prepared.bodies[b].spec;
    if (spec.rigid) {
      all[b] = rigid(prepared.bodies[b]);
      continue;
    }
    const bool alone = formulation == Formulation::vm;
    begin(prepared, b, alone ? modes_alone(prepared, b) : spec.reduction.modes.count, stages[b], all[b].report);
    if (!alone)
      stages[b].pairs = pairs_of(spec.reduction.derivatives, static_cast<int>(stages[b].generators.fields.size()));
    ranked = ranked || (!alone && spec.reduction.derivatives.choice == DerivativesSpec::Choice::count);
    warn(prepared, b, formulation, warnings);
  }
  std::vector<std::vector<double>> weights(count);
  if (ranked) {
    std::vector<ReducedBody> linear = {};
    for (int b = 0; b < count; ++b) {
      linear.push_back(all[b]);
      if (prepared.bodies[b].spec.rigid) continue;
      end(prepared.bodies[b], stages[b], {}, linear[b]);
      linear[b].body.elasticity = body::linearised(linear[b].body.elasticity);
    }
    const std::vector<Eigen::MatrixXd> interaction = linear_run(linear);
    for (int b = 0; b < count; ++b) {
      const DerivativesSpec& spec = prepared.bodies[b].spec.reduction.derivatives;
      if (!prepared.bodies[b].spec.rigid && spec.choice == DerivativesSpec::Choice::count)
        rank_pairs(prepared.bodies[b], stages[b], interaction[b], spec.count, weights[b]);
    }
  }
  for (int b = 0; b < count; ++b) {
    const PreparedBody& body = prepared.bodies[b];
    if (body.spec.rigid) continue;
    const double start = MPI_Wtime();
    reduction::DerivativeColumns derivatives =
        reduction::derivative_columns(body.structure, body.frame, stages[b].for_modes, *stages[b].statics,
                                      stages[b].generators, stages[b].pairs, body.spec.reduction.derivatives.full);
    for (std::size_t i = 0; i < std::min(weights[b].size(), derivatives.origins.size()); ++i)
      derivatives.origins[i].interaction = weights[b][i];
    all[b].report.seconds_derivatives = MPI_Wtime() - start;
    end(body, stages[b], std::move(derivatives), all[b]);
  }
  return all;
}

}  // namespace floe::scene
