#include "nas_replicate.h"

#include <fmt/format.h>

#include <cmath>

#include "text.h"

namespace floe::mesh {
namespace {

constexpr std::size_t fields_of_card = 8;
constexpr long long most_cards = 200000;  // that are made by replication

std::string_view without_brackets(std::string_view text) {
  if (text.starts_with('(') && text.ends_with(')') && text.size() > 1) return text.substr(1, text.size() - 2);
  return text;
}

/// A field greater by a step, an integer where both are; nothing where one is no number.
std::optional<std::string> sum(std::string_view field, std::string_view step) {
  constexpr long long most = 1LL << 60;
  const auto n = number<long long>(field), by = number<long long>(step);
  if (n && by && std::abs(*n) < most && std::abs(*by) < most) return std::to_string(*n + *by);
  const auto x = field.empty() ? std::optional<double>(0) : fortran_number(field, true),
             dx = fortran_number(step, true);
  if (!x || !dx) return std::nullopt;
  std::string text = fmt::format("{:.17g}", *x + *dx);
  if (text.find_first_of(".en") == std::string::npos) text += '.';
  return text;
}

}  // namespace

void NasReplicate::keep(NasCard& card, std::deque<std::string>& texts) {
  std::swap(previous_, card);
  texts_.swap(texts);
  made_.clear();
  steps_.clear();
}

bool NasReplicate::advance(Where where) {
  std::deque<std::string> made;
  std::vector<std::string_view> fields(fields_of_card);
  bool same = false;  // ==: all that follow
  for (std::size_t i = 0; i < fields_of_card; ++i) {
    const std::string_view step = same || i >= steps_.size() ? "=" : std::string_view(steps_[i]),
                           before = previous_.text(i);
    same = same || step == "==";
    if (same || step == "=") {
      made.emplace_back(before);
    } else if (step.starts_with('*')) {
      const auto next = sum(before, without_brackets(step.substr(1)));
      if (!next) {
        faults_.add(where, fmt::format("{}: expected a number to which {} adds, found {}", previous_.name,
                                       in_quotes(step), in_quotes(before)));
        return false;
      }
      made.push_back(*next);
    } else {
      made.emplace_back(step);
    }
    fields[i] = made.back();
  }
  made_.swap(made);  // the strings stay where they are
  previous_.fields = fields;
  previous_.lines = {where};
  return true;
}

void NasReplicate::apply(const NasCard& step, const std::function<void(const NasCard&)>& visit) {
  const Where where = step.where();
  if (previous_.name.empty())
    return faults_.add(where, "card " + in_quotes(step.name) + " replicates a card, but there is none before it");
  if (!previous_.blank_from(fields_of_card) || step.fields.size() > fields_of_card)
    return faults_.add(where, previous_.name + ": replication of cards with continuations is not read");
  long long times = 1;
  if (step.name == "=") {
    steps_.assign(step.fields.begin(), step.fields.end());
  } else {
    const auto n = number<long long>(without_brackets(std::string_view(step.name).substr(1)));
    if (!n || *n < 1)
      return faults_.add(where, "expects = or =n (cards that replicate the one before), found " + in_quotes(step.name));
    if (steps_.empty())
      return faults_.add(where, step.name + " repeats steps of a card with =, but there is none before it");
    times = *n;
  }
  if (times > most_cards - count_)
    return faults_.add(where, fmt::format("replication makes more than {} cards", most_cards));
  count_ += times;
  for (; times > 0 && advance(where); --times) visit(previous_);
}

}  // namespace floe::mesh
