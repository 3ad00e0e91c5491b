#include "tradeoff.h"

#include <fmt/format.h>

#include "drawing.h"
#include "floe/math/rounded.h"
#include "floe/output/provenance.h"
#include "refined.h"
#include "tradeoff_run.h"
#include "tradeoff_table.h"

namespace floe::app {

using nlohmann::ordered_json;
using scene::Formulation;

namespace {

/// What the errors mean, as sentences.
std::string words(const TradeoffRequest& request, const TradeoffReference& reference, int ranks) {
  std::string text = fmt::format(
      "Errors: of each probe as a vector, ratio of root mean squares; the maximum over the probes. Total: relative to "
      "{}, whose own error is about {}{}.",
      reference.words, math::percent(reference.error),
      reference.error_lacks.empty() ? "" : " (without " + reference.error_lacks + ")");
  if (!reference.why.empty()) text += fmt::format(" The reference is not cfr: {}.", reference.why);
  text +=
      " Reduction: relative to the full-order model (nlffr) of the same mesh, frames, strains and step. Estimate: the "
      "estimated total, computed without the reference (*: without a part that cannot be estimated). Front: number on "
      "the Pareto front, the fastest model first.";
  text += fmt::format(
      " Simulation: processor time; full-order models that take more than {:.3g} s are not simulated. Every model has "
      "its own offline stage, nothing is shared{}.",
      request.most_seconds, ranks > 1 ? fmt::format("; {} models ran concurrently, one rank each", ranks) : "");
  return text;
}

/// Why members of formulation cfr are not simulated; empty: they are.
std::string why_not_cfr(const TradeoffReference& reference) {
  if (reference.formulation == Formulation::cfr) return "";
  return reference.why.empty() ? "--reference nlffr" : reference.why;
}

std::string fastest_words(const std::vector<ModelVariant>& variants, std::optional<std::size_t> chosen,
                          double accuracy) {
  if (!chosen) return fmt::format("No model has an error of at most {}", math::percent(accuracy));
  return fmt::format("Fastest model with an error of at most {}: {} ({}), {}", math::percent(accuracy),
                     variants[*chosen].name, variants[*chosen].formulation, math::percent(variants[*chosen].worst()));
}

}  // namespace

void tradeoff(const scene::Scene& as_written, MPI_Comm comm, const TradeoffRequest& request, const std::string& path,
              bool overwrite) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  const scene::Scene scene = at_equal_times(as_written);
  const output::ResultFolder folder = output::prepare_folder(comm, path, overwrite);
  std::vector<ModelVariant> variants;
  TradeoffReference reference;
  std::vector<std::string> names;
  try {
    RunPlan plan;
    plan.check_range = false;
    const RunResult own = run(scene, Formulation::nlffr, comm, std::nullopt, plan);
    if (own.series.columns.empty())
      throw InputError(scene.file + ": probes: there are none; expected the quantities that a trade-off compares");
    names = probes(own.series.columns);
    reference = tradeoff_reference(scene, request, own.series, comm);
    variants = TradeoffRun(scene, request, reference, own, why_not_cfr(reference), comm).evaluate_all(hierarchy(scene));
  } catch (const std::exception&) {
    output::discard_if_empty(folder);
    throw;
  }
  const std::optional<std::size_t> chosen = choice(variants, request.accuracy);
  ordered_json j;
  j["title"] = scene.title.empty() ? scene.file : scene.title;
  j["probes"] = names;
  j["accuracy"] = request.accuracy;
  j["reference"] = to_json(reference);
  for (const ModelVariant& variant : variants) j["variants"].push_back(to_json(variant));
  j["pareto_front"] = pareto_front(variants);
  if (chosen) j["choice"] = *chosen;
  j["ranks"] = size;
  j["provenance"] = output::provenance(comm);
  output::remove_replaced(comm, folder);
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    const output::Table table = tradeoff_table(names, variants, false), choices = selections_table(variants);
    const std::string text = words(request, reference, size);
    const std::string fastest = fastest_words(variants, chosen, request.accuracy);
    std::string page = output::to_markdown(table) + "\n" + text + "\n\n" + fastest + ".\n";
    if (!choices.rows.empty()) page += "\nModels selected by `accuracy:`\n\n" + output::to_markdown(choices);
    output::write_file_atomically(folder.path / "tradeoff.json", j.dump(2));
    output::write_file_atomically(folder.path / "tradeoff.csv", output::to_csv(tradeoff_table(names, variants, true)));
    output::write_file_atomically(folder.path / "tradeoff.md", page);
    fmt::print("{}\n{}\n\n", output::to_text(table), text);
    if (!choices.rows.empty()) fmt::print("Models selected by accuracy:\n{}\n", output::to_text(choices));
    fmt::print("{}\nPicture: {}\n", fastest, draw("tradeoff", folder.path.string()));
  });
}

}  // namespace floe::app
