#include <fmt/format.h>

#include <algorithm>

#include "discretisation.h"
#include "floe/assess/budget.h"
#include "model_hierarchy.h"
#include "refined.h"

namespace floe::app {

using scene::Body;
using scene::Formulation;
using scene::Scene;
using Choice = scene::DerivativesSpec::Choice;

namespace {

constexpr int most_element_times = 8;  // elements, so that they can be divided among the frames

/// The scene in other frames or on another mesh; or why not.
struct Variant {
  std::string name;
  Scene scene;
  std::string impossible;
};

/// Plates are left out: of each model in several frames they take minutes.
bool in_other_frames(const Body& body) { return divisible(body) && !body.mesh.plate; }

/// How many times the elements so many frames need: two in each at least; 0: nothing that is tried fits.
int times_for(const Body& body, int frames) {
  for (int times = 1; times <= most_element_times; ++times)
    if (fits(body, {frames, times})) return times;
  return 0;
}

Variant in_frames(const Scene& scene, int frames) {
  Discretisation bodies = discretisation_of(scene);
  int most = 1;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!in_other_frames(scene.bodies[b])) continue;
    const int times = times_for(scene.bodies[b], frames);
    if (times == 0) continue;
    bodies[b].frames = frames, bodies[b].elements = times;
    most = std::max(most, times);
  }
  Variant variant{fmt::format("{} frame{}", frames, frames > 1 ? "s" : ""), scene, ""};
  if (most == 2) variant.name += ", twice the elements";
  if (most > 2) variant.name += fmt::format(", {} times the elements", most);
  try {
    variant.scene = at_equal_times(discretised(scene, bodies));
  } catch (const InputError& error) {
    variant.impossible = error.what();
  }
  return variant;
}

std::vector<Variant> in_all_frames(const Scene& scene) {
  std::vector<Variant> variants;
  const auto at = std::find_if(scene.bodies.begin(), scene.bodies.end(), in_other_frames);
  if (at == scene.bodies.end()) return variants;
  for (const int frames : {1, 2, 4, 8})
    if (frames != at->frames && times_for(*at, frames) > 0) variants.push_back(in_frames(scene, frames));
  return variants;
}

/// Elements twice as long, where their number can be divided, and half as long.
std::vector<Variant> on_other_meshes(const Scene& scene) {
  std::vector<Variant> variants;
  if (std::none_of(scene.bodies.begin(), scene.bodies.end(), scene::is_meshed)) return variants;
  for (const double factor : {0.5, 2.0}) {
    Variant variant{factor < 1 ? "half the elements" : "twice the elements", scene, ""};
    if (assess::scale_meshes(variant.scene, factor)) variants.push_back(std::move(variant));
  }
  return variants;
}

Scene in_longer_steps(const Scene& scene, int times) {
  Scene longer = scene;
  longer.motion.step *= times;
  return longer;
}

/// Whether all meshes are lines: the reduction of plates with strains of second order takes minutes.
bool of_lines_in_space(const Scene& scene) {
  return scene.dimension == 3 && std::all_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& body) {
           return !is_meshed(body) || (!body.mesh.plate && !body.mesh.file);
         });
}

void add_strains(const Scene& scene, std::vector<Candidate>& members) {
  if (!of_lines_in_space(scene)) return;
  for (const auto& [strains, name] : {std::pair{fem::Strains::von_karman, "strains von_karman"},
                                      std::pair{fem::Strains::second_order, "strains second_order"}}) {
    Scene other = scene;
    bool changes = false;
    for (Body& body : other.bodies)
      if (is_meshed(body) && body.strains != strains) body.strains = strains, changes = true;
    if (changes) members.push_back({"strains", name, other, Formulation::vm_md});
  }
}

}  // namespace

void add_discretisations(const Scene& scene, std::vector<Candidate>& members) {
  for (const Variant& variant : in_all_frames(scene)) {
    const auto add = [&](const std::string& more, const Scene& one) {
      members.push_back({"frames", variant.name + more, one, Formulation::vm_md, 0, variant.impossible});
    };
    add("", variant.scene);
    if (!variant.impossible.empty()) continue;
    for (const int m : {1, 2, 3})
      add(fmt::format(", {} mode{} + all MDs", m, m > 1 ? "s" : ""), with_modes(variant.scene, m, Choice::all));
    if (scene.motion.tolerance) continue;
    add(", step 4x", in_longer_steps(variant.scene, 4));
    add(", 1 mode + all MDs, step 4x", in_longer_steps(with_modes(variant.scene, 1, Choice::all), 4));
    add(", step 8x", in_longer_steps(variant.scene, 8));
  }
  for (const Variant& variant : on_other_meshes(scene))
    members.push_back({"mesh", variant.name, variant.scene, Formulation::vm_md});
  add_strains(scene, members);
}

void add_full_order(const Scene& scene, std::vector<Candidate>& members) {
  members.push_back({"full order", "nlffr", scene, Formulation::nlffr});
  members.push_back({"full order", "lffr", scene, Formulation::lffr});
  for (const Variant& variant : in_all_frames(scene))
    members.push_back(
        {"full order", "nlffr, " + variant.name, variant.scene, Formulation::nlffr, 0, variant.impossible});
  const std::vector<Variant> meshes = on_other_meshes(scene);
  for (const Variant& variant : meshes)
    members.push_back({"full order", "nlffr, " + variant.name, variant.scene, Formulation::nlffr});
  std::vector<int> steps = {2, 4, 8};
  if (scene.motion.tolerance) steps.clear();
  for (const int times : steps)
    members.push_back(
        {"full order", fmt::format("nlffr, step {}x", times), in_longer_steps(scene, times), Formulation::nlffr});
  members.push_back({"cfr", "cfr", scene, Formulation::cfr});
  for (const Variant& variant : meshes)
    members.push_back({"cfr", "cfr, " + variant.name, variant.scene, Formulation::cfr});
  for (const int times : steps)
    members.push_back({"cfr", fmt::format("cfr, step {}x", times), in_longer_steps(scene, times), Formulation::cfr});
}

}  // namespace floe::app
