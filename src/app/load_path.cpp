#include "load_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "floe/output/progress.h"
#include "floe/solve/branch.h"
#include "floe/solve/path.h"
#include "floe/solve/start.h"
#include "interruption.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

/// Limit points, bifurcations and unstable directions of a path: summary and warnings.
class PathReport {
 public:
  PathReport(const assembly::Model& model, RunResult& result) : model_(model), result_(result) {
    json() = {{"limit_points", ordered_json::array()},
              {"bifurcations", ordered_json::array()},
              {"unstable_directions", ordered_json::array()}};
  }

  void add(double t, Vec U, solve::PathPoint::Limit kind) {
    using Limit = solve::PathPoint::Limit;
    const bool limit = kind == Limit::at;
    if (kind == Limit::within) ++limits_, ++within_;
    // At a limit point one direction has no stiffness: the sign of its eigenvalue is round-off.
    const std::optional<int> unstable =
        limit ? std::nullopt : solve::unstable_directions(*model_.system, t, U, model_.V);
    json()["unstable_directions"].push_back(unstable ? ordered_json(*unstable) : ordered_json());
    ++points_, unstable_ += unstable.value_or(0) > 0, unknown_ += !limit && !unstable;
    if (unstable_ == 1 && unstable.value_or(0) > 0) first_unstable_ = t;
    if (limit) {
      add_limit(t, U);
      ++limits_;
    } else {
      if (unstable && last_) compare(t, *unstable);
      if (unstable) last_ = unstable, limits_ = 0, t_ = t;
    }
  }

  /// Warnings of limit points, unstable points and bifurcations.
  void describe() {
    constexpr std::size_t most = 6;
    const std::size_t count = limits_met_.size();
    const std::vector<std::string> some(limits_met_.begin(), limits_met_.begin() + std::min(most, count));
    if (count > 0)
      result_.warnings.push_back(fmt::format(
          "limit points at t = {}{}: where a load goes beyond one the structure snaps to another equilibrium",
          fmt::join(some, ", "), count > most ? fmt::format(" and {} more (summary.json)", count - most) : ""));
    if (within_ > 0)
      result_.warnings.push_back(fmt::format(
          "{} limit point{} of the path not located, because Newton's method fails next to {}; take more --steps",
          within_, within_ == 1 ? " is" : "s are", within_ == 1 ? "it" : "them"));
    if (unstable_ > 0)
      result_.warnings.push_back(
          fmt::format("{} of the {} points of the path are unstable equilibria, the first at t = {:.6g} "
                      "(path.unstable_directions of summary.json): under constant loads the structure leaves them",
                      unstable_, points_, first_unstable_));
    if (unknown_ > 0)
      result_.warnings.push_back(fmt::format(
          "stability is not determined at {} of the {} points of the path: the tangent stiffness is not symmetric "
          "(follower forces, pressures, moments) or is singular there; bifurcations at these points are not found",
          unknown_, points_));
    const ordered_json& all = json()["bifurcations"];
    if (all.empty()) return;
    result_.warnings.push_back(fmt::format(
        "the path passes {} between t = {:.6g} and t = {:.6g} ({} unstable directions before, {} after): the branches "
        "that cross it there are not followed; a small imperfection of loads or shape leads to them",
        all.size() == 1 ? "a bifurcation" : fmt::format("{} bifurcations, the first", all.size()),
        all[0]["from"].get<double>(), all[0]["to"].get<double>(), all[0]["before"].get<int>(),
        all[0]["after"].get<int>()));
  }

  void conclude(const solve::PathEnd& end, const LoadSteps& load, double t) {
    json()["at_end"] = end.at_end;
    if (end.closed)
      result_.warnings.push_back(
          fmt::format("the path of equilibria is closed: after {} points it returns to the limit point at t = "
                      "{:.6g}; it does not reach t = {:.6g}",
                      end.points, t, load.at));
    else if (!end.at_end)
      result_.warnings.push_back(
          fmt::format("the path of equilibria ends at t = {:.6g}, not at t = {:.6g}, after {} "
                      "points (--points)",
                      t, load.at, end.points));
  }

 private:
  ordered_json& json() { return result_.summary["path"]; }

  void add_limit(double t, Vec U) {
    ordered_json point{{"t", t}, {"probes", ordered_json::object()}};
    const std::vector<double> values = assembly::probe_values(model_, t, U, model_.V, model_.V);
    for (std::size_t i = 0; i < values.size(); ++i) point["probes"][result_.series.columns[i].name] = values[i];
    json()["limit_points"].push_back(point);
    const auto most =
        std::max_element(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    limits_met_.push_back(values.empty() ? fmt::format("{:.6g}", t)
                                         : fmt::format("{:.6g} ({} = {:.6g})", t,
                                                       result_.series.columns[most - values.begin()].name, *most));
  }

  /// A limit point changes the number of unstable directions by one.
  void compare(double t, int unstable) {
    if (std::abs(unstable - *last_) == limits_ || (limits_ > 1 && (unstable - *last_ - limits_) % 2 == 0)) return;
    json()["bifurcations"].push_back({{"from", t_}, {"to", t}, {"before", *last_}, {"after", unstable}});
  }

  const assembly::Model& model_;
  RunResult& result_;
  std::vector<std::string> limits_met_;
  std::optional<int> last_;
  int limits_ = 0;                               // since then
  int within_ = 0;                               // limit points that are not located
  int points_ = 0, unstable_ = 0, unknown_ = 0;  // unknown: no limit point, and no count of unstable directions
  double first_unstable_ = 0;
  double t_ = 0;
};

}  // namespace

void follow_load_path(const assembly::Model& model, const LoadSteps& load, bool begun, Recorder& recorder,
                      assess::KeptMotion& kept, solve::IntegrationReport& report, RunResult& result) {
  const Interruption interruption;
  const double first = load.at / load.steps;
  output::Progress progress(recorder.comm(), 0, load.at);
  PathReport found(model, result);
  const auto observe = [&](const solve::PathPoint& point, Vec U) {
    report.steps = point.number, report.end = point.t;
    found.add(point.t, U, point.limit);
    recorder.observe({point.t, point.number, U, model.V, nullptr, point.last, nullptr, nullptr, true});
    kept.keep({point.t, point.number, U, model.V, model.V, point.last});
    progress.update(point.t, point.number);
    interruption.check(recorder.comm());
  };
  double t = 0;
  int number = 0;
  if (begun) {
    found.add(0, model.U, solve::PathPoint::Limit::none);
  } else {
    report.newton += solve::follow_equilibrium(*model.system, 0, first, load.at / 1000, model.U, model.V,
                                               [](const solve::BranchJump&, Vec, Vec) {});
    t = first, number = 1;
    observe({1, t, solve::PathPoint::Limit::none, load.steps == 1 || load.points == 1}, model.U);
  }
  solve::PathEnd end;
  try {
    end = solve::follow_path(*model.system, t, {first, load.at, load.points, number}, model.U, model.V, observe);
  } catch (...) {  // what was found until then
    found.describe();
    throw;
  }
  report.newton += end.iterations;
  found.describe();
  found.conclude(end, load, report.end);
}

}  // namespace floe::app
