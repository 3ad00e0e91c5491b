#include "choose_reasons.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "floe/math/rounded.h"

namespace floe::app {
namespace {

using Selection = assess::Selection;

std::string names(const Selection& selection, const assess::CandidateBasis& candidates) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < selection.taken.size(); ++i)
    if (selection.taken[i]) all.push_back(candidates.columns()[i].label);
  const std::size_t shown = 6;
  if (all.size() <= shown) return fmt::format("{}", fmt::join(all, "; "));
  return fmt::format("{}; {} more", fmt::join(all.begin(), all.begin() + shown, "; "), all.size() - shown);
}

/// How many vectors, on each body, and what the last one is for.
void add_vectors(const Choice& choice, const assess::CandidateBasis& candidates, Trials& trials,
                 std::vector<Decision>& all) {
  const auto& columns = candidates.columns();
  Selection less = trials.first_of(choice.order, choice.count - 1);
  less.linear = choice.selection.linear;
  all.push_back({"basis vectors", fmt::format("{} of {}", choice.count, columns.size()),
                 fmt::format("without the last one, {}: {}", columns[choice.order[choice.count - 1].column].label,
                             words(trials.tried(less, choice.step)))});
  std::vector<std::string> bodies;
  for (const auto& column : columns)
    if (std::find(bodies.begin(), bodies.end(), column.body) == bodies.end()) bodies.push_back(column.body);
  for (const std::string& body : bodies) {
    Selection of_body = choice.selection;
    for (std::size_t i = 0; i < of_body.taken.size(); ++i)
      if (columns[i].body != body) of_body.taken[i] = 0;
    all.push_back({"  " + body, of_body.count() > 0 ? fmt::format("{} basis vectors", of_body.count()) : "rigid",
                   names(of_body, candidates)});
  }
}

}  // namespace

std::string words(const Trial& trial) { return trial.failed.empty() ? math::percent(trial.error) : trial.failed; }

std::vector<Decision> reasons(const Choice& choice, assess::CandidateBasis& candidates, Trials& trials) {
  std::vector<Decision> all;
  if (!candidates.columns().empty()) {
    const std::string rigid = words(trials.tried(trials.first_of(choice.order, 0), choice.step));
    if (choice.count == 0) {
      const std::vector<std::string> deformed = candidates.deformed();
      all.push_back(
          {"bodies",
           deformed.empty() ? "rigid" : fmt::format("rigid, but {}, deformed at the start", fmt::join(deformed, ", ")),
           "error " + rigid});
    } else {
      all.push_back({"bodies", "flexible", "rigid: " + rigid});
      add_vectors(choice, candidates, trials, all);
      const bool linear = choice.selection.linear;
      all.push_back({"elastic force", linear ? "linear" : "von Karman",
                     "linear: " + (linear ? words(trials.tried(choice.selection, choice.step)) : choice.linear)});
    }
  }
  all.push_back({"step", fmt::format("{:.4g} s", choice.step),
                 choice.longer_step ? fmt::format("{:.4g} s: {}", 2 * choice.step,
                                                  words(trials.tried(choice.selection, 2 * choice.step)))
                                    : "a simulation has at least 32 steps"});
  return all;
}

}  // namespace floe::app
