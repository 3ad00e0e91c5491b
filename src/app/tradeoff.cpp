#include "tradeoff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "drawing.h"
#include "floe/output/progress.h"
#include "floe/output/provenance.h"
#include "interruption.h"
#include "refined.h"
#include "tradeoff_table.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

std::vector<double> bare(const std::vector<std::optional<double>>& values) {
  std::vector<double> all;
  for (const auto& value : values) all.push_back(value.value_or(0));
  return all;
}

/// `the motion stopped at t = 1.2 of 3, after ...`: diverged at t = 1.2 s.
std::string short_reason(const std::string& text) {
  const std::string begin = "the motion stopped at t = ";
  const auto at = text.find(begin);
  if (at == std::string::npos) return "failed: " + text.substr(0, std::min(text.find('\n'), std::size_t{160}));
  const auto from = at + begin.size();
  return "diverged at t = " + text.substr(from, text.find(" of ", from) - from) + " s";
}

Rung measured(const RunResult& result, const Series& reference) {
  Rung rung;
  rung.coordinates = result.coordinates, rung.steps = result.steps;
  rung.offline = result.offline_seconds, rung.motion = result.motion_seconds;
  rung.rms = bare(relative_vector_errors(result.series, reference));
  rung.peak = bare(relative_peak_errors(result.series, reference));
  rung.energy = relative_energy_error(result.series, reference).value_or(0);
  if (result.estimate.none.empty()) rung.estimate = result.estimate.probes;
  if (!std::isfinite(rung.energy) || std::any_of(rung.rms.begin(), rung.rms.end(), [](double e) { return !(e < 1e3); }))
    rung.stopped = "errors beyond 1e5 %";
  return rung;
}

/// @param comm  of those who run it together
Rung climb(const Candidate& member, const Series& reference, MPI_Comm comm) {
  Rung rung;
  try {
    RunPlan plan;
    plan.estimate = scene::is_reduced(member.formulation);
    rung = measured(run(member.scene, member.formulation, comm, std::nullopt, plan), reference);
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
std::vector<Rung> climb_all(const std::vector<Candidate>& members, const Series& reference, MPI_Comm comm) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  std::vector<Rung> rungs(members.size());
  petsc::agree(comm, [&] {
    for (std::size_t i = rank; i < members.size(); i += size)
      rungs[i] = climb(members[i], reference, size > 1 ? PETSC_COMM_SELF : comm);
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

std::string words(const TradeoffRequest& request, const Rung* own, int ranks) {
  std::string text = fmt::format(
      "Errors: of each probe as a vector against {}, root mean square over that of the reference (peak: greatest over "
      "greatest); estimate: without the reference. Speed-up: of the motion. Every model has its own offline stage, "
      "nothing is shared{}.",
      scene::name_of(request.reference),
      ranks > 1 ? fmt::format("; {} models ran at a time, one rank each", ranks) : "");
  if (own) text += " The second row is the error of the reference itself.";
  return text;
}

}  // namespace

void tradeoff(const scene::Scene& scene, MPI_Comm comm, const TradeoffRequest& request, const std::string& path,
              bool overwrite) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  const output::ResultFolder folder = output::prepare_folder(comm, path, overwrite);
  std::vector<Rung> rungs;
  Rung reference, own;
  bool has_own = true;
  std::vector<std::string> names;
  try {
    const Candidate best{"reference", scene::name_of(request.reference), scene, request.reference};
    const RunResult result = run(best.scene, best.formulation, comm, std::nullopt);
    if (result.series.columns.empty())
      throw InputError(scene.file + ": probes: there are none; a trade-off compares what they show");
    names = probes(result.series.columns);
    reference = measured(result, result.series);
    reference.family = best.family, reference.name = best.name, reference.formulation = best.name;
    reference.rms.clear(), reference.peak.clear();
    own = climb({"reference", best.name + ", " + refined_words(scene), refined(scene), request.reference},
                result.series, comm);
    has_own = own.stopped.empty();
    rungs = climb_all(ladder(scene), result.series, comm);
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
                                      "\n" + words(request, finer, size) + "\n");
    fmt::print("{}\n{}\n", output::to_text(tradeoff_table(names, reference, finer, rungs, chosen, false)),
               words(request, finer, size));
    if (chosen)
      fmt::print("{} {:.2g} %: {} ({}), error {:.2g} %, {:.3g} times faster than {}\n",
                 rungs[*chosen].worst() <= request.accuracy ? "Choice for" : "No model is within",
                 100 * request.accuracy, rungs[*chosen].name, rungs[*chosen].formulation, 100 * rungs[*chosen].worst(),
                 reference.motion / rungs[*chosen].motion, reference.name);
    fmt::print("Picture: {}\n", draw("tradeoff", folder.path.string()));
  });
}

}  // namespace floe::app
