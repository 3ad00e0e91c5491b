#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "choose.h"
#include "choose_reasons.h"
#include "compare_table.h"
#include "floe/math/rounded.h"
#include "impulse_error.h"
#include "interruption.h"

namespace floe::app {

namespace {

/// The search for the cheapest model of a candidate basis.
class Search {
 public:
  Search(const scene::Scene& scene, double accuracy, MPI_Comm comm, const Reference& reference)
      : scene_(scene),
        accuracy_(accuracy),
        comm_(comm),
        reference_(reference),
        begin_(std::clock()),
        candidates_(std::make_unique<assess::CandidateBasis>(scene, comm)),
        building_(static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC),
        trials_(scene, *candidates_, accuracy, comm),
        impulses_(scene, accuracy, comm) {}

  Chosen result() {
    enrich();
    if (!candidates_->columns().empty())
      order_ = candidates_->energy_contribution(candidates_->model(candidates_->whole()), states_);
    resolve_time();
    choose_columns_and_step();
    choose_force();
    return finished();
  }

 private:
  using Selection = assess::Selection;

  void decide(std::string what, std::string choice, std::string reason) {
    decisions_.push_back({std::move(what), std::move(choice), std::move(reason)});
  }

  /// The richest model: responses are added until its estimate is a third of the required error, six times at most.
  ///
  /// The change of the motion that they cause measures the estimate made before them: where that was too low because
  /// the basis was far too poor, the next estimates are multiplied by the ratio.
  void enrich() {
    constexpr int most_rounds = 6;
    double first = 0, before = 0, too_low = 1;
    int responses = 0;
    std::size_t columns = 0;
    Series poorer;
    std::string failed;
    for (int round = 0, added = 0;; ++round) {
      RunResult result;
      try {
        result = trials_.moved(candidates_->whole(), scene_.motion.step, !candidates_->columns().empty(), true);
      } catch (const RunError& fault) {  // on all ranks
        if (Interruption::happened(comm_)) throw;
        const std::size_t count = candidates_->columns().size();
        if (round == 0)
          throw RunError(
              fmt::format("{}: accuracy: the richest model, {} basis vectors in steps of {:.4g} s, fails: {}",
                          scene_.file, count, scene_.motion.step, fault.what()));
        failed = fmt::format("; with {} more the simulation fails ({})", added, shortened(fault.what()));
        candidates_->keep(columns);
        responses -= added;
        trials_.forget();
        break;
      }
      states_ = std::move(result.states);
      const double estimate = estimate_of(result);
      if (round == 0) first = estimate;
      if (round > 0 && before > 0) too_low = std::max(1.0, (worst_error(poorer, result.series) + estimate) / before);
      space_ = too_low * estimate;
      before = estimate, poorer = std::move(result.series);
      if (space_ <= accuracy_ / 3 || round == most_rounds || candidates_->columns().empty()) break;
      columns = candidates_->columns().size();
      added = candidates_->add_responses(result.estimate);
      if (added == 0) break;
      responses += added;
      trials_.forget();
    }
    whole_motion_ = std::move(poorer);
    if (candidates_->columns().empty()) return;
    std::size_t offered = candidates_->columns().size();
    decide("richest model", fmt::format("{} basis vectors", offered),
           responses > 0 ? fmt::format("{} correction vectors from residual responses: estimated error {} (before: {})",
                                       responses, math::percent(space_), math::percent(first))
                         : "estimated error " + math::percent(space_));
    decisions_.back().reason += failed;
    if (too_low > 2)
      decisions_.back().reason +=
          fmt::format("; the first estimates were too low by a factor of {}, which is accounted for",
                      too_low > 1e4 ? "more than 10000" : fmt::format("up to {:.2g}", too_low));
  }

  /// Where impulses change velocities, the difference to the full-order motion if that is larger.
  double estimate_of(const RunResult& result) {
    const auto from_file = [](const scene::Body& body) { return body.reduced.has_value(); };
    if (candidates_->columns().empty()) {
      if (std::any_of(scene_.bodies.begin(), scene_.bodies.end(), from_file))
        throw InputError(scene_.file +
                         ": accuracy: no error estimate is possible: bodies from files have no mesh to compare with, "
                         "and there is no other flexible body");
      return 0;
    }
    if (!result.estimate.none.empty())
      throw InputError(
          fmt::format("{}: accuracy: no error estimate is possible: {}", scene_.file, result.estimate.none));
    double worst = 0;
    for (const double error : result.estimate.probes) worst = std::max(worst, error);
    return result.impulsive ? std::max(worst, impulses_.of(result.series)) : worst;
  }

  /// The remaining error of a step after a halving that changed `between`, the one before it `before`; r their
  /// ratio. The changes to come, r/(1 - r) between, less the third of it that the extrapolation adds, or a twelfth of
  /// it.
  static double left_of(double between, double before) {
    const double r = between / before;
    return r < 0.4 ? between * std::max(1. / 12, std::abs(r / (1 - r) - 1. / 3)) : between;
  }

  /// A motion in steps that were halved until its remaining error is less than a tenth of the required error.
  struct Limit {
    Series series;
    double left;    ///< remaining error
    double finest;  ///< step of models that are compared with it
  };

  /// Whether the model's simulation in these steps fails, which leaves the error of the step open.
  bool fails(const Selection& model, double step) {
    const Trial& trial = trials_.tried(model, step);
    if (trial.series.t.empty() && !trial.failed.empty())
      unresolved_ = fmt::format("in steps of {:.4g} s the simulation fails: {}", step, trial.failed);
    return trial.series.t.empty() && !trial.failed.empty();
  }

  /// From `last` in steps of that size, which a halving before changed by `before` (0: there was none). The last two
  /// motions are extrapolated (Richardson, order 2) where three of them show the order.
  Limit halve(const Selection& model, Series last, double step, double before) {
    constexpr int most_halvings = 5;
    Limit limit{last, before / 3, step};
    for (int halving = before > 0; halving < most_halvings; ++halving) {
      if (fails(model, step / 2)) break;
      Series fine = trials_.series_of(model, step / 2);
      const double between = worst_error(last, fine);
      const bool ordered = before > 0 && between < 0.4 * before;
      limit.series = fine;
      if (ordered) add_difference(limit.series, 1. / 3, fine, last);
      limit.left = before > 0 ? left_of(between, before) : between / 3;
      limit.finest = ordered && between > 0.2 * accuracy_ ? step / 2 : step;
      if (limit.left <= 0.1 * accuracy_) break;
      last = std::move(fine), before = between, step /= 2;
    }
    return limit;
  }

  /// The reference solution: the motion of the richest model in steps that are halved,
  ///
  ///   y = y_whole(h/2) + [y_few(0) - y_few(h/2)]
  ///
  /// with the fewest basis vectors whose error is within half of the error budget. A halving of both models gives the
  /// difference of the errors of their steps; a third of it remains (order 2).
  void resolve_time() {
    if (reference_.series) {
      compare_with_given();
      return;
    }
    const double h = scene_.motion.step;
    if (fails(candidates_->whole(), h / 2)) {
      trials_.compare_with(whole_motion_);
      finest_ = h, richest_ = space_ + reference_.error;
      return;
    }
    const Series fine = trials_.series_of(candidates_->whole(), h / 2);
    const double between = worst_error(whole_motion_, fine);
    Limit limit{fine, between / 3, h};
    if (limit.left > 0.1 * accuracy_ && !by_few(fine, limit)) limit = halve(candidates_->whole(), fine, h / 2, between);
    trials_.compare_with(std::move(limit.series));
    time_ = limit.left, finest_ = limit.finest;
    richest_ = space_ + time_ + reference_.error;
  }

  /// @return  false: the errors of both models' steps are too different
  bool by_few(const Series& fine, Limit& limit) {
    if (order_.empty()) return false;
    const double h = scene_.motion.step;
    richest_ = space_ + 0.1 * accuracy_ + reference_.error;
    trials_.compare_with(fine);
    const std::size_t count = trials_.fewest(order_, order_.size(), h / 2, first_time_budget());
    const Selection few = trials_.first_of(order_, count);
    if (!trials_.tried(few, h).failed.empty() || !trials_.tried(few, h / 2).failed.empty()) return false;
    const Series long_steps = trials_.series_of(few, h), short_steps = trials_.series_of(few, h / 2);
    Series difference = whole_motion_;
    add_difference(difference, 1, short_steps, long_steps);
    const double apart = worst_error(difference, fine) / 3;
    Limit of_few = halve(few, short_steps, h / 2, worst_error(long_steps, short_steps));
    if (of_few.series.t.empty() || apart > std::max(0.2 * of_few.left, 0.1 * accuracy_ - of_few.left)) return false;
    limit.series = fine;
    add_difference(limit.series, 1, of_few.series, short_steps);
    limit.left = of_few.left + apart;
    limit.finest = h / 2;
    few_ = count, shortest_ = of_few.finest;
    return true;
  }

  /// The longest step whose error in the formulation of the reference is less than a quarter of the required error.
  void compare_with_given() {
    constexpr int most_halvings = 5;
    richest_ = reference_.error;
    finest_ = scene_.motion.step;
    const double most = 0.25 * accuracy_;
    double of_step = reference_.of_step;
    for (int halving = 0; halving < most_halvings && of_step > most; ++halving) of_step /= 4, finest_ /= 2;
    for (; 4 * of_step <= most && may_be(2 * finest_); of_step *= 4) finest_ *= 2;
    trials_.compare_with(*reference_.series);
    least_ = finest_ == scene_.motion.step ? worst_error(whole_motion_, *reference_.series)
                                           : trials_.tried(candidates_->whole(), finest_).error;
    decide("richest model", "relative to cfr", "error " + math::percent(least_));
  }

  /// Output between steps is interpolated, and its error is included; a minimum number of steps is required.
  bool may_be(double step) const { return step <= scene_.motion.end / 32; }
  bool longer_step() const { return may_be(2 * step_); }

  /// The error budget beside the richest model's own error.
  double time_budget() const { return std::max(0.0, 0.9 * accuracy_ - richest_); }
  /// The error budget of basis vectors before steps are longer: half of what the richest model leaves.
  double first_time_budget() const {
    return std::min(least_, time_budget()) + 0.5 * std::max(0.0, time_budget() - least_);
  }

  void choose_columns_and_step() {
    step_ = finest_;
    count_ = few_.value_or(0);
    const auto fails = [&] { return !(trials_.tried(trials_.first_of(order_, count_), step_).error <= time_budget()); };
    while (few_ && fails() && step_ > shortest_) step_ /= 2;
    if (reference_.series)  // steps of the richest model are cheaper than columns of many models in short steps
      while (longer_step() && trials_.tried(candidates_->whole(), 2 * step_).error <= first_time_budget()) step_ *= 2;
    if (!few_ || fails()) count_ = trials_.fewest(order_, order_.size(), step_, first_time_budget());
    std::size_t before = order_.size() + 1;
    for (double step = 0; step_ != step || count_ != before;) {
      step = step_, before = count_;
      while (longer_step() && trials_.tried(trials_.first_of(order_, count_), 2 * step_).error <= time_budget())
        step_ *= 2;
      count_ = trials_.fewest(order_, count_, step_, time_budget());
    }
    selection_ = trials_.first_of(order_, count_);  // all of the order can be too few to satisfy the joints
    if (!trials_.tried(selection_, step_).failed.empty()) count_ = order_.size(), selection_ = candidates_->whole();
  }

  /// Linear, without derivatives, which would have no effect.
  void choose_force() {
    if (count_ == 0) return;
    std::vector<assess::EnergyContribution> plain;
    for (const assess::EnergyContribution& one : order_)
      if (candidates_->columns()[one.column].label.find("derivative ") == std::string::npos) plain.push_back(one);
    Selection all = trials_.first_of(plain, plain.size());
    all.linear = true;
    const Trial& linear = trials_.tried(all, step_);
    linear_ = words(linear);
    if (!(linear.error <= time_budget())) return;
    Selection some = trials_.first_of(plain, trials_.fewest(plain, plain.size(), step_, time_budget(), true));
    some.linear = true;
    const Trial& cheaper = trials_.tried(some, step_);
    linear_ = words(cheaper);
    if (!(cheaper.error <= time_budget())) return;
    // With no more basis vectors the linear force is the cheaper one, whatever the measured time.
    if (some.count() > selection_.count() &&
        !(trials_.seconds_of(some, step_) < 0.9 * trials_.seconds_of(selection_, step_))) {
      linear_ += fmt::format(" with {} basis vectors, but not faster", some.count());
      return;
    }
    selection_ = some, order_ = plain, count_ = some.count();
  }

  /// Residual responses of the selected model's own (reduction.responses), which a scene can name, in place of the
  /// correction vectors of the estimate, which it cannot: up to half as many again, where their error is within what
  /// those leave. @return  the error; none: they are not as good
  std::optional<double> name_responses(Chosen& chosen) {
    const double most = std::max(time_budget(), trials_.tried(selection_, step_).error);
    std::vector<std::string> others;
    for (const double times : {1.0, 1.5}) {
      Selection named = selection_;
      named.responses = times;
      std::string result;
      try {
        const scene::Scene scene =
            scene::parse_scene(candidates_->text(named, trials_.with_step(step_).motion), scene_.file);
        const double error = trials_.error_of(scene, step_);
        result = fmt::format("{:g} times as many: {}", times, math::percent(error));
        if (error <= most) {
          decide("residual responses", fmt::format("{:g} times as many as correction vectors", times),
                 fmt::format("{}{}{}", fmt::join(others, "; "), others.empty() ? "" : "; ", result));
          chosen.scene = scene, chosen.selection = named;
          chosen.model = assembly::build(scene, scene::Formulation::vm_md, comm_, true);
          return error;
        }
        if (error > 3 * most) {  // half as many again would not do
          others.push_back(result);
          break;
        }
      } catch (const std::runtime_error& fault) {  // on all ranks
        if (Interruption::happened(comm_)) throw;
        result = fmt::format("{:g} times as many: {}", times, shortened(fault.what()));
      }
      others.push_back(result);
    }
    decide("residual responses", "none", fmt::format("{}", fmt::join(others, "; ")));
    return {};
  }

  Chosen finished() {
    for (Decision& one : reasons({selection_, order_, count_, step_, longer_step(), linear_}, *candidates_, trials_))
      decisions_.push_back(std::move(one));
    for (const scene::Body& body : scene_.bodies)
      if (body.reduced) decide("  " + body.name, "from a file", "assumed exact: its mesh is not available");
    Chosen chosen;
    chosen.asked = accuracy_, chosen.richest = richest_;
    if (!unresolved_.empty()) chosen.unbounded.push_back({"step", unresolved_});
    double of_choice = trials_.tried(selection_, step_).error;
    if (candidates_->has_responses(selection_)) of_choice = name_responses(chosen).value_or(of_choice);
    chosen.supported = richest_ + of_choice;
    decide("estimated error", math::percent(chosen.supported),
           reference_.series
               ? fmt::format("{} of the selected model relative to formulation cfr, {} of that",
                             math::percent(of_choice), math::percent(richest_))
               : fmt::format(
                     "{} of the selected model, {} of the richest model, {} of its step{}", math::percent(of_choice),
                     math::percent(space_), math::percent(time_),
                     reference_.error > 0 ? fmt::format(", {} of its mesh", math::percent(reference_.error)) : ""));
    chosen.decisions = std::move(decisions_);
    if (!impulses_.unknown().empty() && !reference_.series)
      chosen.unbounded.emplace_back("reduction", impulses_.unknown());
    if (chosen.selection.responses == 0) {
      chosen.scene = trials_.with_step(step_);
      if (!candidates_->has_responses(selection_)) {
        chosen.scene.text = candidates_->text(selection_, chosen.scene.motion);
        if (reference_.total) chosen.scene = scene::parse_scene(chosen.scene.text, scene_.file);
      }
      chosen.selection = selection_;
      chosen.model = candidates_->model(selection_, true);
    }
    chosen.candidates = std::move(candidates_);
    chosen.trials = trials_.count(), chosen.building = building_;
    return chosen;
  }

  const scene::Scene& scene_;
  double accuracy_;
  MPI_Comm comm_;
  Reference reference_;
  std::clock_t begin_;
  std::unique_ptr<assess::CandidateBasis> candidates_;
  double building_;                   // processor time [s]
  Trials trials_;                     // its reference: the richest model's motion in fine steps, or the given one
  std::vector<solve::State> states_;  // of the richest model
  ImpulseError impulses_;
  std::string unresolved_;  // why the error of the step is open
  Series whole_motion_;     // its motion, in steps that are halved
  double space_ = 0, time_ = 0, richest_ = 0, finest_ = 0;
  std::optional<std::size_t> few_;  // columns of a smaller model whose steps were halved instead of the richest one's
  double shortest_ = 0;             // step that it needs
  double least_ = 0;                // of the richest model against a reference of another formulation
  std::vector<assess::EnergyContribution> order_;
  std::size_t count_ = 0;
  double step_ = 0;
  Selection selection_;
  std::string linear_;  ///< what came of a linear elastic force
  std::vector<Decision> decisions_;
};

}  // namespace

Chosen choose_within(const scene::Scene& scene, double accuracy, MPI_Comm comm, const Reference& reference) {
  return Search(scene, accuracy, comm, reference).result();
}

}  // namespace floe::app
