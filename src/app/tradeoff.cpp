#include "tradeoff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "choose.h"
#include "drawing.h"
#include "floe/math/rounded.h"
#include "floe/output/progress.h"
#include "floe/output/provenance.h"
#include "interruption.h"
#include "refined.h"
#include "tradeoff_table.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

/// `the simulation stopped at t = 1.2 of 3, after ...`: diverged at t = 1.2 s.
std::string short_reason(const std::string& text) {
  const std::string begin = "the simulation stopped at t = ";
  const auto at = text.find(begin);
  if (at == std::string::npos) return "failed: " + text.substr(0, std::min(text.find('\n'), std::size_t{160}));
  const auto from = at + begin.size();
  return "diverged at t = " + text.substr(from, text.find(" of ", from) - from) + " s";
}

/// What members are measured against: the reference with the scene's step, and with a finer one.
struct References {
  Series own, exact;
};

Rung measured(const RunResult& result, const References& references) {
  Rung rung;
  rung.coordinates = result.coordinates, rung.steps = result.steps;
  rung.offline = result.offline_seconds, rung.motion = result.motion_seconds;
  rung.rms = vector_errors(result.series, references.exact);
  rung.reduction = vector_errors(result.series, references.own);
  rung.peak = peak_errors(result.series, references.exact);
  rung.energy = relative_energy_error(result.series, references.exact).value_or(0);
  if (result.estimate.none.empty()) rung.estimate = result.estimate.probes;
  const double end = references.exact.t.back();
  if (!std::isfinite(rung.energy) || std::any_of(rung.rms.begin(), rung.rms.end(), [](double e) { return !(e < 1e3); }))
    rung.stopped = "errors above 1e5 %";
  else if (std::abs(result.end - end) > 1e-2 * end)
    rung.stopped = fmt::format("ends at t = {:.4g} s instead of {:.4g} s", result.end, end);
  return rung;
}

/// @param comm  of those who run it together
RunResult result_of(const Candidate& member, MPI_Comm comm) {
  RunPlan plan;
  if (member.accuracy > 0) {
    Chosen chosen = choose(member.scene, {member.accuracy, false}, comm);
    RunResult result = move(chosen.scene, chosen.model, chosen.seconds, comm, std::nullopt, plan);
    result.estimate.none = "", result.estimate.probes.assign(probes(result.series.columns).size(), chosen.supported);
    return result;
  }
  plan.estimate = scene::is_reduced(member.formulation), plan.budget = false;
  return run(member.scene, member.formulation, comm, std::nullopt, plan);
}

Rung climb(const Candidate& member, const References& references, MPI_Comm comm) {
  Rung rung;
  try {
    rung = measured(result_of(member, comm), references);
  } catch (const InputError& error) {
    rung.stopped = short_reason(error.what());
  } catch (const RunError& error) {
    if (Interruption::happened(comm)) throw;
    rung.stopped = short_reason(error.what());
  }
  rung.family = member.family, rung.name = member.name, rung.formulation = scene::name_of(member.formulation);
  return rung;
}

/// Every rank takes each so many of the members; all ranks get all rungs. Collective.
std::vector<Rung> climb_all(const std::vector<Candidate>& members, const References& references, MPI_Comm comm) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  std::vector<Rung> rungs(members.size());
  petsc::agree(comm, [&] {
    for (std::size_t i = rank; i < members.size(); i += size)
      rungs[i] = climb(members[i], references, size > 1 ? PETSC_COMM_SELF : comm);
  });
  for (std::size_t i = 0; size > 1 && i < members.size(); ++i) {
    const int owner = static_cast<int>(i) % size;
    std::string text = rank == owner ? to_json(rungs[i]).dump() : "";
    int length = static_cast<int>(text.size());
    MPI_Bcast(&length, 1, MPI_INT, owner, comm);
    text.resize(length);
    MPI_Bcast(text.data(), length, MPI_CHAR, owner, comm);
    rungs[i] = rung_of(ordered_json::parse(text));
  }
  return rungs;
}

std::string words(const TradeoffRequest& request, int ranks) {
  return fmt::format(
      "Errors: of each probe as a vector relative to {} with a quarter of the step, ratio of root mean squares (peak: "
      "ratio of maxima); first row: error of the scene's time step, second row: error of its mesh. Estimate: error of "
      "the reduction, computed without the reference (selected models: including the error of the time step). "
      "Speed-up: of the simulation. Every model has its own offline stage, nothing is "
      "shared{}.",
      scene::name_of(request.reference),
      ranks > 1 ? fmt::format("; {} models ran concurrently, one rank each", ranks) : "");
}

/// The scene in steps of a quarter, stored as often.
scene::Scene in_quarter_steps(scene::Scene scene) {
  scene.motion.step /= 4;
  if (!scene.motion.output) scene.motion.every *= 4;
  if (scene.motion.tolerance) *scene.motion.tolerance /= 16;
  return scene;
}

scene::Scene on_finer_mesh(const scene::Scene& scene) {
  scene::Scene fine = refined(scene);
  fine.motion = in_quarter_steps(scene).motion;
  return fine;
}

}  // namespace

void tradeoff(const scene::Scene& as_written, MPI_Comm comm, const TradeoffRequest& request, const std::string& path,
              bool overwrite) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  const scene::Scene scene = at_equal_times(as_written);
  const output::ResultFolder folder = output::prepare_folder(comm, path, overwrite);
  std::vector<Rung> rungs;
  Rung reference, own;
  bool has_own = false;
  std::vector<std::string> names;
  try {
    const std::string name = scene::name_of(request.reference);
    References references;
    const RunResult result = run(scene, request.reference, comm, std::nullopt);
    if (result.series.columns.empty())
      throw InputError(scene.file + ": probes: there are none; expected the quantities that a trade-off compares");
    names = probes(result.series.columns);
    references.own = result.series;
    references.exact = run(in_quarter_steps(scene), request.reference, comm, std::nullopt).series;
    reference = measured(result, references);
    reference.family = "reference", reference.name = name, reference.formulation = name;
    if (const scene::Scene fine = on_finer_mesh(scene); refined_words(scene) != "step halved") {
      own = climb({"reference", name + ", mesh halved", fine, request.reference}, references, comm);
      has_own = own.stopped.empty();
    }
    rungs = climb_all(ladder(scene), references, comm);
  } catch (const std::exception&) {
    output::discard_if_empty(folder);
    throw;
  }
  const std::optional<std::size_t> chosen = choice(rungs, request.accuracy);
  const Rung* finer = has_own ? &own : nullptr;
  ordered_json j;
  j["title"] = scene.title.empty() ? scene.file : scene.title;
  j["probes"] = names;
  j["accuracy"] = request.accuracy;
  j["reference"] = to_json(reference);
  if (finer) j["reference_itself"] = to_json(own);
  for (const Rung& rung : rungs) j["rungs"].push_back(to_json(rung));
  j["pareto_front"] = pareto_front(rungs);
  if (chosen) j["choice"] = *chosen;
  j["ranks"] = size;
  j["provenance"] = output::provenance(comm);
  output::remove_replaced(comm, folder);
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    const output::Table whole = tradeoff_table(names, reference, finer, rungs, chosen, true);
    output::write_file_atomically(folder.path / "tradeoff.json", j.dump(2));
    output::write_file_atomically(folder.path / "tradeoff.csv", output::to_csv(whole));
    output::write_file_atomically(folder.path / "tradeoff.md",
                                  output::to_markdown(tradeoff_table(names, reference, finer, rungs, chosen, false)) +
                                      "\n" + words(request, size) + "\n");
    fmt::print("{}\n{}\n", output::to_text(tradeoff_table(names, reference, finer, rungs, chosen, false)),
               words(request, size));
    if (!chosen)
      fmt::print("No model has an error of at most {}\n", math::percent(request.accuracy));
    else
      fmt::print("Selected for {}: {} ({}), error {}, {:.3g} times faster than {}\n", math::percent(request.accuracy),
                 rungs[*chosen].name, rungs[*chosen].formulation, math::percent(rungs[*chosen].worst()),
                 reference.motion / rungs[*chosen].motion, reference.name);
    fmt::print("Picture: {}\n", draw("tradeoff", folder.path.string()));
  });
}

}  // namespace floe::app
