#include "floe/assembly/reduce_bodies.h"

#include <fmt/format.h>
#include <petsctime.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "floe/assembly/body_stage.h"
#include "floe/assembly/damping.h"
#include "floe/assembly/mode_warnings.h"
#include "floe/assembly/shared_reduction.h"
#include "floe/fem/element_count.h"
#include "floe/plan/attachments.h"
#include "floe/plan/held_by_modes.h"
#include "floe/plan/hold_at_frame.h"
#include "floe/plan/interface.h"
#include "floe/plan/mesh_copy.h"
#include "floe/reduction/ranking.h"

namespace floe::assembly {

using petsc::check;

namespace {

/// theta_ij by maximum modal interaction, int |eta_i eta_j| dt |what theta_ij adds|_M (half of it for i = j, as in the
/// series u = phi_i eta_i + 1/2 theta_ij eta_i eta_j): one after the other, each without what the generators and those
/// before it span. Source of the interaction: Tiso 2011.
void rank_pairs(const PlannedBody& body, Stage& stage, const Eigen::MatrixXd& interaction, int count,
                std::vector<double>& weights) {
  const reduction::Pairs all = reduction::all_pairs(static_cast<int>(stage.generators.fields.size()));
  const reduction::Columns theta = derivatives_of(body, stage, all, false).columns;
  std::vector<double> factors;
  for (const auto& [i, j] : all) factors.push_back((i == j ? 0.5 : 1) * interaction(i, j));
  stage.pairs.clear();
  for (const reduction::Ranked& next : reduction::rank(body.structure, stage.generators.fields, theta, factors, count,
                                                       body.spec.reduction.drop_tolerance)) {
    stage.pairs.push_back(all[next.candidate]);
    weights.push_back(next.weight);
  }
}

/// Whether more than the rigid motions is constrained to the ground, so that bending has to stretch the body. In space
/// one clamped edge holds many dofs and lets the rest of the body follow: there two joints, on nodes of their own.
bool constrained_lengthwise(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  if (body.structure.dimension() == 2) return body.constrained.size() > 3;
  std::vector<const Anchor*> places;
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const Anchor* constrained = constrained_place(plan, j);
    if (constrained && constrained->body == index && plan.scene.joints[j].kind != Joint::Kind::spring)
      places.push_back(constrained);
  }
  return std::any_of(places.begin(), places.end(),
                     [&](const Anchor* place) { return !share_a_node(*place, *places.front()); });
}

void warn(const Plan& plan, int index, Formulation formulation, std::vector<std::string>& warnings) {
  const PlannedBody& body = plan.bodies[index];
  const ReductionSpec& spec = body.spec.reduction;
  const bool no_columns =
      spec.attachment == ReductionSpec::Attachment::none || spec.attachment == ReductionSpec::Attachment::loads;
  const auto of_interface = [&](const Anchor& joint) {
    return std::any_of(body.interface.begin(), body.interface.end(),
                       [&](const Anchor& place) { return place.moved_by(joint.node); });
  };
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const Joint& joint = plan.scene.joints[j];
    const bool touches = plan.joints[j][0].body == index || plan.joints[j][1].body == index;
    const Anchor* constrained = constrained_place(plan, j);
    const bool constrained_here = constrained && constrained->body == index;
    const bool moment = joint.kind == Joint::Kind::fixed || joint.kind == Joint::Kind::driven;
    if (!touches || !moment || !no_columns) continue;
    if (body.frame.kind == fem::ReferenceFrame::Kind::clamped && constrained_here) continue;
    if (constrained_here && !of_frame(body)) continue;
    if (joins_at_frame(plan, index, j)) continue;
    const auto& [first, second] = plan.joints[j];
    if (of_interface(first.body == index ? first : second)) continue;  // its columns carry all
    warnings.push_back(fmt::format(
        "body {}: its modes have no moment at joint {}, so that the basis converges slowly; use {}attachment: joints",
        body.spec.name, joint.name, constrained_here ? "modes: {of: joints}, or " : ""));
  }
  if (formulation == Formulation::vm || spec.derivatives.choice == DerivativesSpec::Choice::none)
    if (constrained_lengthwise(plan, index) && formulation != Formulation::vm)
      warnings.push_back(
          fmt::format("body {}: its joints prevent axial displacement, and without modal derivatives the basis locks "
                      "in membrane: its cubic stiffness is too high (by half for a hinged beam); add modal derivatives",
                      body.spec.name));
}

/// From so many on they take most of a step (docs/benchmarks/online.md).
constexpr int many_products = 300;
/// Coefficients of F for each dof from which on a step is reported as longer than that of the full-order model: at
/// twice as many as make them equal for 8 x 2 quadrilaterals (17 ns for each of 4.8 million coefficients, 80 ms; 17 us
/// for each of 162 dofs, 2.7 ms).
constexpr Eigen::Index coefficients_per_dof = 2000;

/// Of the pieces of a body, of the one that has most.
void warn_of_products(const Plan& plan, const std::vector<SharedReduction>& shared, const std::vector<ReducedBody>& all,
                      std::vector<std::string>& warnings) {
  std::map<std::string, std::size_t> most;  // by body of the scene
  for (std::size_t b = 0; b < all.size(); ++b) {
    const Body& spec = plan.bodies[b].spec;
    if (shared[b].of >= 0 || spec.reduction.products || all[b].report.products <= many_products) continue;
    const auto [at, first] = most.try_emplace(whole_name(spec), b);
    if (!first && all[b].report.products > all[at->second].report.products) at->second = b;
  }
  for (const auto& [name, b] : most) {
    const auto dofs = plan.bodies[b].structure.dofs();
    const std::string full = all[b].body.elasticity.F.size() > coefficients_per_dof * dofs
                                 ? fmt::format(
                                       "; with {} basis vectors for {} dofs the full-order models (nlffr, cfr) "
                                       "can be faster, or take fewer derivatives (derivatives: 8)",
                                       all[b].report.columns, dofs)
                                 : "";
    warnings.push_back(fmt::format(
        "body {}: {} products of coordinates in its elastic force take most of a step; products: 3 % "
        "(reduction) omits those that hardly move the body, products: all keeps them and silences this warning{}",
        plan.bodies[b].spec.name, all[b].report.products, full));
  }
}

/// Loads that bend the body in ways that no column has: of the work f'K^-1 f that a load does on its own static
/// response, the basis holds (V'f)' K_r^-1 (V'f). Says so below one half. Collective.
/// @param stage, reduced  of the body, or of the one whose reduction it has
void warn_of_loads(const Plan& plan, int index, const fem::Placement& placement, const Stage& stage,
                   const ReducedBody& reduced, std::vector<std::string>& warnings) {
  const PlannedBody& body = plan.bodies[index];
  if (body.structure.dimension() == 2) return;
  std::vector<reduction::Attachment> loads = loads_on(plan, index);
  if (loads.empty()) return;
  fem::Placement back = placement;
  back.rotation.transposeInPlace();
  for (reduction::Attachment& load : loads) load.load = fem::placed(body.structure, back, load.load);
  reduction::Columns copies;
  for (const reduction::Attachment& load : loads) {
    petsc::VecHandle one = fem::field(body.structure);
    check(VecCopy(load.load, one));
    copies.push_back(std::move(one));
  }
  const reduction::Columns responses = stage.statics->solve(copies);
  const int k = reduced.body.coordinates();
  const Eigen::LDLT<Eigen::MatrixXd> stiffness(reduced.body.elasticity.linear_stiffness());
  for (std::size_t l = 0; l < loads.size(); ++l) {
    double whole = 0, size = 0, length = 0;
    check(VecDot(loads[l].load, responses[l], &whole));
    check(VecNorm(loads[l].load, NORM_2, &size));
    check(VecNorm(responses[l], NORM_2, &length));
    if (!(whole > 1e-9 * size * length)) continue;  // where the joints hold it
    Eigen::VectorXd image(k);
    for (int i = 0; i < k; ++i) {
      Vec column = nullptr;
      check(BVGetColumn(reduced.basis->V, i, &column));
      check(VecDot(loads[l].load, column, &image[i]));
      check(BVRestoreColumn(reduced.basis->V, i, &column));
    }
    const double part = k > 0 ? image.dot(stiffness.solve(image)) / whole : 0;
    if (part >= 0.5) continue;
    const std::string text = fmt::format(
        "body {}: its basis represents {:.2g} % of the work of load {} on its static response (limit 50 %); use "
        "attachment: {}",
        body.spec.name, 100 * std::max(part, 0.0), loads[l].label,
        body.spec.reduction.attachment == ReductionSpec::Attachment::joints ? "all" : "loads");
    if (std::find(warnings.begin(), warnings.end(), text) == warnings.end()) warnings.push_back(text);
  }
}

/// Without derivatives the basis holds the fields in order: fields = V T, T = V'M fields, eta = T^-1 q.
Eigen::MatrixXd coordinates_of_fields(const Stage& stage, const ReducedBody& reduced) {
  const int k = reduced.body.coordinates();
  Eigen::MatrixXd T(k, k);
  for (int i = 0; i < k; ++i) check(BVDotVec(reduced.basis->V, stage.generators.fields[i], T.col(i).data()));
  return T.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(k, k));
}

/// Pairs of the bodies whose derivatives are chosen by count, after one linear run. @return their weights
std::vector<std::vector<double>> choose_by_count(const Plan& plan, Formulation formulation,
                                                 const InteractionRun& linear_run, std::vector<Stage>& stages,
                                                 const std::vector<ReducedBody>& begun,
                                                 const std::vector<SharedReduction>& shared) {
  std::vector<std::vector<double>> weights(stages.size());
  auto chooses = [&](std::size_t b) {
    const Body& spec = plan.bodies[b].spec;
    return is_meshed(spec) && spec.reduction.derivatives.choice == DerivativesSpec::Choice::count &&
           !(formulation == Formulation::vm && spec.reduction.modes.alone > 0);
  };
  bool any = false;
  for (std::size_t b = 0; b < stages.size(); ++b) any = any || chooses(b);
  if (!any) return weights;
  std::vector<ReducedBody> linear = begun;
  for (std::size_t b = 0; b < stages.size(); ++b) {
    if (plan.bodies[b].spec.rigid) continue;
    if (plan.bodies[b].spec.reduced) {
      linear[b] = from_file(plan.bodies[b], Formulation::lffr);
      continue;
    }
    if (shared[b].of >= 0) {
      linear[b] = shared_body(plan, static_cast<int>(b), shared[b], linear[shared[b].of]);
      continue;
    }
    end_stage(plan.bodies[b], stages[b], {}, linear[b]);
    linear[b].body.elasticity = body::linearised(linear[b].body.elasticity);
    linear[b].of_fields = coordinates_of_fields(stages[b], linear[b]);
  }
  const std::vector<Eigen::MatrixXd> interaction = linear_run(linear);
  for (std::size_t b = 0; b < stages.size(); ++b)
    if (chooses(b))
      rank_pairs(plan.bodies[b], stages[b], interaction[b], plan.bodies[b].spec.reduction.derivatives.count,
                 weights[b]);
  return weights;
}

/// Not factored before they solve. Collective.
std::shared_ptr<const reduction::Statics> statics_of(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  return std::make_shared<const reduction::Statics>(
      body.structure, body.frame, fem::holding(body.structure, body.frame, constrained_by_modes(plan, index)));
}

/// Formulation vm without a number of its own: as many modes as modes and derivatives together keep columns.
///
/// Derivatives that vanish or repeat others take no column, and so no mode stands in for them. The factors of the
/// first modes serve all that is solved here.
void modes_for_derivatives(const Plan& plan, int index, Stage& stage, BodyReport& report) {
  const PlannedBody& body = plan.bodies[index];
  const ReductionSpec& spec = body.spec.reduction;
  const auto attached = stage.generators.fields.size() - stage.generators.modes.omega.size();
  const reduction::Basis both =
      reduction::basis_of(body.structure, stage.generators,
                          derivatives_of(body, stage, stage.pairs, spec.derivatives.full), spec.drop_tolerance);
  const auto modes = std::min<PetscInt>(both.columns - static_cast<PetscInt>(attached), stage.solver->available());
  if (modes > std::ssize(stage.generators.modes.omega)) generate(plan, index, static_cast<int>(modes), stage, report);
}

}  // namespace

namespace {

/// Of a mass whose centre and inertia are given in the axes of the mesh, in those of the body's frame.
body::Inertia inertia_of(const RigidMass& mass, const Eigen::Isometry3d& frame, int dimension) {
  const auto& J = mass.inertia;
  Eigen::Matrix3d tensor;
  tensor << J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2];
  Eigen::Matrix3d second = 0.5 * tensor.trace() * Eigen::Matrix3d::Identity() - tensor;  // int rho x x'
  if (dimension == 2) second = 0.5 * J[2] * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d A = frame.linear().transpose();
  const Eigen::Vector3d centre = frame.inverse() * Eigen::Vector3d::Map(mass.centre.data());
  body::Inertia inertia(dimension, 0);
  inertia.m = mass.mass;
  inertia.s0 = mass.mass * centre.head(dimension);
  inertia.C0 =
      (A * second * A.transpose() + mass.mass * centre * centre.transpose()).topLeftCorner(dimension, dimension);
  return inertia;
}

}  // namespace

ReducedBody rigid(const PlannedBody& body) {
  ReducedBody reduced;
  reduced.basis = std::make_shared<reduction::Basis>();
  reduced.body = reduction::rigid_body(body.structure);
  if (body.spec.mass)
    reduced.body.inertia =
        inertia_of(*body.spec.mass, frame_in_mesh(body), static_cast<int>(reduced.body.inertia.dimension()));
  reduced.report.rigid = true;
  return reduced;
}

BodyFields fields_of_body(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  const DerivativesSpec& spec = body.spec.reduction.derivatives;
  BodyFields fields;
  Stage stage;
  begin_stage(plan, index, count_of_modes(body), stage, fields.report);
  const int count = static_cast<int>(stage.generators.fields.size());
  const bool all = spec.choice == DerivativesSpec::Choice::count;
  reduction::DerivativeColumns derivatives =
      derivatives_of(body, stage, all ? reduction::all_pairs(count) : pairs_of(spec, stage.generators), spec.full);
  fields.columns = std::move(stage.generators.fields);
  fields.origins = std::move(stage.generators.origins);
  for (auto& column : derivatives.columns) fields.columns.push_back(std::move(column));
  fields.origins.insert(fields.origins.end(), derivatives.origins.begin(), derivatives.origins.end());
  return fields;
}

std::vector<BodyReport> modes_of_bodies(const Plan& plan) {
  std::vector<BodyReport> reports;
  const std::vector<SharedReduction> shared = shared_reductions(plan);
  for (std::size_t b = 0; b < plan.bodies.size(); ++b) {
    const PlannedBody& body = plan.bodies[b];
    BodyReport report;
    report.name = body.spec.name;
    report.rigid = body.spec.rigid;
    report.notices = body.notices;
    report.nodes = body.structure.mesh.node_count, report.elements = fem::element_count(body.structure.mesh);
    report.dofs = body.structure.dofs();
    if (body.spec.reduced) {
      reports.push_back(from_file(body, Formulation::vm_md).report);
      continue;
    }
    if (shared[b].of >= 0) {
      ReducedBody original;
      original.report = reports[shared[b].of];
      report = shared_body(plan, static_cast<int>(b), shared[b], original).report;
      report.name = body.spec.name;
      report.notices = body.notices;
    }
    Stage stage;
    if (!report.rigid && shared[b].of < 0) begin_stage(plan, static_cast<int>(b), count_of_modes(body), stage, report);
    reports.push_back(std::move(report));
  }
  return reports;
}

std::vector<ReducedBody> reduce_bodies(const Plan& plan, Formulation formulation, const InteractionRun& linear_run,
                                       std::vector<std::string>& warnings, bool keep_statics) {
  const int count = static_cast<int>(plan.bodies.size());
  const bool alone = formulation == Formulation::vm;
  std::vector<Stage> stages(count);
  std::vector<ReducedBody> all(count);
  std::vector<std::vector<std::string>> labels(count);
  const std::vector<SharedReduction> shared = shared_reductions(plan);
  for (int b = 0; b < count; ++b) {
    const PlannedBody& body = plan.bodies[b];
    const ReductionSpec& spec = body.spec.reduction;
    if (body.spec.rigid) {
      all[b] = rigid(body);
      continue;
    }
    if (body.spec.reduced) {
      all[b] = from_file(body, formulation);
      if (std::string line = held_otherwise(plan, b); !line.empty()) warnings.push_back(std::move(line));
      if (std::string line = damping_without_joints(plan, b, all[b]); !line.empty())
        warnings.push_back(std::move(line));
      continue;
    }
    if (shared[b].of >= 0) {
      warn(plan, b, formulation, warnings);
      continue;
    }
    const bool stated = alone && spec.modes.alone > 0;
    begin_stage(plan, b, stated ? spec.modes.alone : count_of_modes(body), stages[b], all[b].report);
    if (!spec.columns.empty() && !stated)
      labels[b] = keep_named(body, stages[b]);
    else if (!stated)
      stages[b].pairs = pairs_of(spec.derivatives, stages[b].generators);
    warn(plan, b, formulation, warnings);
    if (const std::vector<double>& intra_deflection = all[b].report.intra_deflection;
        !intra_deflection.empty() && intra_deflection[0] > max_intra_deflection_of_modes)
      warnings.push_back(
          intra_deflection_text(body.spec.name, "mode 1", intra_deflection[0], max_intra_deflection_of_modes));
    if (all[b].report.left_out > 0) warnings.push_back(left_out_text(body.spec.name, all[b].report));
  }
  refuse_unknown(plan, labels);
  const std::vector<std::vector<double>> weights = choose_by_count(plan, formulation, linear_run, stages, all, shared);
  for (int b = 0; b < count; ++b) {
    const PlannedBody& body = plan.bodies[b];
    if (body.spec.rigid || body.spec.reduced || shared[b].of >= 0) continue;
    reduction::DerivativeColumns derivatives;
    if (alone) {
      if (body.spec.reduction.modes.alone == 0 && body.spec.reduction.columns.empty())
        modes_for_derivatives(plan, b, stages[b], all[b].report);
    } else {
      const double start = MPI_Wtime();
      derivatives = derivatives_of(body, stages[b], stages[b].pairs, body.spec.reduction.derivatives.full);
      for (std::size_t i = 0; i < std::min(weights[b].size(), derivatives.origins.size()); ++i)
        derivatives.origins[i].interaction = weights[b][i];
      all[b].report.seconds_derivatives = MPI_Wtime() - start;
    }
    end_stage(body, stages[b], std::move(derivatives), all[b]);
    warn_of_loads(plan, b, {}, stages[b], all[b], warnings);
    for (int copy = b + 1; copy < count; ++copy)
      if (shared[copy].of == b) warn_of_loads(plan, copy, shared[copy].placement, stages[b], all[b], warnings);
    stages[b].solver.reset();  // before the statics whose factor it uses
    if (keep_statics) all[b].statics = std::move(stages[b].statics);
    stages[b] = Stage();
    for (int copy = b + 1; copy < count; ++copy) {
      if (shared[copy].of != b) continue;
      all[copy] = shared_body(plan, copy, shared[copy], all[b]);
      if (keep_statics && !all[copy].statics) all[copy].statics = statics_of(plan, copy);
    }
  }
  warn_of_products(plan, shared, all, warnings);
  return all;
}

}  // namespace floe::assembly
