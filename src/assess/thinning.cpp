#include "thinning.h"

#include <fmt/format.h>

#include "error_part.h"

namespace floe::assess {
namespace {

constexpr double min_step_seconds = 2e-6;  // processor time of a step of cfr or nlffr, for each element [s]

}  // namespace

std::string words(const Thinning& one) {
  if (one.mesh == 1) return "same mesh";
  return one.mesh < 1 ? "elements half as long" : fmt::format("elements {:g} times as long", one.mesh);
}

std::string step_words(double step) {
  if (step == 1) return "";
  return step < 1 ? fmt::format(", steps 1/{:g} as long", 1 / step) : fmt::format(", steps {:g} times as long", step);
}

bool ComparisonTime::can_scale(double mesh) const {
  Scene scaled = motion_.scene;
  return mesh == 1 || scale_meshes(scaled, 1 / mesh);
}

double ComparisonTime::least() const {
  int ranks = 1;
  MPI_Comm_size(motion_.comm, &ranks);
  return min_step_seconds * static_cast<double>(motion_.steps) * elements_of(*motion_.model.offline) / ranks;
}

double ComparisonTime::least_thinned() const {
  return least() / (can_lengthen(motion_) ? 4 : 1) / (any_shells(motion_.scene) ? 1 : 4);
}

double ComparisonTime::whole() const { return better_step * static_cast<double>(motion_.steps); }

double ComparisonTime::of(const Thinning& one) const {
  const double fewer = any_shells(motion_.scene) ? one.mesh * one.mesh : one.mesh;
  const double harder = one.step > 1 ? 1.5 : 1;  // long steps take more iterations
  return harder * (whole() / fewer + took_) / one.step + (one.mesh != 1 ? motion_.offline / fewer : 0);
}

std::vector<Thinning> ComparisonTime::all() const {
  std::vector<Thinning> found;
  for (const int mesh : any_shells(motion_.scene) ? std::vector<int>{1} : std::vector<int>{1, 2, 4})
    for (const int step : {1, 2, 4})
      if (mesh * step > 1 && can_scale(mesh) && (step == 1 || can_lengthen(motion_)))
        found.push_back({static_cast<double>(mesh), static_cast<double>(step)});
  return found;
}

}  // namespace floe::assess
