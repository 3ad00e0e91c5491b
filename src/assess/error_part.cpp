#include "error_part.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>

#include "floe/assess/probe_errors.h"
#include "floe/error.h"
#include "floe/math/rounded.h"
#include "floe/petsc/error.h"
#include "floe/petsc/rank.h"
#include "floe/petsc/together.h"

namespace floe::assess {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Where each column of `own` is among others; -1: nowhere.
std::vector<int> places_of(const std::vector<ProbeColumn>& own, const std::vector<ProbeColumn>& others) {
  std::vector<int> places;
  for (const ProbeColumn& column : own) {
    const auto at =
        std::find_if(others.begin(), others.end(), [&](const ProbeColumn& other) { return other.name == column.name; });
    places.push_back(at == others.end() ? -1 : static_cast<int>(at - others.begin()));
  }
  return places;
}

/// Whether other models of the scene are built by every rank for itself.
bool alone(const FinishedMotion& motion) {
  constexpr PetscInt most_alone = 2000;
  return elements_of(*motion.model.offline) <= most_alone;
}

/// Of ranks that simulated a copy each, until one of them failed: what all of them have, and why they have no more.
void share_fault(MPI_Comm comm, const std::exception_ptr& fault, ProbeHistory& history) {
  const std::string why = petsc::failed_together(comm, [&] {
    if (fault) std::rethrow_exception(fault);
    if (!history.stopped.empty()) throw RunError(history.stopped);
  });
  history.stopped = why, history.enough = false;
  double reached = history.reached;
  unsigned long count = history.values.size();
  MPI_Allreduce(MPI_IN_PLACE, &reached, 1, MPI_DOUBLE, MPI_MIN, comm);
  MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_UNSIGNED_LONG, MPI_MIN, comm);
  history.reached = reached;
  history.values.resize(count);
}

/// The first event that is not among others.
std::string first_beside(const std::vector<std::string>& events, const std::vector<std::string>& others) {
  for (const std::string& event : events)
    if (std::find(others.begin(), others.end(), event) == others.end()) return event;
  return "";
}

/// Instants at which other joints hold than in the motion itself are not compared.
void leave_out_other_joints(const ProbeSeries& own, ProbeHistory& history) {
  if (own.changes.empty() && history.changes.empty()) return;
  std::size_t last = 0;  // behind the last one that is compared
  for (std::size_t i = 0; i < history.values.size(); ++i) {
    const bool same = same_joints(own.changes, own.t[i], std::span(history.changes).first(history.happened[i]));
    if (same) last = i + 1;
    if (!same) history.values[i].assign(history.values[i].size(), unknown);
  }
  if (last == history.values.size() || own.t.back() - own.t[last] < 0.02 * own.t.back()) return;
  std::vector<std::string> events;
  for (const JointChange& change : own.changes) events.push_back(change.event);
  std::string name = first_beside(events, history.changes);
  if (name.empty()) name = first_beside(history.changes, events);
  if (name.empty()) return;  // late
  history.reached = own.t[last];
  history.values.resize(last);
  history.stopped = fmt::format("only to t = {:.3g} s, from which on event {} makes the joints of both models differ",
                                history.reached, name);
}

}  // namespace

void set_errors(const ProbeSeries& own, const Simulated& other, const Simulated& one, double weight,
                const std::vector<std::vector<double>>& less, ErrorPart& part) {
  const std::vector<int> theirs = places_of(own.columns, other.columns), ours = places_of(own.columns, one.columns);
  const std::size_t count = std::min({own.t.size(), other.values.size(), one.values.size()});
  ProbeErrors errors(own.columns);
  std::size_t left_out = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> row(own.columns.size(), unknown);
    std::size_t compared = 0, known = 0;
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (theirs[c] < 0 || ours[c] < 0) continue;
      row[c] = weight * (other.values[i][theirs[c]] - one.values[i][ours[c]]);
      if (i < less.size()) row[c] -= less[i][c];
      ++compared, known += std::isnan(row[c]) ? 0 : 1;
    }
    const bool none = known == 0 && compared > 0;
    if (none) ++left_out;
    if (!none) errors.add(row, own.values[i]);  // a probe without a value at one of them has no error
    part.t.push_back(own.t[i]);
    part.errors.push_back(std::move(row));
  }
  if (left_out == count) part.t.clear();
  if (part.t.empty()) return;
  if (const double share = static_cast<double>(left_out) / static_cast<double>(count); share > 0.02)
    part.notes.push_back(fmt::format(
        "{} of the instants are between the times of an event in both models: not compared", math::percent(share)));
  part.until = part.t.back();
  part.probes = errors.relative(part.until - part.t.front());
  for (double& error : part.probes)
    if (error > 100) error = std::numeric_limits<double>::infinity();
  leave_out_quiet(own, part);
}

void leave_out_quiet(const ProbeSeries& own, ErrorPart& part) {
  constexpr double quiet = 0.1;
  if (own.t.empty() || part.probes.empty() || part.until >= 0.98 * own.t.back()) return;
  std::vector<std::string> names;
  for (std::size_t c = 0, p = 0; c < own.columns.size(); ++p) {
    const std::string name = probe_of(own.columns[c]);
    std::size_t end = c;
    while (end < own.columns.size() && probe_of(own.columns[end]) == name) ++end;
    double covered = 0, whole = 0;
    for (std::size_t i = 0; i < own.t.size(); ++i) {
      double moved = 0;
      for (std::size_t k = c; k < end; ++k) moved += std::pow(own.values[i][k] - own.values[0][k], 2);
      whole = std::max(whole, moved);
      if (own.t[i] <= part.until * (1 + 1e-9)) covered = std::max(covered, moved);
    }
    if (covered < quiet * quiet * whole && std::isfinite(part.probes[p]))
      part.probes[p] = unknown, names.push_back(name);
    c = end;
  }
  if (!names.empty())
    part.notes.push_back(fmt::format("{} {} later than t = {:.3g} s, which this part does not cover",
                                     fmt::join(names, ", "), names.size() > 1 ? "move" : "moves", part.until));
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string too_long(double limit) { return fmt::format("ended after {:.2g} s", limit); }

Simulated compared(const FinishedMotion& motion, std::vector<ProbeColumn> columns, ProbeHistory history,
                   const std::string& what, ErrorPart& part) {
  if (!history.stopped.empty()) {
    const std::string why = what + ": " + first_line(history.stopped);
    if (history.reached < min_fraction * motion.how.end) throw RunError(why);
    part.notes.push_back(why);
  }
  return {std::move(columns), std::move(history.values)};
}

bool fill_in(const FinishedMotion& motion, ErrorPart& part, const std::function<void()>& work) {
  const std::string why = petsc::failed_together(motion.comm, work);
  if (why.empty()) return true;
  std::vector<std::string> notes = std::move(part.notes);
  part = {};
  part.none = first_line(why), part.notes = std::move(notes);
  return false;
}

Model built(const FinishedMotion& motion, const Scene& scene, Formulation formulation) {
  if (!alone(motion)) return build(scene, formulation, motion.comm);
  std::optional<Model> model;
  petsc::agree(motion.comm, [&] { model = build(scene, formulation, PETSC_COMM_SELF); });
  return std::move(*model);
}

/// Before longer steps fail their results may be far off: the first half of them counts.
void leave_out_failing(const FinishedMotion& motion, const solve::Integration& how, const ProbeSeries& own,
                       ProbeHistory& history) {
  if (history.stopped.empty() || how.step <= motion.how.step || own.t.empty()) return;
  history.reached = own.t.front() + (history.reached - own.t.front()) / 2;
  history.stopped = fmt::format("{}; only the first half counts", first_line(history.stopped));
  const auto end = std::upper_bound(own.t.begin(), own.t.end(), history.reached);
  history.values.resize(std::min(history.values.size(), static_cast<std::size_t>(end - own.t.begin())));
}

ProbeHistory simulated(const FinishedMotion& motion, const TimeBudget& time, const Scene& scene, const Model& model,
                       const solve::Integration& how, const ProbeSeries& own, const Enough& enough) {
  const auto looks = [&](const solve::Instant& instant) {
    return motion.at_rest || instant.step <= looked_at || instant.step % look_every == 0;
  };
  const auto history_of = [&](const std::function<bool(const solve::Instant&)>& ends) {
    return motion.at_rest ? equilibrium_history(model, how, own.t, ends)
                          : probe_history(scene, model, how, own.t, ends);
  };
  ProbeHistory history;
  if (!is_reduced(model.formulation) && !alone(motion)) {
    history = history_of(
        [&](const solve::Instant& instant) { return enough && looks(instant) && enough(instant, time.spent()); });
    leave_out_failing(motion, how, own, history);
    leave_out_other_joints(own, history);
    return history;
  }
  bool failed = false;  // a rank, as all know
  const auto look = [&](bool here) {
    double all[2] = {here ? 1. : 0., petsc::first_rank(motion.comm) ? time.spent_here() : 0};
    MPI_Allreduce(MPI_IN_PLACE, all, 2, MPI_DOUBLE, MPI_MAX, motion.comm);
    failed = all[0] > 0;
    return all[1];
  };
  std::exception_ptr fault;
  try {
    history = history_of([&](const solve::Instant& instant) {
      if (!looks(instant)) return false;
      const double spent = look(false);
      return failed || (enough && enough(instant, spent));
    });
  } catch (const std::exception&) {
    fault = std::current_exception();
  }
  const bool told = failed;
  if (!told) look(fault || !history.stopped.empty());
  if (failed) share_fault(motion.comm, told ? nullptr : fault, history);
  leave_out_failing(motion, how, own, history);
  leave_out_other_joints(own, history);
  return history;
}

bool can_lengthen(const FinishedMotion& motion) { return !motion.at_rest && !motion.how.tolerance; }

Simulated again(const FinishedMotion& motion, const ProbeSeries& own, const TimeBudget& time, double times, double end,
                ErrorPart& part) {
  solve::Integration how = motion.how;
  how.step *= times, how.end = end;
  const petsc::VecHandle A = motion.model.system->create_vector();
  solve::set_state(*motion.model.system, motion.start, motion.model.U, motion.model.V, A);
  return compared(motion, own.columns, simulated(motion, time, motion.scene, motion.model, how, own),
                  fmt::format("the motion in steps {:g} times as long", times), part);
}

std::string without_mesh(const Scene& scene) {
  const auto any = [&](auto&& is) { return std::any_of(scene.bodies.begin(), scene.bodies.end(), is); };
  if (any(scene::is_meshed)) return "";
  return any([](const Body& body) { return body.reduced.has_value(); }) ? "no flexible body has a mesh"
                                                                        : "no body is flexible";
}

bool any_shells(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const Body& body) { return is_meshed(body) && (body.mesh.plate || body.mesh.file); });
}

bool scale_meshes(Scene& scene, double factor) {
  bool divided = true;
  const auto scale = [&](int& elements) {
    const double scaled = elements * factor;
    elements = static_cast<int>(std::lround(scaled));
    divided = divided && elements > 0 && std::abs(scaled - elements) < 1e-9;
  };
  for (Body& body : scene.bodies) {
    if (body.rigid && factor < 1) continue;
    if (body.mesh.file && is_meshed(body)) {
      const int refine = body.mesh.file->refine + std::ilogb(factor);
      divided = divided && refine >= 0;
      body.mesh.file->refine = std::max(0, refine);
    }
    for (int& elements : body.mesh.elements) scale(elements);
    if (body.mesh.plate)
      for (int& elements : body.mesh.plate->elements) scale(elements);
  }
  return divided;
}

}  // namespace floe::assess
