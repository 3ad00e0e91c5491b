#pragma once
#include "nas_cards.h"

namespace floe::mesh {

/// Cards that repeat the one before: `=` or `==` for the same field or the same rest, `*x` for a field greater by x;
/// then
/// `=n` for n more cards with the same steps. Rank-local.
class NasReplicate {
 public:
  explicit NasReplicate(Faults& faults) : faults_(faults) {}

  /// The card before, whose fields point into its file or into `texts`; both are taken over.
  void keep(NasCard& card, std::deque<std::string>& texts);

  /// The file ends, or another begins.
  void forget() { previous_.name.clear(); }

  /// Calls visit for each card that `step` makes, whose name is =, =n or =(n).
  void apply(const NasCard& step, const std::function<void(const NasCard&)>& visit);

 private:
  bool advance(Where where);

  Faults& faults_;
  NasCard previous_;
  std::deque<std::string> texts_, made_;  // what the fields of the previous card point to
  std::vector<std::string> steps_;        // of the fields; none: no `=` since the card
  long long count_ = 0;
};

}  // namespace floe::mesh
