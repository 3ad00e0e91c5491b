#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "error_part.h"
#include "floe/assess/probe_errors.h"
#include "floe/error.h"
#include "floe/petsc/together.h"

namespace floe::assess {

namespace {

constexpr double power = 4;  // 2^2: errors of order 2 in the elements' length

/// How many times as many elements the refined bodies have.
double growth(const Scene& scene) { return any_shells(scene) ? 4 : 2; }

class MeshError {
 public:
  MeshError(const FinishedMotion& motion, const ProbeSeries& own, const TimeBudget& time, double allowed,
            ErrorPart& part)
      : motion_(motion), own_(own), time_(time), allowed_(allowed), part_(part), other_(motion.scene) {}

  void estimate() {
    const double offline = time_.of_first(motion_.offline);
    finer_ = growth(other_) * offline <= allowed_;
    if (!finer_ && !scale_meshes(other_, 0.5)) {
      part_.none = fmt::format("the reduction of the refined mesh would take about {:.2g} s (limit {:.2g} s)",
                               growth(other_) * offline, allowed_);
      return;
    }
    if (finer_) scale_meshes(other_, 2);
    part_.by = finer_ ? "elements half as long" : "elements twice as long";
    const ErrorPart empty = part_;
    const std::string fault = petsc::failed_together(motion_.comm, [&] { add(reduced()); });
    if (!fault.empty()) {  // the other mesh has other basis vectors, for example
      part_ = empty, part_.by.clear();
      part_.none = first_line(fault);
    }
    if (!is_reduced(motion_.model.formulation) || !(fault.empty() ? crowded() : full_order_is_cheap())) return;
    if (!(time_.of_first(worst(part_)) > doubtful)) return;
    ErrorPart first = std::move(part_);
    part_ = empty;
    const std::string why = petsc::failed_together(motion_.comm, [&] { add(full_order()); });
    if (!why.empty() || time_.of_first(is_smaller(part_, first)) == 0) part_ = std::move(first);
  }

 private:
  struct Two {
    Simulated other, one;  ///< on the other mesh, and on the motion's
  };
  static constexpr double doubtful = 1e-3;

  void add(const std::optional<Two>& two) {
    if (!two) return;
    set_errors(own_, two->other, two->one, finer_ ? power / (power - 1) : -1 / (power - 1), {}, part_);
    if (part_.t.empty()) part_.none = "there are no results at the instants stored";
  }

  /// Of all probes; without errors: infinite.
  static double worst(const ErrorPart& part) {
    if (!part.none.empty() || part.probes.empty()) return std::numeric_limits<double>::infinity();
    double worst = 0;
    for (const double error : part.probes)
      if (!std::isnan(error)) worst = std::max(worst, error);
    return worst;
  }

  /// Whether an error is smaller than the first over the time that it covers, and known of the same probes.
  bool is_smaller(const ErrorPart& part, const ErrorPart& first) const {
    if (!part.none.empty()) return false;
    if (!first.none.empty()) return true;
    ProbeErrors same(own_.columns);
    for (std::size_t i = 0; i < first.t.size() && first.t[i] <= part.until; ++i) {
      const auto at = std::lower_bound(own_.t.begin(), own_.t.end(), first.t[i]);
      same.add(first.errors[i], own_.values[static_cast<std::size_t>(at - own_.t.begin())]);
    }
    const std::vector<double> before = same.relative(part.until - own_.t.front());
    double greatest = 0;
    for (std::size_t p = 0; p < first.probes.size(); ++p) {
      if (std::isnan(first.probes[p])) continue;
      if (std::isnan(part.probes[p])) return false;
      greatest = std::max(greatest, before[p]);
    }
    return worst(part) < greatest;
  }

  /// Whether the basis vectors of a body are a great part of all that it can do: those of the same names are a smaller
  /// part on a refined mesh, and the difference of reduced models is that of their reductions, too.
  bool crowded() const {
    return std::any_of(motion_.scene.bodies.begin(), motion_.scene.bodies.end(), [&](const Body& body) {
      int columns = 0;
      PetscInt dofs = 0;
      for (const BodyReport& report : motion_.model.bodies)
        if (report.name == body.name || report.whole == body.name) columns += report.columns, dofs += report.dofs;
      return 4 * columns > dofs;
    });
  }

  /// Whether full-order models take little time.
  bool full_order_is_cheap() const {
    constexpr PetscInt most = 3000;
    PetscInt dofs = 0;
    for (const BodyReport& report : motion_.model.bodies) dofs += report.dofs;
    return (finer_ ? static_cast<PetscInt>(growth(other_)) : 1) * dofs <= most;
  }

  Model built_on_other(Formulation formulation) const {
    try {
      return built(motion_, other_, formulation);
    } catch (const InputError& fault) {  // of every rank: a node of the scene's mesh that the other does not have
      throw RunError(fmt::format("on {}: {}", part_.by, first_line(fault.what())));
    }
  }

  ProbeHistory simulate(const Scene& scene, const Model& model, const solve::Integration& how, double most) const {
    return simulated(motion_, time_, scene, model, how, own_,
                     [&](const solve::Instant&, double spent) { return spent > most; });
  }

  /// Whether too little was simulated; what else ended it is noted.
  bool fails(const ProbeHistory& history) {
    if (!history.enough && history.stopped.empty()) return false;
    const std::string why = part_.by + ": " + (history.enough ? too_long(2 * allowed_) : first_line(history.stopped));
    const bool fails = history.reached < min_fraction * motion_.how.end;
    (fails ? part_.none : part_.notes.emplace_back()) = why;
    return fails;
  }

  /// Both at full order; of the first part of the motion, where the time does not suffice for the whole.
  std::optional<Two> full_order() {
    part_.by += ", in full-order models";
    solve::Integration how = motion_.how;
    const Model model = built_on_other(Formulation::nlffr), same = built(motion_, motion_.scene, Formulation::nlffr);
    ProbeHistory one = simulate(motion_.scene, same, how, time_.spent() + 0.4 * time_.left());
    if (!one.stopped.empty() && fails(one)) return std::nullopt;
    how.end = one.reached;
    ProbeHistory other = simulate(other_, model, how, 2 * allowed_);
    if (fails(other)) return std::nullopt;
    return Two{{probe_columns(model), std::move(other.values)}, {probe_columns(same), std::move(one.values)}};
  }

  std::optional<Two> reduced() {
    const double took = std::max(1e-6, time_.of_first(motion_.seconds));
    const Model model = built_on_other(motion_.model.formulation);
    int step = 1;
    const auto needs = [&] { return step == 1 ? took : 2 * took / step; };
    if (can_lengthen(motion_))
      while (needs() > time_.left() && step < 4) step *= 2;
    solve::Integration how = motion_.how;
    how.step *= step;
    if (const double share = time_.left() / needs(); share < 1) how.end *= std::max(share, min_fraction);
    if (step > 1) part_.by += fmt::format(", steps {} times as long", step);
    ProbeHistory other = simulate(other_, model, how, 2 * allowed_);
    if (fails(other)) return std::nullopt;
    const double reached = other.reached;
    Two two{{probe_columns(model), std::move(other.values)}, {own_.columns, own_.values}};
    if (step > 1) two.one = again(motion_, own_, time_, step, reached, part_);
    return two;
  }

  const FinishedMotion& motion_;
  const ProbeSeries& own_;
  const TimeBudget& time_;
  double allowed_;
  ErrorPart& part_;
  Scene other_;
  bool finer_ = true;
};

}  // namespace

ErrorPart estimate_mesh_error(const FinishedMotion& motion, const ProbeSeries& own, double allowed) {
  ErrorPart part;
  part.none = without_mesh(motion.scene);
  if (part.none.empty() && own.t.empty()) part.none = "the integrator provides no accelerations";
  if (part.none.empty() && motion.scene.probes.empty()) part.none = "no probes";
  if (!part.none.empty()) return part;
  for (const Body& body : motion.scene.bodies)
    if (body.reduced) part.notes.push_back(fmt::format("body {} comes from a file without its mesh", body.name));
  const TimeBudget time(motion.comm, allowed);
  fill_in(motion, part, [&] { MeshError(motion, own, time, allowed, part).estimate(); });
  part.seconds = time.spent();
  return part;
}

}  // namespace floe::assess
