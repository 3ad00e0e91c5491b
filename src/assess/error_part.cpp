#include "error_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimate_parts.h"
#include "floe/assess/probe_errors.h"

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

}  // namespace

void set_errors(const ProbeSeries& own, const Simulated& other, const Simulated& one, double weight,
                const std::vector<std::vector<double>>& less, ErrorPart& part) {
  const std::vector<int> theirs = places_of(own.columns, other.columns), ours = places_of(own.columns, one.columns);
  const std::size_t count = std::min({own.t.size(), other.values.size(), one.values.size()});
  ProbeErrors errors(own.columns);
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> row(own.columns.size(), unknown);
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (theirs[c] < 0 || ours[c] < 0) continue;
      row[c] = weight * (other.values[i][theirs[c]] - one.values[i][ours[c]]);
      if (i < less.size()) row[c] -= less[i][c];
    }
    errors.add(row, own.values[i]);
    part.t.push_back(own.t[i]);
    part.errors.push_back(std::move(row));
  }
  if (count == 0) return;
  part.until = part.t.back();
  part.probes = errors.relative(part.until - part.t.front());
  for (double& error : part.probes)
    if (error > 100) error = std::numeric_limits<double>::infinity();
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string too_long(double limit) { return fmt::format("ended after {:.2g} s", limit); }

Simulated again(const FinishedMotion& motion, const ProbeSeries& own, double times, double end) {
  solve::Integration how = motion.how;
  how.step *= times, how.end = end;
  const petsc::VecHandle A = motion.model.system->create_vector();
  solve::set_state(*motion.model.system, motion.start.state, motion.model.U, motion.model.V, A);
  motion.model.system->load(motion.start.carried);
  return {own.columns, probe_history(motion.scene, motion.model, how, own.t).values};
}

MPI_Comm comm_of_others(const FinishedMotion& motion) {
  constexpr PetscInt most_alone = 2000;
  return elements_of(*motion.model.offline) <= most_alone ? PETSC_COMM_SELF : motion.comm;
}

std::vector<std::string> meshed_bodies(const Scene& scene, bool imported) {
  std::vector<std::string> names;
  for (const Body& body : scene.bodies)
    if (!body.rigid && !body.reduced && body.mesh.file.has_value() == imported) names.push_back(body.name);
  return names;
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
    for (int& elements : body.mesh.elements) scale(elements);
    if (body.mesh.plate)
      for (int& elements : body.mesh.plate->elements) scale(elements);
  }
  return divided;
}

}  // namespace floe::assess
