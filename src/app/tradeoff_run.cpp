#include "tradeoff_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "choose.h"
#include "exact_motion.h"
#include "interruption.h"
#include "tradeoff_table.h"

namespace floe::app {

using nlohmann::ordered_json;
using scene::Formulation;
using scene::Scene;

namespace {

constexpr double short_motion = 0.05, short_offline = 0.5;  // [s]: timed three times

/// `the simulation stopped at t = 1.2 of 3, after ...`: diverged at t = 1.2 s.
std::string short_reason(const std::string& text) {
  const std::string begin = "the simulation stopped at t = ";
  const auto at = text.find(begin);
  if (at == std::string::npos) return "failed: " + text.substr(0, std::min(text.find('\n'), std::size_t{160}));
  const auto from = at + begin.size();
  return "diverged at t = " + text.substr(from, text.find(" of ", from) - from) + " s";
}

double element_count(const Scene& scene) {
  double count = 0;
  for (const scene::Body& body : scene.bodies) {
    if (body.rigid) continue;
    for (const int elements : body.mesh.elements) count += elements;
    if (body.mesh.plate) count += body.mesh.plate->elements[0] * body.mesh.plate->elements[1];
  }
  return std::max(1.0, count);
}

bool has_plates(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const scene::Body& body) { return body.mesh.plate.has_value(); });
}

/// As flexible as in `scene`, where a selection made bodies rigid.
Scene as_flexible(Scene chosen, const Scene& scene) {
  for (scene::Body& body : chosen.bodies)
    for (const scene::Body& other : scene.bodies)
      if (other.name == body.name) body.rigid = other.rigid;
  return chosen;
}

void broadcast(std::string& text, int owner, MPI_Comm comm) {
  int length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, owner, comm);
  text.resize(length);
  MPI_Bcast(text.data(), length, MPI_CHAR, owner, comm);
}

/// Its times and values; all ranks know the columns.
void broadcast(Series& series, int owner, MPI_Comm comm) {
  long counts[2] = {static_cast<long>(series.t.size()), static_cast<long>(series.columns.size())};
  MPI_Bcast(counts, 2, MPI_LONG, owner, comm);
  series.t.resize(counts[0]);
  series.values.resize(counts[0]);
  MPI_Bcast(series.t.data(), static_cast<int>(counts[0]), MPI_DOUBLE, owner, comm);
  for (std::vector<double>& values : series.values) {
    values.resize(counts[1]);
    MPI_Bcast(values.data(), static_cast<int>(counts[1]), MPI_DOUBLE, owner, comm);
  }
}

}  // namespace

std::string full_order_key(const Scene& scene) {
  std::string key = fmt::format("{:.9g} {:.9g} {:.9g}", scene.motion.step, scene.motion.spectral_radius,
                                scene.motion.tolerance.value_or(0));
  for (const scene::Body& body : scene.bodies) {
    key += fmt::format("; {} {}", body.name, body.frames);
    if (body.strains) key += *body.strains == fem::Strains::second_order ? " second_order" : " von_karman";
    for (const int elements : body.mesh.elements) key += fmt::format(" {}", elements);
    if (body.mesh.plate) key += fmt::format(" {}x{}", body.mesh.plate->elements[0], body.mesh.plate->elements[1]);
  }
  return key;
}

TradeoffRun::TradeoffRun(const Scene& scene, const TradeoffRequest& request, const TradeoffReference& reference,
                         const RunResult& own, const std::string& no_cfr, MPI_Comm comm)
    : scene_(scene),
      request_(request),
      reference_(reference),
      own_(own),
      no_cfr_(no_cfr),
      comm_(comm),
      probes_(probes(own.series.columns)) {
  full_[full_order_key(scene)] = own.series;
}

ModelVariant TradeoffRun::measured(const RunResult& result) const {
  ModelVariant variant;
  variant.coordinates = result.coordinates, variant.steps = result.steps;
  variant.offline = result.offline_seconds, variant.motion = result.motion_processor;
  variant.total = vector_errors(result.series, reference_.series);
  variant.peak = peak_errors(result.series, reference_.series);
  variant.energy = relative_energy_error(result.series, reference_.series).value_or(0);
  const double end = reference_.series.t.back();
  if (!std::isfinite(variant.energy) ||
      std::any_of(variant.total.begin(), variant.total.end(), [](double e) { return !(e < 1e3); }))
    variant.stopped = "errors above 1e5 %";
  else if (std::abs(result.end - end) > 1e-2 * end)
    variant.stopped = fmt::format("ends at t = {:.4g} s instead of {:.4g} s", result.end, end);
  return variant;
}

/// About, by that of the scene's own mesh and step [s].
double TradeoffRun::full_order_seconds(const Scene& scene) const {
  const double elements = element_count(scene) / element_count(scene_);
  return own_.motion_processor * std::pow(elements, has_plates(scene) ? 1.3 : 1) * scene_.motion.step /
         scene.motion.step;
}

/// The part of the error that is due to the reduction, where the full-order model is known or cheap.
void TradeoffRun::compare_with_full_order(const Scene& scene, const Series& series, MPI_Comm comm,
                                          ModelVariant& variant) const {
  const auto known = full_.find(full_order_key(scene));
  if (known != full_.end()) {
    variant.reduction = vector_errors(series, known->second);
    return;
  }
  if (scene.motion.tolerance || full_order_seconds(scene) > request_.most_seconds) return;
  try {
    variant.reduction = vector_errors(series, quiet_motion(as_flexible(scene, scene_), Formulation::nlffr, 0, comm));
  } catch (const std::runtime_error&) {  // the full-order model fails: there is no such part
    if (Interruption::happened(comm)) throw;
  }
}

/// Of a summary: the estimated total of all probes, and what it lacks.
void TradeoffRun::take_estimate(const ordered_json& estimate, ModelVariant& variant) const {
  if (!estimate.is_object() || !estimate.contains("total") || !estimate["total"].contains("probes")) return;
  const ordered_json& total = estimate["total"];
  std::vector<double> all;
  for (const std::string& probe : probes_) {
    if (!total["probes"].contains(probe)) return;
    const ordered_json& error = total["probes"][probe];
    all.push_back(error.is_number() ? error.get<double>() : INFINITY);
  }
  std::vector<std::string> lacks;
  const ordered_json missing = total.value("missing", ordered_json::object());
  for (const auto& [probe, parts] : missing.items())
    for (const auto& part : parts)
      if (std::find(lacks.begin(), lacks.end(), part) == lacks.end()) lacks.push_back(part);
  variant.estimate = all, variant.lacks = fmt::format("{}", fmt::join(lacks, ", "));
}

TradeoffRun::Climbed TradeoffRun::simulated(const Candidate& member, MPI_Comm comm) const {
  const bool reduced = scene::is_reduced(member.formulation);
  RunPlan plan;
  plan.check_range = false;
  plan.estimate = reduced && member.family != "rigid";  // else rigid bodies are no approximation
  const RunResult result = run(member.scene, member.formulation, comm, std::nullopt, plan);
  Climbed climbed{measured(result), result.series};
  ModelVariant& variant = climbed.variant;
  if (!reduced) return climbed;
  take_estimate(result.summary.value("estimate", ordered_json()), variant);
  compare_with_full_order(member.scene, result.series, comm, variant);
  plan.estimate = false;
  for (int again = 0; again < 2 && variant.motion < short_motion && variant.offline < short_offline; ++again)
    variant.motion =
        std::min(variant.motion, run(member.scene, member.formulation, comm, std::nullopt, plan).motion_processor);
  return climbed;
}

TradeoffRun::Climbed TradeoffRun::selected(const Candidate& member, MPI_Comm comm) const {
  RunPlan plan;
  plan.check_range = false;
  Chosen chosen = choose(member.scene, {member.accuracy, true}, comm);
  const RunResult result = move(chosen.scene, chosen.model, chosen.seconds, comm, std::nullopt, plan);
  Climbed climbed{measured(result), result.series};
  ModelVariant& variant = climbed.variant;
  variant.required = member.accuracy, variant.selected = summary_of(chosen);
  variant.estimate.assign(probes_.size(), chosen.supported);
  std::vector<std::string> lacks;
  for (const auto& [part, why] : chosen.unbounded) lacks.push_back(part);
  variant.lacks = fmt::format("{}", fmt::join(lacks, ", "));
  compare_with_full_order(chosen.scene, result.series, comm, variant);
  for (int again = 0; again < 2 && variant.motion < short_motion; ++again) {
    assembly::Model model = another_model(chosen, comm);
    variant.motion = std::min(variant.motion, move(chosen.scene, model, 0, comm, std::nullopt, plan).motion_processor);
  }
  return climbed;
}

TradeoffRun::Climbed TradeoffRun::evaluate(const Candidate& member, MPI_Comm comm) const {
  Climbed climbed;
  const bool full_order = member.formulation == Formulation::nlffr || member.formulation == Formulation::lffr;
  const double seconds = full_order_seconds(member.scene);
  if (!member.impossible.empty()) {
    climbed.variant.stopped = short_reason(member.impossible);
  } else if (member.formulation == Formulation::cfr && !no_cfr_.empty()) {
    climbed.variant.stopped = "not simulated: " + no_cfr_;
  } else if (full_order && seconds > std::max(1.01 * own_.motion_processor, request_.most_seconds)) {
    climbed.variant.stopped =
        fmt::format("not simulated: would take about {:.2g} s (limit {:.2g} s)", seconds, request_.most_seconds);
  } else {
    try {
      climbed = member.accuracy > 0 ? selected(member, comm) : simulated(member, comm);
    } catch (const InputError& error) {
      climbed.variant.stopped = short_reason(error.what());
    } catch (const RunError& error) {
      if (Interruption::happened(comm)) throw;
      climbed.variant.stopped = short_reason(error.what());
    }
  }
  ModelVariant& variant = climbed.variant;
  variant.family = member.family, variant.name = member.name, variant.formulation = scene::name_of(member.formulation);
  variant.required = member.accuracy;
  return climbed;
}

std::vector<TradeoffRun::Climbed> TradeoffRun::climb_some(const std::vector<const Candidate*>& members) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm_, &rank);
  MPI_Comm_size(comm_, &size);
  std::vector<Climbed> all(members.size());
  petsc::agree(comm_, [&] {
    for (std::size_t i = rank; i < members.size(); i += size)
      all[i] = evaluate(*members[i], size > 1 ? PETSC_COMM_SELF : comm_);
  });
  for (std::size_t i = 0; size > 1 && i < members.size(); ++i) {
    const int owner = static_cast<int>(i) % size;
    std::string text = rank == owner ? to_json(all[i].variant).dump() : "";
    broadcast(text, owner, comm_);
    all[i].variant = variant_of(ordered_json::parse(text));
    if (members[i]->formulation == Formulation::nlffr) broadcast(all[i].series, owner, comm_);
  }
  return all;
}

std::vector<ModelVariant> TradeoffRun::evaluate_all(const std::vector<Candidate>& members) {
  std::vector<ModelVariant> variants(members.size());
  for (const bool full_order : {true, false}) {
    std::vector<const Candidate*> some;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < members.size(); ++i)
      if (scene::is_reduced(members[i].formulation) != full_order) some.push_back(&members[i]), places.push_back(i);
    std::vector<Climbed> climbed = climb_some(some);
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (some[i]->formulation == Formulation::nlffr && climbed[i].variant.stopped.empty())
        full_[full_order_key(some[i]->scene)] = std::move(climbed[i].series);
      variants[places[i]] = climbed[i].variant;
    }
  }
  return variants;
}

}  // namespace floe::app
