#include "model_hierarchy.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "refined.h"

namespace floe::app {

using scene::Body;
using scene::Formulation;
using scene::Scene;
using Choice = scene::DerivativesSpec::Choice;

namespace {

constexpr int most_columns = 60;   // of a body with all derivatives
constexpr double products = 0.03;  // of the displacement, that omitted products may make up

/// The scene with something else about its flexible bodies.
template <class Change>
Scene changed(Scene scene, Change&& change) {
  for (Body& body : scene.bodies)
    if (is_meshed(body)) change(body);
  return scene;
}

}  // namespace

Scene with_modes(const Scene& scene, int m, Choice derivatives, int count) {
  return changed(scene, [&](Body& body) {
    body.reduction.modes.count = m;
    body.reduction.modes.alone = m;
    body.reduction.modes.given = true;
    body.reduction.derivatives.choice = derivatives;
    body.reduction.derivatives.count = count;
    body.reduction.derivatives.pairs.clear();
    body.reduction.columns.clear();
  });
}

namespace {

/// The greatest number of modes that any body asks for.
int greatest_modes(const Scene& scene) {
  int most = 0;
  for (const Body& body : scene.bodies)
    if (is_meshed(body)) most = std::max({most, body.reduction.modes.count, body.reduction.modes.alone});
  return most;
}

std::set<int> counts(int most) {
  std::set<int> all = {most};
  for (const int m : {1, 2, 3, 5, 8, 12})
    if (m < most) all.insert(m);
  return all;
}

std::string modes_word(int m) { return fmt::format("{} mode{}", m, m == 1 ? "" : "s"); }

void add_models(const Scene& scene, std::vector<Candidate>& members) {
  const int most = greatest_modes(scene);
  if (most == 0) return;
  for (const int m : counts(most))
    members.push_back({"modes", modes_word(m), with_modes(scene, m, Choice::none), Formulation::vm});
  for (const int m : counts(std::min(most, 8)))
    if (m + m * (m + 1) / 2 <= most_columns)
      members.push_back({"modes and derivatives", modes_word(m) + " + all MDs", with_modes(scene, m, Choice::all),
                         Formulation::vm_md});
  const int m = std::min(most, 6);
  for (const int s : {2, 4, 8, 12})
    if (s < m * (m + 1) / 2)
      members.push_back({"modes and derivatives", fmt::format("{} + {} MDs", modes_word(m), s),
                         with_modes(scene, m, Choice::count, s), Formulation::vm_md});
}

void add_attachments(const Scene& scene, std::vector<Candidate>& members) {
  using Attachment = scene::ReductionSpec::Attachment;
  const struct {
    Attachment choice;
    const char* name;
  } all[] = {{Attachment::none, "no attachment modes"},
             {Attachment::joints, "attachment modes at joints"},
             {Attachment::all, "attachment modes at joints and loads"}};
  for (const auto& [kind, name] : all) {
    if (std::none_of(scene.bodies.begin(), scene.bodies.end(),
                     [kind = kind](const Body& body) { return is_meshed(body) && body.reduction.attachment != kind; }))
      continue;
    members.push_back({"attachment modes", name,
                       changed(scene, [kind = kind](Body& body) { body.reduction.attachment = kind; }),
                       Formulation::vm_md});
  }
}

/// Few modes with all their derivatives, and residual responses; the scene's own basis with some.
void add_responses(const Scene& scene, std::vector<Candidate>& members) {
  const auto with = [](const Scene& one, int count) {
    return changed(one, [&](Body& body) { body.reduction.responses = count; });
  };
  for (const auto& [m, count] : {std::pair{1, 4}, {2, 8}, {3, 12}})
    members.push_back({"residual responses", fmt::format("{} + all MDs + {} responses", modes_word(m), count),
                       with(with_modes(scene, m, Choice::all), count), Formulation::vm_md});
  members.push_back({"residual responses", "the scene's own + 8 responses", with(scene, 8), Formulation::vm_md});
}

void add_forces(const Scene& scene, std::vector<Candidate>& members) {
  members.push_back({"elastic force", "linear elastic force",
                     changed(scene, [](Body& body) { body.reduction.linear = true; }), Formulation::vm_md});
  const auto omits = [](const Body& body) { return is_meshed(body) && body.reduction.products.value_or(0) > 0; };
  const bool some = std::any_of(scene.bodies.begin(), scene.bodies.end(), omits);
  members.push_back({"elastic force", some ? "all products" : fmt::format("products {:g} %", 100 * products),
                     changed(scene, [&](Body& body) { body.reduction.products = some ? 0 : products; }),
                     Formulation::vm_md});
}

void add_steps(const Scene& scene, std::vector<Candidate>& members) {
  if (!scene.motion.tolerance)
    for (const int times : {2, 4, 8}) {
      Scene longer = scene;
      longer.motion.step *= times;
      members.push_back({"step", fmt::format("step {}x", times), longer, Formulation::vm_md});
    }
  for (const double tolerance : {1e-3, 1e-5}) {
    Scene adaptive = scene;
    adaptive.motion.tolerance = tolerance;
    members.push_back({"step", fmt::format("adaptive, {:.0e}", tolerance), adaptive, Formulation::vm_md});
  }
  for (const double radius : {0.0, 0.9}) {
    Scene other = scene;
    other.motion.spectral_radius = radius;
    members.push_back({"integrator", fmt::format("spectral radius {}", radius), other, Formulation::vm_md});
  }
}

void add_selected(const Scene& scene, std::vector<Candidate>& members) {
  Scene any = scene;
  any.motion.tolerance.reset();
  for (const double accuracy : {0.05, 0.01, 0.002})
    members.push_back(
        {"accuracy", fmt::format("selected for {:g} %", 100 * accuracy), any, Formulation::vm_md, accuracy});
}

}  // namespace

std::vector<Candidate> hierarchy(const Scene& as_written) {
  const Scene scene = at_equal_times(as_written);
  std::vector<Candidate> members;
  const bool flexible = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return !b.rigid; });
  members.push_back({"scene", "the scene's own model", scene, Formulation::vm_md});
  if (!flexible) return members;
  members.push_back({"rigid", "rigid bodies", changed(scene, [](Body& body) { body.rigid = true; }), Formulation::vm});
  add_models(scene, members);
  add_attachments(scene, members);
  add_responses(scene, members);
  add_forces(scene, members);
  add_discretisations(scene, members);
  add_steps(scene, members);
  add_full_order(scene, members);
  add_selected(scene, members);
  return members;
}

}  // namespace floe::app
