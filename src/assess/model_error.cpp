#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "error_part.h"
#include "floe/assess/probe_errors.h"
#include "floe/error.h"
#include "floe/math/rounded.h"
#include "thinning.h"

namespace floe::assess {

namespace {

constexpr double large = 0.01;      // error of a probe
constexpr PetscInt slow_steps = 5;  // at the start, which take longer; looked_at of them show how long one takes

/// The difference to a better model, `formulation`, on the scene's mesh.
class ModelError {
 public:
  ModelError(Formulation formulation, const FinishedMotion& motion, const ProbeSeries& own, const Estimate& reduction,
             const ErrorPart& mesh, double allowed, ErrorPart& part)
      : formulation_(formulation),
        name_("formulation " + name_of(formulation)),
        motion_(motion),
        own_(own),
        reduction_(reduction),
        mesh_(mesh),
        part_(part),
        time_(motion.comm, allowed),
        allowed_(allowed),
        needs_(motion, time_.of_first(motion.seconds)) {}

  void estimate() {
    if (motion_.scene.probes.empty()) {
      part_.none = "no probe can be compared with " + name_;
      return;
    }
    if (min_fraction * needs_.least_thinned() > allowed_) {
      part_.none = fmt::format("{} would take more than {:.2g} s (limit {:.2g} s)", name_, needs_.least(), allowed_);
      return;
    }
    Thinning used;
    std::optional<Better> exact = better(used, motion_.how.end, true);
    if (!exact) {
      const std::optional<Thinning> thinning = affordable();
      if (!thinning) return;
      used = *thinning;
      exact = better(used, until_, false);
    }
    if (!resolved(exact->event_error)) exact = in_shorter_steps(used, std::move(*exact));
    if (!exact) return;
    part_.by = name_ + ", " + words(used);
    const Simulated plain = exact->probes;
    if (used.mesh == 1 && formulation_ == Formulation::cfr) extrapolate(used, *exact);
    part_.by += step_words(used.step);
    if (formulation_ == Formulation::cfr && reduction_.errors.empty()) {
      part_.with_reduction = true;
      part_.notes.push_back("it contains the reduction error, which is not known by itself");
    }
    const Simulated one = own_motion(used, exact->reached);
    const std::vector<std::string> notes = part_.notes;
    set_errors(own_, exact->probes, one, 1, others(), part_);
    if (useful(used, exact->reached)) correct_by_steps(used, *exact, {plain, one}, notes);
    if (part_.t.empty()) part_.none = name_ + " has no results at the instants stored";
  }

  double spent() const { return time_.spent(); }

 private:
  /// Of the better model.
  struct Better {
    Simulated probes;
    double reached = 0, event_error = 0;
  };

  /// A simulation; none: given up because the whole would take too long.
  std::optional<Better> better(Thinning thinning, double end, bool gives_up) {
    Scene scene = motion_.scene;
    if (thinning.mesh != 1) scale_meshes(scene, 1 / thinning.mesh);
    const Model model = built(motion_, scene, formulation_);
    solve::Integration how = motion_.how;
    how.step *= thinning.step, how.end = end;
    const double left = time_.left();
    const double built_after = time_.spent();
    double begin = 0;
    bool late = false;
    const auto enough = [&](const solve::Instant& instant, double spent) {
      if (!gives_up || instant.step > looked_at) return late = spent > 2 * allowed_;
      const double passed = spent - built_after;
      if (instant.step <= slow_steps) begin = passed;
      if (instant.step <= slow_steps && passed < left) return false;
      needs_.better_step = instant.step <= slow_steps
                               ? passed / static_cast<double>(std::max<PetscInt>(1, instant.step))
                               : (passed - begin) / static_cast<double>(instant.step - slow_steps);
      return (instant.step >= looked_at || passed > 0.2 * left) && needs_.whole() > left;
    };
    ProbeHistory history = simulated(motion_, time_, scene, model, how, own_, enough);
    if (history.enough && !late) return std::nullopt;
    if (late || !history.stopped.empty()) {
      const std::string why = name_ + ": " + (late ? too_long(2 * allowed_) : first_line(history.stopped));
      if (history.reached < min_fraction * motion_.how.end) throw RunError(why);
      part_.notes.push_back(why);
    }
    return Better{{probe_columns(model), std::move(history.values)}, history.reached, history.event_error};
  }

  /// Whether the steps resolve what events set free, as those of the motion do. A better model has higher frequencies:
  /// where not, its velocities have an error from the event on that is not its own.
  bool resolved(double event_error) const {
    return time_.of_first(event_error) <= std::max(0.1, 1.5 * time_.of_first(own_.event_error));
  }

  /// Where longer ones do not resolve what events set free; of lines on longer elements where time is short. It may
  /// take twice the time. @return  `longer`, where that stopped behind an event and shorter ones are no better
  std::optional<Better> in_shorter_steps(Thinning& used, Better longer) {
    const Thinning first = used;
    const double error = time_.of_first(longer.event_error);
    const std::vector<std::string> notes = part_.notes;
    const auto fits = [&](const Thinning& one) {
      return needs_.can_scale(one.mesh) && time_.of_first(needs_.of(one)) <= 2 * allowed_ - time_.spent();
    };
    while (used.step > 0.25 && can_lengthen(motion_)) {
      used.step /= 2;
      while (!fits(used) && used.mesh < 4 && !any_shells(motion_.scene)) used.mesh *= 2;
      if (!fits(used)) break;
      std::optional<Better> one;
      const std::string why = petsc::failed_together(motion_.comm, [&] { one = better(used, motion_.how.end, false); });
      if (!why.empty() || !resolved(one->event_error)) continue;
      part_.notes.clear();  // of longer steps
      return one;
    }
    used = first, part_.notes = notes;
    if (std::isinf(error)) return longer;
    part_.none = fmt::format(
        "{}: the step after an event has an error of {} of its path in this model; a quarter of the step has, too, or "
        "would take too much time (limit {:.2g} s)",
        name_, math::percent(error), allowed_);
    return std::nullopt;
  }

  /// Richardson's extrapolation to elements of no length, with those half as long, or of plates twice as long, where
  /// the time allows.
  void extrapolate(Thinning used, Better& exact) {
    for (const double mesh : {0.5, 2.0}) {
      const Thinning other{mesh, used.step};
      if (part_.apart || (mesh > 1 && !any_shells(motion_.scene))) continue;
      if (mesh_.errors.size() < exact.probes.values.size() || !needs_.can_scale(mesh))
        continue;  // e_mesh is subtracted
      if (time_.of_first(needs_.of(other)) > time_.left()) continue;
      std::optional<Better> second;
      const std::vector<std::string> notes = part_.notes;
      const std::string why =
          petsc::failed_together(motion_.comm, [&] { second = better(other, exact.reached, false); });
      if (!why.empty()) {  // the first one stands
        part_.notes.push_back("not extrapolated from " + words(other) + ": " + first_line(why));
        return;
      }
      if (!resolved(second->event_error) || second->reached < 0.98 * exact.reached) {
        part_.notes = notes;
        return;
      }
      if (mesh > 1) std::swap(exact, *second);
      const std::vector<std::vector<double>> fine = second->probes.values;
      add_third(second->probes.values, fine, exact.probes.values);
      exact = std::move(*second);
      part_.apart = true;
      part_.by += " and " + words(other);
    }
  }

  /// The better model and the motion, in the same steps.
  struct Both {
    Simulated better, own;
  };

  /// Whether steps of another length are worth their time: the part is large.
  bool useful(Thinning used, double end) {
    const auto large_ones = std::count_if(part_.probes.begin(), part_.probes.end(), [](double e) { return e > large; });
    const bool wanted = formulation_ == Formulation::cfr && can_lengthen(motion_) && large_ones > 0;
    return time_.of_first(wanted) > 0 && fits({used.mesh, 2 * used.step}, end, used.step > 1);
  }

  /// Whether the time suffices for both models up to `end`; of steps that were made longer to save it, with half the
  /// limit more.
  bool fits(Thinning other, double end, bool with_more) {
    const double left = std::max(0.0, (with_more ? 1.5 : 1) * allowed_ - time_.spent());
    return time_.of_first(needs_.of(other)) * end / motion_.how.end <= time_.of_first(left);
  }

  /// Subtracts from the difference of both models, `exact` less `these.own`, what is of the steps, by steps twice as
  /// long, and where these fail or change it much, by shorter ones: in steps h it is D(h) = D(0) + c h^2, of which
  /// D(0) = D(h') + (D(h') - D(2 h')) / 3 remains, h' the shortest. In coarse steps the errors of both models' steps
  /// may be unlike, as those of motions are that only one of them has; where steps resolve what both have, they are
  /// alike. Probes that no steps resolve are left out.
  void correct_by_steps(Thinning used, const Better& exact, const Both& these, const std::vector<std::string>& notes) {
    const std::string by = part_.by;
    Both fine = these;
    std::optional<Both> coarse = both({used.mesh, 2 * used.step}, exact.reached);
    ErrorPart change;  // D(h') - D(2 h')
    for (Thinning shorter{used.mesh, used.step / 2};; shorter.step /= 2) {
      if (coarse) change = difference(fine, *coarse);
      if (!change.t.empty()) {
        const ErrorPart moved = difference(fine, these);
        std::vector<std::vector<double>> less = others();
        for (std::size_t i = 0; i < std::min(less.size(), change.errors.size()); ++i)
          for (std::size_t c = 0; c < less[i].size(); ++c) less[i][c] -= moved.errors[i][c] + change.errors[i][c] / 3;
        set_errors(own_, exact.probes, these.own, 1, less, part_ = emptied(notes));
        const double length = 2 * shorter.step / used.step;  // h' / h
        part_.by = by + (length == 1 ? ", and both in steps twice as long"
                                     : fmt::format(", and both in steps 1/{:g} as long", 1 / length));
        if (time_.of_first(unresolved(change)) == 0) break;
      } else if (time_.of_first(time_.spent()) > 2 * allowed_) {
        return;  // the simulation was ended: the part stands
      }
      if (shorter.step < used.step / 4 || !fits(shorter, exact.reached, used.step > 1)) break;
      std::optional<Both> finer = both(shorter, exact.reached);
      if (!finer) break;
      coarse = std::exchange(fine, std::move(*finer));
    }
    if (change.t.empty()) return leave_out_unchecked();
    leave_out([&](std::size_t p) { return is_unresolved(change, p); },
              "steps of another length change the difference to formulation cfr by more than half of this part");
  }

  /// Whether steps do not resolve the part of a probe: those of another length change it by more than half of it.
  bool is_unresolved(const ErrorPart& change, std::size_t probe) const {
    return part_.probes[probe] > large && change.probes[probe] > part_.probes[probe] / 2;
  }
  bool unresolved(const ErrorPart& change) const {
    for (std::size_t p = 0; p < std::min(part_.probes.size(), change.probes.size()); ++p)
      if (is_unresolved(change, p)) return true;
    return false;
  }

  /// Both models once more, in steps of another length.  @return  none: one of them failed, or resolves less
  std::optional<Both> both(Thinning other, double end) {
    const std::vector<std::string> notes = part_.notes;
    std::optional<Better> second;
    Simulated own;
    const std::string why = petsc::failed_together(motion_.comm, [&] {
      second = better(other, end, false);
      own = own_motion(other, end);
    });
    part_.notes = notes;
    const bool reached =
        why.empty() && resolved(second->event_error) && time_.of_first(second->reached - 0.98 * end) >= 0;
    if (!reached) return std::nullopt;
    return Both{std::move(second->probes), std::move(own)};
  }

  /// Of both models in steps of one length, less that in those of another.
  ErrorPart difference(const Both& these, const Both& others) {
    ErrorPart of_own, change;
    set_errors(own_, these.own, others.own, 1, {}, of_own);
    set_errors(own_, these.better, others.better, 1, of_own.errors, change);
    return change;
  }

  /// Large errors of probes, where neither steps twice nor half as long can be computed: nothing shows that the steps
  /// resolve them.
  void leave_out_unchecked() {
    leave_out([&](std::size_t p) { return part_.probes[p] > large; },
              "whether the steps resolve the difference to formulation cfr is not known, because steps twice as long "
              "fail, and shorter ones do, too, or take too much time");
  }

  void leave_out(const std::function<bool(std::size_t)>& which, const std::string& why) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    std::vector<std::string> names;
    for (std::size_t c = 0, p = 0; c < own_.columns.size(); ++p) {
      const std::string name = probe_of(own_.columns[c]);
      const bool unresolved = which(p);
      if (unresolved) names.push_back(name), part_.probes[p] = unknown;
      for (; c < own_.columns.size() && probe_of(own_.columns[c]) == name; ++c)
        for (std::size_t i = 0; unresolved && i < part_.errors.size(); ++i) part_.errors[i][c] = unknown;
    }
    if (!names.empty())
      part_.notes.push_back(fmt::format("{}: {} {} left out; take a smaller motion.step", why, fmt::join(names, ", "),
                                        names.size() > 1 ? "are" : "is"));
  }

  /// The part without its errors, and with the notes before them.
  ErrorPart emptied(const std::vector<std::string>& notes) const {
    ErrorPart part = part_;
    part.notes = notes;
    part.t.clear(), part.errors.clear(), part.probes.clear();
    return part;
  }

  /// values += (fine - coarse) / 3.
  static void add_third(std::vector<std::vector<double>>& values, const std::vector<std::vector<double>>& fine,
                        const std::vector<std::vector<double>>& coarse) {
    values.resize(std::min({values.size(), fine.size(), coarse.size()}));
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t c = 0; c < values[i].size(); ++c) values[i][c] += (fine[i][c] - coarse[i][c]) / 3;
  }

  /// What is not of the model in the difference: the errors of the reduction and of the mesh.
  std::vector<std::vector<double>> others() const {
    std::vector<std::vector<double>> sum(own_.t.size(), std::vector<double>(own_.columns.size(), 0));
    const auto add = [&](double factor, const std::vector<double>& t, const std::vector<std::vector<double>>& errors) {
      for (std::size_t i = 0; i < sum.size(); ++i) {
        const auto at = std::lower_bound(t.begin(), t.end(), own_.t[i]);
        if (at == t.end() || *at != own_.t[i]) continue;
        const std::vector<double>& row = errors[static_cast<std::size_t>(at - t.begin())];
        for (std::size_t c = 0; c < row.size(); ++c)
          if (!std::isnan(row[c])) sum[i][c] += factor * row[c];
      }
    };
    add(1, reduction_.t, reduction_.errors);
    if (part_.apart) add(1, mesh_.t, mesh_.errors);
    return sum;
  }

  /// The motion itself with the same mesh and steps.
  Simulated own_motion(Thinning thinning, double end) {
    if (thinning.mesh == 1 && thinning.step == 1) return {own_.columns, own_.values};
    if (thinning.mesh == 1) return again(motion_, own_, time_, thinning.step, end, part_);
    Scene scene = motion_.scene;
    scale_meshes(scene, 1 / thinning.mesh);
    const Model model = built(motion_, scene, motion_.model.formulation);
    solve::Integration how = motion_.how;
    how.step *= thinning.step, how.end = end;
    return compared(motion_, own_.columns, simulated(motion_, time_, scene, model, how, own_),
                    "the reduced model on " + words(thinning), part_);
  }

  /// The least thinning that the time allows, or the most with the first part of the motion.
  std::optional<Thinning> affordable() {
    const std::vector<Thinning> all = needs_.all();
    until_ = motion_.how.end;
    for (const Thinning& one : all)
      if (time_.of_first(needs_.of(one)) <= time_.left()) return one;
    const Thinning last = all.empty() ? Thinning{} : all.back();
    const double share = time_.left() / time_.of_first(needs_.of(last));
    until_ *= share;
    if (share < min_fraction) {
      part_.none = fmt::format("{} would take about {:.2g} s ({:.2g} s are left of the limit of {:.2g} s)", name_,
                               time_.of_first(needs_.whole()), std::max(0., time_.left()), allowed_);
      return std::nullopt;
    }
    return last;
  }

  Formulation formulation_;
  std::string name_;
  const FinishedMotion& motion_;
  const ProbeSeries& own_;
  const Estimate& reduction_;
  const ErrorPart& mesh_;
  ErrorPart& part_;
  TimeBudget time_;
  double allowed_;
  ComparisonTime needs_;
  double until_ = 0;  // [s]
};

ErrorPart difference_to(Formulation formulation, const FinishedMotion& motion, const ProbeSeries& own,
                        const Estimate& reduction, const ErrorPart& mesh, double allowed) {
  ErrorPart part;
  part.apart = false;
  part.none.clear();
  part.none = without_mesh(motion.scene);
  if (part.none.empty() && own.t.empty()) part.none = "the integrator provides no accelerations";
  if (part.none.empty()) part.none = without_estimate(*motion.model.offline);
  if (!part.none.empty()) return part;
  ModelError error(formulation, motion, own, reduction, mesh, allowed, part);
  fill_in(motion, part, [&] { error.estimate(); });
  part.seconds = error.spent();
  return part;
}

}  // namespace

ErrorPart estimate_model_error(const FinishedMotion& motion, const ProbeSeries& own, const Estimate& reduction,
                               const ErrorPart& mesh, double allowed) {
  return difference_to(Formulation::cfr, motion, own, reduction, mesh, allowed);
}

Estimate estimate_by_full_order(const FinishedMotion& motion, const ProbeSeries& own, double allowed) {
  ErrorPart part = difference_to(Formulation::nlffr, motion, own, {}, {}, allowed);
  Estimate estimate;
  estimate.none = std::move(part.none), estimate.notes = std::move(part.notes);
  estimate.by = std::move(part.by), estimate.probes = std::move(part.probes);
  estimate.t = std::move(part.t), estimate.errors = std::move(part.errors);
  estimate.seconds = part.seconds, estimate.allowed = allowed;
  note_files(*motion.model.offline, estimate);
  return estimate;
}

}  // namespace floe::assess
