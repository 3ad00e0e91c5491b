#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <map>

#include "choose.h"
#include "compare_table.h"
#include "discretisation.h"
#include "exact_motion.h"
#include "floe/assess/budget.h"
#include "floe/math/rounded.h"
#include "interruption.h"
#include "refined.h"

namespace floe::app {

namespace {

constexpr double impossible = std::numeric_limits<double>::infinity();
constexpr double of_discretisation = 2. / 3;  // of the accuracy, for frames, elements and strains
constexpr double most_seconds = 60;           // of one simulation in formulation cfr
constexpr double of_reference =
    0.7;  // of the accuracy: a reference with a larger error leaves too little to the models
constexpr double most_of_reference = 0.1;  // error of a reference by which models are selected
constexpr int most_frames = 16, most_times = 16, most_elements = 1000;
constexpr double most_work = 1e5;  // elements of plates times steps, of a simulation at full order: about 10 s

/// What is chosen before the reduced model: frames, elements, strains.
class TotalSearch {
  /// A full-order model that was simulated.
  struct Candidate {
    Discretisation bodies;
    double error;        // of the worst probe
    std::string failed;  // where the error is impossible: in words
  };

 public:
  TotalSearch(const scene::Scene& scene, double accuracy, MPI_Comm comm)
      : scene_(scene), asked_(accuracy), accuracy_(accuracy), comm_(comm), chosen_(discretisation_of(scene)) {}

  Chosen result() {
    exact_ = exact_motion(scene_, accuracy_, most_seconds, comm_);
    estimate_before();
    if (!exact_.none.empty()) return without_exact();
    decide("reference", fmt::format("cfr, {}steps {}", mesh_words(), step_words()),
           fmt::format("estimated error of the reference: {}", math::percent(exact_.error)));
    if (!(exact_.error <= of_reference * asked_)) {
      if (!(exact_.error <= most_of_reference)) return without_reference();
      accuracy_ = 2 * exact_.error;
      decisions_.back().reason +=
          fmt::format(", too large for the accuracy requested; models are selected for {}", math::percent(accuracy_));
    }
    if (full_order()) {
      lengthen_steps();
      choose_frames_and_elements();
      if (error_of(chosen_) == impossible) choose_elements();
    } else {
      choose_elements();
    }
    explain_discretisation();
    const scene::Scene scene = discretised(scene_, chosen_);
    Chosen chosen = choose_within(scene, accuracy_, comm_, {true, &exact_.series, exact_.error, exact_.of_step});
    if (chosen.supported <= asked_ || !(error_of_own() < chosen.supported)) return finished(std::move(chosen));
    for (std::size_t i = 1; i < decisions_.size(); ++i)  // after the reference
      decisions_[i].choice = "not used: " + decisions_[i].choice;
    return own_model(fmt::format("the selected model ({}; {}) has {}", words(chosen_), summary_of(chosen),
                                 math::percent(chosen.supported)));
  }

 private:
  void decide(std::string what, std::string choice, std::string reason) {
    decisions_.push_back({std::move(what), std::move(choice), std::move(reason)});
  }

  /// The budget of the scene's own model; without one the choice goes on.
  void estimate_before() {
    RunPlan plan;
    plan.quiet = true, plan.check_range = false, plan.estimate = true;
    plan.energies = plan.balance = false;
    plan.no_model = exact_.none;
    try {
      own_ = run(at_equal_times(scene_), scene::Formulation::vm_md, comm_, std::nullopt, plan);
      before_ = own_->summary["estimate"];
    } catch (const std::runtime_error& fault) {  // on all ranks
      if (Interruption::happened(comm_)) throw;
      const std::string text = fault.what();
      before_ = {{"none", text.substr(0, text.find('\n'))}};
    }
  }

  std::string mesh_words() const { return fmt::format("elements 1/{} as long, ", 1 << (exact_.of_mesh.size() - 1)); }
  std::string step_words() const { return fmt::format("1/{} as long, extrapolated", 1 << exact_.halved_steps); }

  /// Whether full-order models of all flexible bodies are cheap: lines, and plates of few elements.
  bool full_order() const {
    for (const scene::Body& body : scene_.bodies)
      if (!body.rigid && (!is_meshed(body) || body.mesh.file)) return false;
    return element_count(scene_, chosen_) <= most_elements && cheap(chosen_);
  }

  bool cheap(const Discretisation& bodies) const {
    if (std::none_of(scene_.bodies.begin(), scene_.bodies.end(),
                     [](const scene::Body& body) { return !body.rigid && body.mesh.plate; }))
      return true;
    return element_count(scene_, bodies) * scene_.motion.end / (times_ * scene_.motion.step) <= most_work;
  }

  /// Full-order models and the reference are compared in steps as long as their error may be half of the accuracy: the
  /// selected model is compared with the reference in fine steps.
  void lengthen_steps() {
    if (scene_.motion.tolerance) return;
    int times = 1;
    for (; times < 8 && 4 * times * times * exact_.of_step <= 0.5 * accuracy_; times *= 2)
      if (2 * times * scene_.motion.step > scene_.motion.end / 64) break;
    if (times == 1) return;
    try {
      exact_.in_own_steps = exact_in_steps(scene_, times, exact_, accuracy_, comm_);
      times_ = times;
    } catch (const std::runtime_error&) {  // on all ranks; the scene's own steps do
      if (Interruption::happened(comm_)) throw;
    }
  }

  /// Error of a full-order model, in the steps of exact_.in_own_steps.
  double error_of(const Discretisation& bodies) {
    for (const Candidate& known : tried_bodies_)
      if (known.bodies == bodies) return known.error;
    Candidate one{bodies, impossible, "fails (no finite numbers)"};
    try {
      if (!cheap(bodies))
        one.failed = "not simulated (too large)";
      else
        one.error = worst_error(
            quiet_motion(in_long_steps(discretised(scene_, bodies)), scene::Formulation::nlffr, accuracy_, comm_),
            exact_.in_own_steps);
    } catch (const std::runtime_error& fault) {  // on all ranks
      if (Interruption::happened(comm_)) throw;
      const std::string text = fault.what();
      one.failed = fmt::format(
          "fails ({})", text.substr(0, std::min({text.find(';'), text.find('\n'), text.find(" ("), text.size()})));
    }
    if (!std::isfinite(one.error)) one.error = impossible;
    tried_bodies_.push_back(one);
    return one.error;
  }

  scene::Scene in_long_steps(const scene::Scene& scene) const {
    scene::Scene other = at_equal_times(scene);
    other.motion.step *= times_;
    return other;
  }

  /// What `more` makes of the chosen bodies; where that model fails, what it makes of that, until nothing changes.
  template <class More>
  Discretisation first_that_moves(const More& more) {
    Discretisation one = more(chosen_);
    for (Discretisation next = more(one);
         !(one == chosen_) && error_of(one) == impossible && !(next == one) && cheap(next); next = more(one))
      one = next;
    return one;
  }

  /// Twice the elements; the same where a body has the most already.
  Discretisation with_elements(Discretisation bodies) const {
    if (std::any_of(bodies.begin(), bodies.end(), [](const Discretised& one) { return one.elements >= most_times; }))
      return bodies;
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (is_meshed(scene_.bodies[b])) bodies[b].elements *= 2;
    return bodies;
  }

  /// Twice the frames of one body, or of all (-1), with elements to divide; the same where there is nothing to divide.
  Discretisation with_frames(Discretisation bodies, int only) const {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if ((only >= 0 && static_cast<int>(b) != only) || !divisible(scene_.bodies[b])) continue;
      if (bodies[b].frames * 2 > most_frames) continue;
      bodies[b].frames *= 2;
      while (!fits(scene_.bodies[b], bodies[b]) && bodies[b].elements < most_times) ++bodies[b].elements;
      if (!fits(scene_.bodies[b], bodies[b])) bodies[b].frames /= 2;
    }
    return bodies;
  }

  Discretisation with_strains(Discretisation bodies, fem::Strains strains) const {
    if (scene_.dimension == 3)
      for (std::size_t b = 0; b < bodies.size(); ++b)
        if (is_meshed(scene_.bodies[b])) bodies[b].strains = strains;
    return bodies;
  }

  /// Error that frames, elements and strains may have: part of the accuracy, and of what the reference leaves of it.
  double of_discretisations() const {
    return std::min(of_discretisation * accuracy_, 0.9 * (0.9 * accuracy_ - exact_.error));
  }

  /// Each time what reduces the error most: frames, elements or strains.
  void choose_frames_and_elements() {
    const double wanted = of_discretisations();
    double error = error_of(chosen_);
    while (error > wanted) {
      Discretisation best = chosen_;
      double least = error;
      const std::vector<Discretisation> all = {
          first_that_moves([&](const Discretisation& bodies) { return with_frames(bodies, -1); }),
          with_strains(chosen_, fem::Strains::second_order),
          first_that_moves([&](const Discretisation& bodies) { return with_elements(bodies); })};
      for (const Discretisation& one : all)
        if (!(one == chosen_) && error_of(one) < least) best = one, least = error_of(one);
      if (best == chosen_ || least > 0.9 * error) break;
      chosen_ = best, error = least;
    }
    if (error <= wanted) reduce_frames(wanted);
  }

  /// Bodies that need no more frames than they had.
  void reduce_frames(double wanted) {
    if (scene_.bodies.size() == 1) return;
    for (std::size_t b = 0; b < chosen_.size(); ++b) {
      if (chosen_[b].frames == scene_.bodies[b].frames) continue;
      Discretisation less = chosen_;
      less[b].frames = scene_.bodies[b].frames;
      if (error_of(less) <= wanted) chosen_ = less;
    }
  }

  /// Where full order is expensive: elements by what meshes do to formulation cfr.
  void choose_elements() {
    const double wanted = of_discretisations();
    int halvings = 0;
    while (halvings + 1 < static_cast<int>(exact_.of_mesh.size()) && exact_.of_mesh[halvings] > wanted) ++halvings;
    for (std::size_t b = 0; b < chosen_.size(); ++b)
      if (is_meshed(scene_.bodies[b])) chosen_[b].elements = 1 << halvings;
    for (std::size_t h = 0; h < exact_.of_mesh.size(); ++h)
      tried_.push_back(fmt::format("{}: {}", h == 0 ? "as given" : fmt::format("{} times as many", 1 << h),
                                   math::percent(exact_.of_mesh[h])));
  }

  static std::string imported_words(int times) {
    return times == 1 ? "imported mesh" : fmt::format("imported mesh, elements 1/{} as long", times);
  }

  std::string words(const Discretisation& bodies) const {
    std::vector<std::string> all;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const scene::Body& body = scene_.bodies[b];
      if (!is_meshed(body)) continue;
      std::vector<int> counts = body.mesh.elements;
      if (body.mesh.plate) counts = {body.mesh.plate->elements[0], body.mesh.plate->elements[1]};
      for (int& count : counts) count *= bodies[b].elements;
      std::string one = scene_.bodies.size() > 1 ? body.name + ": " : "";
      one += body.mesh.file ? imported_words(bodies[b].elements)
                            : fmt::format("{} elements", fmt::join(counts, body.mesh.plate ? "x" : "+"));
      if (body.mesh.segments.size() == 1 || bodies[b].frames > 1)
        one += fmt::format(" in {} frame{}", bodies[b].frames, bodies[b].frames > 1 ? "s" : "");
      if (bodies[b].strains)
        one += *bodies[b].strains == fem::Strains::second_order ? ", strains second_order" : ", strains von_karman";
      all.push_back(one);
    }
    return fmt::format("{}", fmt::join(all, "; "));
  }

  void explain_discretisation() {
    for (const Candidate& one : tried_bodies_)
      tried_.push_back(
          fmt::format("{}: {}", words(one.bodies), std::isfinite(one.error) ? math::percent(one.error) : one.failed));
    const std::string choice = words(chosen_);
    if (!choice.empty())
      decide("mesh and frames", choice, fmt::format("full-order models: {}", fmt::join(tried_, "; ")));
    for (const scene::Body& body : scene_.bodies)
      if (is_meshed(body) && body.mesh.segments.size() == 1 && !divisible(body))
        decide("  " + body.name, fmt::format("{} frames", body.frames), "not divided: it has an interface");
  }

  /// Reduction, step and mesh alone: the mesh by the reduced model on finer ones.
  Chosen without_exact() {
    unbounded_.push_back({"model", exact_.none});
    double of_mesh = 0;
    if (std::any_of(scene_.bodies.begin(), scene_.bodies.end(), scene::is_meshed)) of_mesh = refine_mesh();
    const scene::Scene scene = discretised(scene_, chosen_);
    return finished(choose_within(scene, accuracy_, comm_, {true, nullptr, of_mesh, 0}));
  }

  /// Doubles elements until a third of the accuracy is left to the mesh. @return what is left
  double refine_mesh() {
    const double wanted = accuracy_ / 3;
    RunPlan plan;
    plan.quiet = true, plan.check_range = false;
    plan.energies = plan.balance = false;
    plan.newton_tolerance = 1e-5 * accuracy_;
    double left = 0;
    try {
      if (!own_) own_ = run(at_equal_times(scene_), scene::Formulation::vm_md, comm_, std::nullopt, plan);
      double took = own_->offline_seconds + own_->motion_seconds;  // in processor time, as of the motion
      if (own_->motion_seconds > 0 && own_->motion_processor > 0)
        took *= std::min(1., own_->motion_processor / own_->motion_seconds);
      RunResult coarse = std::move(*own_);
      for (int halving = 0; halving < 3; ++halving) {
        const Discretisation finer = with_elements(chosen_);
        MPI_Bcast(&took, 1, MPI_DOUBLE, 0, comm_);
        if (4 * took > most_seconds) {
          if (halving == 0)
            unbounded_.push_back({"mesh", fmt::format("the reduction of the refined mesh would take "
                                                      "about {:.2g} s (limit {:.2g} s)",
                                                      4 * took, most_seconds)});
          break;
        }
        const std::clock_t begin = std::clock();
        RunResult fine =
            run(at_equal_times(discretised(scene_, finer)), scene::Formulation::vm_md, comm_, std::nullopt, plan);
        took = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        const double change = worst_error(coarse.series, fine.series);
        left = 4. / 3 * change;
        tried_.push_back(fmt::format("{}: {}", words(chosen_), math::percent(left)));
        if (left <= wanted) break;
        chosen_ = finer, left = change / 3;
        coarse = std::move(fine);
        if (left <= wanted) break;
      }
    } catch (const std::runtime_error& fault) {  // on all ranks
      if (Interruption::happened(comm_)) throw;
      const std::string text = fault.what();
      unbounded_.push_back({"mesh", "on a finer mesh: " + text.substr(0, text.find('\n'))});
    }
    if (!tried_.empty())
      decide("elements", words(chosen_), fmt::format("error of the mesh, {}", fmt::join(tried_, "; ")));
    return left;
  }

  /// Of the scene's own model, to the end of the reference.
  double error_of_own() const {
    if (!own_ || std::abs(own_->series.t.back() - exact_.series.t.back()) > 2 * scene_.motion.step) return impossible;
    const double error = worst_error(own_->series, exact_.series) + exact_.error;
    return std::isfinite(error) ? error : impossible;
  }

  /// Where the reference has too large an error: the scene's own model, or what can be selected without a reference.
  Chosen without_reference() {
    const std::string why = fmt::format("the estimated error of the reference, {}, is above {}",
                                        math::percent(exact_.error), math::percent(most_of_reference));
    if (error_of_own() < impossible)
      return own_model(why +
                       ": no model is selected; take a smaller motion.step, or loads and drives that begin "
                       "smoothly");
    exact_.none = why;
    return without_exact();
  }

  /// The scene's own model.
  Chosen own_model(const std::string& why) {
    Chosen own;
    own.richest = exact_.error, own.supported = error_of_own();
    decide("model", "the scene's own", fmt::format("estimated error {}; {}", math::percent(own.supported), why));
    own.scene = at_equal_times(scene_);
    const std::clock_t begin = std::clock();
    own.model = assembly::build(own.scene, scene::Formulation::vm_md, comm_, true);
    own.building = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    return finished(std::move(own));
  }

  Chosen finished(Chosen chosen) {
    chosen.total = true, chosen.asked = asked_;
    chosen.unbounded.insert(chosen.unbounded.begin(), unbounded_.begin(), unbounded_.end());
    chosen.before = before_;
    chosen.decisions.insert(chosen.decisions.begin(), decisions_.begin(), decisions_.end());
    return chosen;
  }

  const scene::Scene& scene_;
  double asked_, accuracy_;  // as requested; what models are selected for
  MPI_Comm comm_;
  Discretisation chosen_;
  ExactMotion exact_;
  std::optional<RunResult> own_;  // of the scene's own model
  nlohmann::ordered_json before_;
  std::vector<Candidate> tried_bodies_;
  int times_ = 1;  // as long as the scene's are the steps of exact_.in_own_steps
  std::vector<std::string> tried_;
  std::vector<std::pair<std::string, std::string>> unbounded_;
  std::vector<Decision> decisions_;
};

}  // namespace

Chosen choose_total(const scene::Scene& scene, double accuracy, MPI_Comm comm) {
  return TotalSearch(scene, accuracy, comm).result();
}

}  // namespace floe::app
