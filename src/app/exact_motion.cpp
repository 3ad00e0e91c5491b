#include "exact_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>

#include "compare_table.h"
#include "floe/assess/budget.h"
#include "floe/petsc/error.h"
#include "floe/petsc/together.h"
#include "interruption.h"
#include "refined.h"

namespace floe::app {

int elements_of(const scene::Scene& scene) {
  int count = 0;
  for (const scene::Body& body : scene.bodies) {
    for (const int elements : body.mesh.elements) count += elements;
    if (body.mesh.plate) count += 2 * body.mesh.plate->elements[0] * body.mesh.plate->elements[1];
    if (body.mesh.file && !body.rigid) count += 1000000;
  }
  return count;
}

namespace {

constexpr int halvings_at_most = 4, first_steps = 30;

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

bool ended_by_event(const RunResult& result) {
  const auto events = result.summary.find("events");
  return events != result.summary.end() && std::any_of(events->begin(), events->end(), [](const auto& event) {
           return event.value("what", "") == "stop";
         });
}

/// RunResult::motion_seconds is processor time.
RunResult moved(const scene::Scene& scene, scene::Formulation formulation, std::optional<double> until, MPI_Comm comm,
                double accuracy, bool energies = true) {
  RunPlan plan;
  plan.quiet = true, plan.check_range = false, plan.until = until;
  plan.energies = energies, plan.balance = false;
  plan.newton_tolerance = 1e-5 * accuracy;
  RunResult result;
  const std::clock_t begin = std::clock();
  const std::string why = petsc::failed_together(comm, [&] {
    const MPI_Comm on = elements_of(scene) <= 2000 ? PETSC_COMM_SELF : comm;
    assembly::Model model = assembly::build(scene, formulation, on);
    result = move(scene, model, 0, on, std::nullopt, plan);
  });
  if (Interruption::happened(comm)) throw RunError("interrupted");
  if (!why.empty()) throw RunError(why);
  const double end = until.value_or(scene.motion.end);
  if (!ended_by_event(result) && std::abs(result.end - end) > 2 * scene.motion.step)
    throw RunError(fmt::format("the simulation ends at t = {:.4g} s", result.end));
  result.motion_seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  MPI_Bcast(&result.motion_seconds, 1, MPI_DOUBLE, 0, comm);
  return result;
}

class Refinement {
 public:
  Refinement(const scene::Scene& scene, double accuracy, double most, MPI_Comm comm)
      : scene_(at_equal_times(scene)), accuracy_(accuracy), most_(most), comm_(comm) {}

  ExactMotion result() {
    ExactMotion exact;
    try {
      refine(exact);
    } catch (const std::runtime_error& fault) {  // on all ranks
      if (Interruption::happened(comm_)) throw;
      exact.none = "formulation cfr: " + first_line(fault.what());
    }
    return exact;
  }

 private:
  void refine(ExactMotion& exact) {
    const double steps = scene_.motion.end / scene_.motion.step;
    if (steps > 2 * first_steps) {
      const RunResult first =
          moved(scene_, scene::Formulation::cfr, first_steps * scene_.motion.step, comm_, accuracy_);
      const double whole = first.motion_seconds * steps / first_steps;
      if (whole > most_) {
        exact.none = fmt::format("formulation cfr would take about {:.2g} s (limit {:.2g} s)", whole, most_);
        return;
      }
    }
    const RunResult own = moved(scene_, scene::Formulation::cfr, std::nullopt, comm_, accuracy_);
    const double of_mesh = limit(own, true, exact.in_own_steps, exact);
    Series limit_of_steps;
    const double left_of_step = limit(own, false, limit_of_steps, exact);
    exact.of_step = worst_error(own.series, limit_of_steps);
    exact.series = exact.in_own_steps;
    add_difference(exact.series, 1, limit_of_steps, own.series);
    exact.error = std::hypot(of_mesh, left_of_step);
  }

  /// y(0, dt) or y(h, 0). @return what is left of its error
  double limit(const RunResult& own, bool mesh, Series& limit, ExactMotion& exact) {
    std::vector<Series> all{own.series};
    double took = own.motion_seconds, before = 0, left = 0;
    limit = own.series;
    for (int halving = 1; halving <= halvings_at_most; ++halving) {
      scene::Scene finer = scene_;
      if (mesh) assess::scale_meshes(finer, 1 << halving);
      if (!mesh) shorten_steps(finer.motion, 1 << halving);
      const double growth = mesh && assess::any_shells(scene_) ? 5 : 2;
      if (growth * took > most_) {
        if (halving == 1)
          throw RunError(fmt::format("{} halved would take about {:.2g} s (limit {:.2g} s)",
                                     mesh ? "its mesh" : "its step", growth * took, most_));
        break;
      }
      const RunResult one = moved(finer, scene::Formulation::cfr, std::nullopt, comm_, accuracy_);
      took = one.motion_seconds;
      if (std::abs(one.end - own.end) > 2 * scene_.motion.step + scene_.motion.output.value_or(0))
        throw RunError(fmt::format("the simulation ends at t = {:.4g} s, {} at {:.4g} s, since an event ends it",
                                   own.end, mesh ? "with shorter elements" : "in shorter steps", one.end));
      const double change = worst_error(all.back(), one.series);
      const bool ordered = before > 0 && change < 0.4 * before;
      limit = one.series;
      if (halving == 1 || ordered) add_difference(limit, 1. / 3, one.series, all.back());
      if (mesh) exact.mesh_ordered = halving == 1 || ordered;
      left = halving == 1 ? change / 3 : ordered ? change / 12 : change;
      all.push_back(one.series);
      if (!mesh) exact.halved_steps = halving;
      if (left <= 0.1 * accuracy_) break;
      before = change;
    }
    if (mesh)
      for (const Series& one : all) exact.of_mesh.push_back(worst_error(one, limit));
    return left;
  }

  scene::Scene scene_;
  double accuracy_, most_;
  MPI_Comm comm_;
};

}  // namespace

void add_difference(Series& y, double factor, const Series& a, const Series& b) {
  const std::size_t most = std::min({y.values.size(), a.values.size(), b.values.size()});
  const auto same = [&](std::size_t i) {  // not where an event ends them at different times
    const double near = 1e-9 * std::max(1e-300, std::abs(y.t[i]));
    return std::abs(a.t[i] - y.t[i]) <= near && std::abs(b.t[i] - y.t[i]) <= near;
  };
  std::size_t count = 0;
  while (count < most && same(count)) ++count;
  y.t.resize(count), y.values.resize(count), y.energy.resize(std::min(count, y.energy.size()));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < y.values[i].size(); ++c) y.values[i][c] += factor * (a.values[i][c] - b.values[i][c]);
}

Series exact_in_steps(const scene::Scene& scene, int n, const ExactMotion& exact, double accuracy, MPI_Comm comm) {
  scene::Scene other = at_equal_times(scene);
  other.motion.step *= n;
  const int halvings = std::max(0, static_cast<int>(exact.of_mesh.size()) - 1);
  const auto on_mesh = [&](int halving) {
    scene::Scene finer = other;
    assess::scale_meshes(finer, 1 << halving);
    return moved(finer, scene::Formulation::cfr, std::nullopt, comm, accuracy, false).series;
  };
  Series limit = on_mesh(halvings);
  if (halvings == 0 || !exact.mesh_ordered) return limit;
  const Series fine = limit;
  add_difference(limit, 1. / 3, fine, on_mesh(halvings - 1));
  return limit;
}

ExactMotion exact_motion(const scene::Scene& scene, double accuracy, double most, MPI_Comm comm) {
  return Refinement(scene, accuracy, most, comm).result();
}

Series quiet_motion(const scene::Scene& scene, scene::Formulation formulation, double accuracy, MPI_Comm comm) {
  return moved(at_equal_times(scene), formulation, std::nullopt, comm, accuracy, false).series;
}

}  // namespace floe::app
