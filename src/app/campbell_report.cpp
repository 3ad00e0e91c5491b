#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "campbell.h"
#include "floe/output/provenance.h"
#include "floe/output/summary.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

/// An exponent s that is real: a growth or a decay without oscillation.
bool is_real(const solve::Vibration& v) { return v.omega == 0 && !v.zero; }

}  // namespace

output::Table campbell_table(const CampbellDiagram& diagram) {
  output::Table table;
  table.columns = {{"speed", "rad/s", 6},     {"mode", ""},         {"track", ""}, {"frequency", "Hz", 6},
                   {"frequency", "rad/s", 6}, {"growth", "1/s", 4}, {"remark", ""}};
  for (const CampbellPoint& point : diagram.points) {
    const std::string empty;
    if (!point.fault.empty() || point.vibrations.empty())
      table.rows.push_back({point.speed, empty, empty, empty, empty, empty,
                            std::string(point.fault.empty() ? "no vibrations"
                                        : point.steady      ? "vibrations not found"
                                                            : "no steady rotation")});
    std::int64_t mode = 0;
    for (const TrackedVibration& v : point.vibrations)
      if (!is_real(v))
        table.rows.push_back({point.speed, ++mode, std::int64_t{v.track}, v.omega / (2 * M_PI), v.omega,
                              v.growth == 0 ? output::Cell(empty) : output::Cell(v.growth),
                              std::string(v.unstable() ? "unstable"
                                          : v.zero     ? fmt::format("rigid-body mode, or below {:.2g} rad/s", v.below)
                                                       : "")});
    for (const solve::Vibration& v : point.vibrations)
      if (is_real(v))
        table.rows.push_back({point.speed, empty, empty, empty, empty, v.growth,
                              std::string(v.unstable() ? "unstable, without oscillation" : "overdamped")});
  }
  return table;
}

ordered_json campbell_summary(const scene::Scene& scene, const CampbellDiagram& diagram, MPI_Comm comm) {
  ordered_json j;
  j["status"] = "finished";
  j["scene"] = {{"file", scene.file}, {"title", scene.title}};
  j["formulation"] = scene::name_of(diagram.model.formulation);
  j["label"] = diagram.label;
  j["provenance"] = output::provenance(comm);
  j["unknowns"] = {{"coordinates", diagram.model.coordinates}, {"multipliers", diagram.model.multipliers}};
  const Eigen::Vector3d &about = diagram.axis.direction, &through = diagram.axis.point;
  j["axis"] = {{"about", {about.x(), about.y(), about.z()}}, {"through", {through.x(), through.y(), through.z()}}};
  j["speeds"] = ordered_json::array();
  for (const CampbellPoint& point : diagram.points) {
    ordered_json at{{"rad_per_s", point.speed}, {"steady", point.steady}};
    if (const solve::BranchJump& jump = point.search.jump; jump.ratio > 0)
      at["jump"] = {{"from", jump.from}, {"to", jump.to}, {"ratio", jump.ratio}};
    if (point.search.other > 0) at["other_steady_rotation_rad"] = point.search.other;
    if (!point.fault.empty())
      at["reason"] = point.fault;
    else
      at["newton_iterations"] = point.iterations, at["vibrations"] = ordered_json::array();
    for (const TrackedVibration& v : point.vibrations) {
      if (is_real(v)) {
        at["real_exponents_per_s"].push_back(v.growth);
        continue;
      }
      at["vibrations"].push_back(
          {{"Hz", v.omega / (2 * M_PI)}, {"rad_per_s", v.omega}, {"growth_per_s", v.growth}, {"zero", v.zero}});
      at["vibrations"].back()["track"] = v.track;
      if (v.assurance > 0) at["vibrations"].back()["assurance"] = v.assurance;
      if (v.zero) at["vibrations"].back()["below_rad_per_s"] = v.below;
    }
    j["speeds"].push_back(at);
  }
  if (const CampbellEstimate& estimate = diagram.estimate; !estimate.errors.empty()) {
    j["estimate"] = {{"rad_per_s", estimate.speed},
                     {"by", estimate.full_order ? "nlffr" : "larger bases"},
                     {"coordinates", estimate.coordinates}};
    for (const FrequencyError& one : estimate.errors)
      j["estimate"]["frequencies"].push_back({{"track", one.track}, {"relative_error", one.relative}});
  } else if (!estimate.missing.empty()) {
    j["estimate"] = {{"rad_per_s", estimate.speed}, {"missing", estimate.missing}};
  }
  j["warnings"] = diagram.model.warnings;
  j["seconds"] = {{"offline", diagram.offline_seconds}, {"speeds", diagram.seconds}};
  return j;
}

namespace {

std::string words(const std::exception_ptr& fault) {
  try {
    std::rethrow_exception(fault);
  } catch (const std::exception& error) {
    return error.what();
  }
}

void write(const scene::Scene& scene, const CampbellDiagram& diagram, const std::string& stopped, MPI_Comm comm,
           const output::ResultFolder& folder) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  ordered_json summary = campbell_summary(scene, diagram, comm);
  if (!stopped.empty()) summary["status"] = "failed", summary["reason"] = stopped;
  output::remove_replaced(comm, folder);
  petsc::agree(comm, [&] {
    if (rank == 0) output::write_file_atomically(folder.path / "campbell.csv", output::to_csv(campbell_table(diagram)));
  });
  output::write_summary(comm, folder, summary);
}

/// Estimated errors of the frequencies, in one line; empty for a model that is not reduced.
std::string text_of(const CampbellEstimate& estimate) {
  if (!estimate.missing.empty())
    return fmt::format("Estimated error of the frequencies: none ({})\n", estimate.missing);
  std::string text;
  for (const FrequencyError& one : estimate.errors)
    text += fmt::format("{}{:.2g} % (track {})", text.empty() ? "" : ", ", 100 * one.relative, one.track);
  if (text.empty()) return text;
  const std::string by = estimate.full_order ? "the full-order model (nlffr)" : "a basis";
  return fmt::format("{} of the frequencies at {:.6g} rad/s, by {} of {} coordinates: {}\n",
                     estimate.full_order ? "Reduction error" : "Estimated reduction error", estimate.speed, by,
                     estimate.coordinates, text);
}

void show(const scene::Scene& scene, const CampbellDiagram& diagram, const output::ResultFolder& folder) {
  const auto tidy = [](double x) { return std::abs(x) < 1e-12 ? 0 : x; };  // -1.7e-18 for a place on the axis
  const Eigen::Vector3d about = diagram.axis.direction.unaryExpr(tidy), through = diagram.axis.point.unaryExpr(tidy);
  fmt::print("{} as {} ({}): {} coordinates, about ({:.4g}, {:.4g}, {:.4g}) through ({:.4g}, {:.4g}, {:.4g})\n",
             scene.title.empty() ? scene.file : scene.title, scene::name_of(diagram.model.formulation), diagram.label,
             diagram.model.coordinates, about.x(), about.y(), about.z(), through.x(), through.y(), through.z());
  fmt::print("offline {:.3g} s, {} speeds {:.3g} s\n\n", diagram.offline_seconds, diagram.points.size(),
             diagram.seconds);
  fmt::print("{}", output::to_text(campbell_table(diagram)));
  fmt::print("{}", text_of(diagram.estimate));
  for (const CampbellPoint& point : diagram.points)
    if (!point.fault.empty()) fmt::print("Note: {}\n", point.fault);
  for (const std::string& warning : diagram.model.warnings) fmt::print("Note: {}\n", warning);
  fmt::print("Results: {}\n", folder.path.string());
}

}  // namespace

void campbell_one(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm,
                  const CampbellRequest& request, const output::ResultFolder& folder) {
  std::exception_ptr fault;
  const CampbellDiagram diagram = [&] {
    try {
      return campbell(scene, formulation, comm, request, fault);
    } catch (const std::exception&) {
      output::discard_if_empty(folder);
      throw;
    }
  }();
  const auto steady = [](const CampbellPoint& point) { return point.fault.empty(); };
  if (!fault && std::none_of(diagram.points.begin(), diagram.points.end(), steady))
    fault = std::make_exception_ptr(RunError(diagram.points.front().fault));
  write(scene, diagram, fault ? words(fault) : "", comm, folder);
  if (fault) std::rethrow_exception(fault);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) show(scene, diagram, folder);
}

}  // namespace floe::app
