#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "commands.h"
#include "floe/assembly/body_stage.h"
#include "floe/assess/body_properties.h"
#include "floe/assess/check_modes.h"
#include "floe/output/table.h"
#include "floe/petsc/rank.h"
#include "notices.h"
#include "run_summary.h"

namespace floe::app {
namespace {

/// @param bound  "all ", or "up to " where `fields` is the most that there may be
std::string derivative_words(const scene::DerivativesSpec& spec, int fields, const std::string& bound) {
  using Choice = scene::DerivativesSpec::Choice;
  const std::string kind = spec.full ? "full" : "static";
  switch (spec.choice) {
    case Choice::none:
      return "no derivatives";
    case Choice::all:
      return fmt::format("{}{} {} derivatives of each pair", bound, fields * (fields + 1) / 2, kind);
    case Choice::count:
      return fmt::format("{} {} derivatives by modal interaction", spec.count, kind);
    default:
      return fmt::format("{} {} derivatives as listed", spec.pairs.size(), kind);
  }
}

/// Basis vectors of a body of strains of second order whose elastic force has so many products of coordinates that its
/// reduction takes more than about ten seconds. Empty: fewer, or the scene omits some.
std::string products_note(const scene::Body& body, const assess::AttachmentModes& attached, std::int64_t elements) {
  using Choice = scene::DerivativesSpec::Choice;
  constexpr std::int64_t many = 3000000;  // of all elements
  const scene::ReductionSpec& reduction = body.reduction;
  const std::int64_t fields = reduction.modes.count + attached.count, all = fields * (fields + 1) / 2;
  const std::int64_t vectors = fields + (reduction.derivatives.choice == Choice::all     ? all
                                         : reduction.derivatives.choice == Choice::count ? reduction.derivatives.count
                                         : reduction.derivatives.choice == Choice::none
                                             ? 0
                                             : static_cast<std::int64_t>(reduction.derivatives.pairs.size()));
  const std::int64_t products = vectors * (vectors + 1) / 2;
  if (products * elements <= many || reduction.products || !reduction.columns.empty()) return {};
  return fmt::format(
      "body {}: up to {} basis vectors, and {} products of them in its elastic force, which take most of the reduction "
      "and of a step; products: 3 % (reduction) omits those that hardly move the body, fewer modes or derivatives help",
      assembly::whole_name(body), vectors, products);
}

std::string reduced_words(const output::ReducedBodyFile& file, const std::string& path) {
  std::map<std::string, int> count;
  for (const output::ReducedColumn& column : file.columns) count[column.kind] += column.kept;
  std::vector<std::string> words;
  for (const char* kind : {"mode", "attachment", "derivative"})
    if (count[kind] > 0) words.push_back(fmt::format("{} {}{}", count[kind], kind, count[kind] > 1 ? "s" : ""));
  return fmt::format("{}, from {}", fmt::join(words, ", "), path);
}

std::string basis_words(const scene::Body& body, const assess::AttachmentModes& attached) {
  if (body.rigid) return "rigid";
  if (body.reduced) return reduced_words(*body.reduced->file, body.reduced->path);
  const scene::ModesSpec& modes = body.reduction.modes;
  return fmt::format(
      "{} modes ({}), {}{}", modes.count,
      modes.of == scene::ModesSpec::Of::joints ? "with its joints fixed" : "under its frame's conditions",
      attached.count > 0 ? fmt::format("{}{} attachment mode{}, ", attached.exact ? "" : "up to ", attached.count,
                                       attached.count > 1 ? "s" : "")
                         : "",
      derivative_words(body.reduction.derivatives, modes.count + attached.count,
                       attached.count == 0 || attached.exact ? "all " : "up to "));
}

/// From so many elements on, `check` does not build the full-order system: it would take seconds and gigabytes.
constexpr std::int64_t greatest_built = 20000;

std::int64_t elements_of(const scene::Body& body) {
  if (body.reduced) return body.reduced->file->cells;
  return std::accumulate(body.mesh.elements.begin(), body.mesh.elements.end(), std::int64_t{0});
}

/// Three at each node: of the points that segments join, and between the elements of each segment.
std::int64_t dofs_of(const scene::Body& body) {
  if (body.rigid) return 3;
  if (body.reduced) return body.reduced->file->dofs;
  std::set<int> points;
  for (const auto& segment : body.mesh.segments) points.insert(segment.begin(), segment.end());
  const std::int64_t ends = static_cast<std::int64_t>(points.size());
  return 3 * (ends + elements_of(body) - static_cast<std::int64_t>(body.mesh.segments.size()));
}

std::string frame_words(const scene::Body& body) {
  if (body.reduced) return body.reduced->file->frame.kind;
  switch (body.frame.kind) {
    case scene::FrameSpec::Kind::pinned:
      return "pinned";
    case scene::FrameSpec::Kind::clamped:
      return "clamped";
    default:
      return "mean-axis";
  }
}

struct Size {
  std::int64_t elements, dofs;
  std::string frame, strains = "von_karman";
  std::vector<std::string> notices = {};  ///< of its mesh
};

/// In the plane a scene says it all; in space meshes come from files, and frames from joints.
std::vector<Size> sizes_of(const scene::Scene& scene, const scene::Scene& split, MPI_Comm comm) {
  std::vector<Size> sizes;
  if (scene.dimension == 2)
    for (const scene::Body& body : split.bodies) sizes.push_back({elements_of(body), dofs_of(body), frame_words(body)});
  else
    for (const assembly::BodyReport& body : assembly::body_sizes(scene, comm))
      sizes.push_back({body.elements, body.dofs, body.frame, body.strains, body.notices});
  return sizes;
}

/// In which formulation `check` builds a scene: of the full-order model, or where bodies are from files, in the first
/// that has them.
scene::Formulation first_possible(const scene::Scene& scene) {
  const auto any = [&](const auto& is) { return std::any_of(scene.bodies.begin(), scene.bodies.end(), is); };
  return any([](const scene::Body& body) { return body.reduced.has_value(); }) ? scene::Formulation::lffr
                                                                               : scene::Formulation::nlffr;
}

/// 0 for what is round-off beside `scale`.
double cleaned(double value, double scale) { return std::abs(value) > 1e-12 * scale ? value : 0; }

/// Mass, centre of gravity, moments of inertia about it, and extent of each body.
void print_properties(const std::vector<assess::BodyProperties>& bodies, int dimension) {
  output::Table table, moments;
  table.columns = {{"body", ""}, {"mass", "kg", 7}};
  moments.columns = {{"inertia", ""}};
  const std::vector<const char*> axes =
      dimension == 2 ? std::vector<const char*>{"x", "y"} : std::vector<const char*>{"x", "y", "z"};
  for (const char* axis : axes) table.columns.push_back({fmt::format("centre {}", axis), "m", 7});
  for (const char* axis : axes) table.columns.push_back({fmt::format("extent {}", axis), "m", 7});
  if (dimension == 2) table.columns.push_back({"inertia", "kg m2", 7});
  constexpr std::pair<int, int> entries[] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (const auto& [i, j] : entries) moments.columns.push_back({fmt::format("{}{}", "xyz"[i], "xyz"[j]), "kg m2", 7});
  for (const assess::BodyProperties& body : bodies) {
    auto& row = table.rows.emplace_back(std::vector<output::Cell>{body.name, body.mass});
    const Eigen::Vector3d extent = body.box ? (body.box->high - body.box->low).eval() : Eigen::Vector3d::Zero().eval();
    const double length = std::max(extent.norm(), body.centre.norm());
    for (std::size_t i = 0; i < axes.size(); ++i) row.emplace_back(cleaned(body.centre[static_cast<int>(i)], length));
    for (std::size_t i = 0; i < axes.size(); ++i)
      row.push_back(body.box ? output::Cell(cleaned(extent[static_cast<int>(i)], length)) : output::Cell("-"));
    if (dimension == 2) row.emplace_back(body.inertia(2, 2));
    auto& other = moments.rows.emplace_back(std::vector<output::Cell>{body.name});
    for (const auto& [i, j] : entries) other.emplace_back(cleaned(body.inertia(i, j), body.inertia.norm()));
  }
  fmt::print("{}\n", output::to_text(table));
  if (dimension == 3) fmt::print("{}\n", output::to_text(moments));
}

/// Free of supports, and as the modes are constrained; bodies that cannot deform have none.
output::Table frequency_table(const std::vector<assess::BodyProperties>& bodies) {
  output::Table table;
  const bool constrained =
      std::any_of(bodies.begin(), bodies.end(), [](const auto& body) { return !body.constrained.empty(); });
  table.columns = {{"body", ""}, {"mode", ""}, {"free", "Hz", 7}};
  if (constrained) table.columns.push_back({"as held", "Hz", 7});
  const auto hertz = [](const std::vector<double>& omega, std::size_t i) {
    return i < omega.size() ? output::Cell(omega[i] / (2 * M_PI)) : output::Cell("-");
  };
  for (const assess::BodyProperties& body : bodies) {
    const std::size_t count = std::max(body.free.size(), body.constrained.size());
    if (count == 0) table.rows.emplace_back(std::vector<output::Cell>{body.name, "none", "-"});
    if (count == 0 && constrained) table.rows.back().emplace_back("-");
    for (std::size_t i = 0; i < count; ++i) {
      auto& row = table.rows.emplace_back(std::vector<output::Cell>{body.name, static_cast<std::int64_t>(i + 1)});
      row.push_back(hertz(body.free, i));
      if (constrained) row.push_back(hertz(body.constrained, i));
    }
  }
  return table;
}

}  // namespace

void check(const scene::Scene& scene, MPI_Comm comm, const std::optional<scene::Formulation>& wanted, int frequencies) {
  const scene::Scene split = plan::split_frames(scene, comm);
  const std::vector<Size> sizes = sizes_of(scene, split, comm);
  const std::vector<assess::AttachmentModes> attached = assess::check_modes(scene, comm);
  const std::vector<assess::BodyProperties> properties = assess::body_properties(scene, comm, frequencies);
  std::int64_t elements = 0;
  for (std::size_t b = 0; b < sizes.size(); ++b)
    if (!split.bodies[b].reduced) elements += sizes[b].elements;
  std::optional<assembly::Model> model;
  const scene::Formulation formulation = wanted ? *wanted : first_possible(scene);
  if (wanted || elements < greatest_built) model = assembly::build(scene, formulation, comm);
  if (!petsc::first_rank(comm)) return;
  output::Table table;
  table.columns = {{"body", ""},  {"elements", ""}, {"dofs", ""},
                   {"frame", ""}, {"strains", ""},  {"reduction (vm+md)", ""}};
  for (std::size_t b = 0; b < sizes.size(); ++b)
    table.rows.push_back({split.bodies[b].name, sizes[b].elements, sizes[b].dofs, sizes[b].frame, sizes[b].strains,
                          basis_words(split.bodies[b], attached[b])});
  fmt::print("{}{}\n\n{}\n", scene.file, scene.title.empty() ? "" : ": " + scene.title, output::to_text(table));
  print_properties(properties, scene.dimension);
  if (frequencies > 0) fmt::print("{}\n", output::to_text(frequency_table(properties)));
  fmt::print("{} joints, {} loads, {} probes; ", split.joints.size(), scene.loads.size(), scene.probes.size());
  if (model)
    fmt::print(
        "{} coordinates and {} multipliers {}\n", model->coordinates, model->multipliers,
        formulation == scene::Formulation::nlffr ? "of the full-order model" : "as " + scene::name_of(formulation));
  else
    fmt::print(
        "the full-order model is not built by this command from {} elements on (--formulation vm+md builds the reduced "
        "one)\n",
        greatest_built);
  const bool moves = scene.motion.end > 0;
  if (moves)
    fmt::print("simulation to t = {} s, ", scene.motion.end);
  else
    fmt::print(
        "no motion: sufficient for modes, reduce, static and campbell; run, compare, tradeoff and sweep need it\n");
  if (moves && scene.motion.tolerance)
    fmt::print("adaptive steps with tolerance {}, the first of {} s\n", *scene.motion.tolerance, scene.motion.step);
  else if (moves)
    fmt::print("{} steps of {} s\n", std::llround(scene.motion.end / scene.motion.step), scene.motion.step);
  std::vector<std::string> notes = notices_of(sizes);
  for (std::size_t b = 0; b < sizes.size(); ++b)
    if (const std::string note = products_note(split.bodies[b], attached[b], sizes[b].elements);
        sizes[b].strains.rfind("second_order", 0) == 0 && !note.empty())
      notes.push_back(note);
  if (model)
    for (const std::string& warning : model->warnings)
      if (std::find(notes.begin(), notes.end(), warning) == notes.end()) notes.push_back(warning);
  if (const std::string changed = model ? changed_start(scene, *model) : ""; !changed.empty()) notes.push_back(changed);
  for (const std::string& note : notes) fmt::print("Note: {}\n", note);
}

}  // namespace floe::app
