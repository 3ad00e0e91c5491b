#include "stress.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <set>

#include "floe/assess/stress_fields.h"
#include "floe/error.h"
#include "floe/output/folder.h"
#include "floe/output/progress.h"
#include "floe/output/series_file.h"
#include "floe/output/table.h"
#include "floe/petsc/error.h"
#include "floe/petsc/rank.h"
#include "floe/scene/scene.h"
#include "stress_extremes.h"

namespace floe::app {
namespace {

using assess::BodyStress;
using fem::SmallRows;

/// The scene of the run, as it was then.
scene::Scene scene_of(const StressRequest& request, const output::NodeMotion& motion) {
  const std::string path = request.scene.empty() ? motion.scene_file() : request.scene;
  if (request.scene.empty() && !std::filesystem::exists(path))
    throw InputError(fmt::format("stress '{}': scene {} of the run is not there; expected it, or --scene FILE",
                                 request.folder, path));
  scene::Scene scene = scene::read_scene(path);
  if (request.scene.empty() && scene.text != motion.scene_text())
    throw InputError(fmt::format("stress '{}': scene {} has changed since the run; expected the same, or --scene FILE",
                                 request.folder, path));
  return scene;
}

/// Rows of the instants nearest to those that are asked for, or at equal distances; empty: neither.
std::vector<std::size_t> chosen_rows(const StressRequest& request, const std::vector<double>& times) {
  std::set<std::size_t> rows;
  std::vector<double> wanted = request.at;
  for (int f = 0; f < request.frames; ++f)
    wanted.push_back(times.front() + (times.back() - times.front()) * f / std::max(1, request.frames - 1));
  const double slack = 1e-9 * std::max(std::abs(times.front()), std::abs(times.back()));
  for (const double t : wanted) {
    if (!(t >= times.front() - slack && t <= times.back() + slack))
      throw InputError(
          fmt::format("--at {}: is not within the simulation; expected {} to {} s", t, times.front(), times.back()));
    const auto after = std::lower_bound(times.begin(), times.end(), t);
    auto row = static_cast<std::size_t>(std::min<std::ptrdiff_t>(after - times.begin(), std::ssize(times) - 1));
    if (row > 0 && t - times[row - 1] < times[row] - t) --row;
    rows.insert(row);
  }
  return {rows.begin(), rows.end()};
}

/// A body, its stresses and what is known of them.
struct Recovered {
  std::string name;
  std::unique_ptr<BodyStress> stress;
  Extremes extremes;
  std::vector<char> watched = {};  ///< of its cells: which have a history
};

/// Fields at some rows, of all cells, in groups that fit into memory.
class Frames {
 public:
  Frames(const BodyStress& stress, std::vector<std::size_t> rows) : stress_(stress), rows_(std::move(rows)) {}
  std::vector<double> values(std::size_t frame) {
    const auto cells = static_cast<Eigen::Index>(stress_.cells().size()), width = Eigen::Index{stress_.width()};
    if (frame < first_ || frame >= first_ + kept_.size()) {
      constexpr std::size_t most = std::size_t{1} << 26;  // numbers
      const std::size_t each = std::max<std::size_t>(1, static_cast<std::size_t>(cells * width));
      first_ = frame;
      std::size_t count = std::min(rows_.size() - frame, std::max<std::size_t>(1, most / each));
      MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_UINT64_T, MPI_MIN, PETSC_COMM_WORLD);
      kept_.assign(count, std::vector<double>(each * static_cast<std::size_t>(cells > 0)));
      stress_.evaluate({rows_.data() + frame, count}, [&](std::size_t cell, std::size_t at, const SmallRows& values) {
        for (Eigen::Index t = 0; t < values.cols(); ++t)
          Eigen::Map<Eigen::VectorXd>(
              kept_[at + static_cast<std::size_t>(t)].data() + static_cast<std::ptrdiff_t>(cell) * width, width) =
              values.col(t);
      });
    }
    return kept_[frame - first_];
  }

 private:
  const BodyStress& stress_;
  std::vector<std::size_t> rows_;
  std::size_t first_ = 0;
  std::vector<std::vector<double>> kept_;
};

/// The cell of all ranks whose middle is nearest to a point. Collective. @return  among this rank's; -1: another has it
std::ptrdiff_t nearest_cell(const BodyStress& stress, const Eigen::Vector3d& x, MPI_Comm comm) {
  struct {
    double distance;
    int rank;
  } best{1e300, petsc::rank_of(comm)}, all;
  std::ptrdiff_t found = -1;
  for (std::size_t c = 0; c < stress.centres().size(); ++c)
    if (const double d = (stress.centres()[c] - x).norm(); d < best.distance * (1 - 1e-9))
      best.distance = d, found = static_cast<std::ptrdiff_t>(c);
  MPI_Allreduce(&best, &all, 1, MPI_DOUBLE_INT, MPI_MINLOC, comm);
  return all.rank == best.rank ? found : -1;
}

/// `BODY:x,y,z`.
std::pair<std::string, Eigen::Vector3d> place_of(const std::string& word, const std::vector<Recovered>& bodies) {
  const auto colon = word.rfind(':');
  const std::string name = word.substr(0, colon);
  std::vector<std::string> names;
  for (const Recovered& body : bodies) names.push_back(body.name);
  if (colon == std::string::npos || std::find(names.begin(), names.end(), name) == names.end())
    throw InputError(fmt::format("--history {}: names no body with stresses; expected BODY:X,Y,Z with one of {}", word,
                                 fmt::join(names, ", ")));
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  std::size_t at = colon + 1;
  for (int i = 0; i < 3; ++i) {
    char* end = nullptr;
    x[i] = std::strtod(word.c_str() + at, &end);
    const auto behind = static_cast<std::size_t>(end - word.c_str());
    const bool last = behind == word.size();
    if (behind == at || !std::isfinite(x[i]) || (!last && word[behind] != ',') || (last && i < 1))
      throw InputError(fmt::format("--history {}: expected BODY:X,Y,Z, coordinates in the axes of its mesh", word));
    if (last) return {name, x};
    at = behind + 1;
  }
  throw InputError(fmt::format("--history {}: has more than three coordinates", word));
}

/// A place with a history.
struct Watched {
  std::size_t body;
  std::ptrdiff_t cell;  ///< of this rank; -1: of another
};

std::vector<output::SeriesColumn> columns_of(const std::string& prefix, const BodyStress& stress) {
  std::vector<output::SeriesColumn> columns;
  for (const output::CellField& field : stress.fields()) {
    if (field.width == 1) {
      columns.push_back({fmt::format("{}.{}", prefix, field.name), field.unit});
      continue;
    }
    const bool force = field.name == "section_force", moment = field.name.starts_with("section_moment");
    const std::array<const char*, 3> parts = force    ? std::array{"N", "Vy", "Vz"}
                                             : moment ? std::array{"T", "My", "Mz"}
                                                      : std::array{"xx", "yy", "xy"};
    for (const char* part : parts) columns.push_back({fmt::format("{}.{}.{}", prefix, field.name, part), field.unit});
  }
  return columns;
}

void write_histories(const std::vector<Recovered>& bodies, const std::vector<Watched>& watched,
                     const std::vector<double>& times, const std::filesystem::path& path, MPI_Comm comm) {
  std::vector<std::size_t> rows(times.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::vector<output::SeriesColumn> columns;
  std::vector<int> starts;
  for (std::size_t w = 0; w < watched.size(); ++w) {
    const Recovered& body = bodies[watched[w].body];
    starts.push_back(static_cast<int>(columns.size()));
    const auto own = columns_of(fmt::format("{}.{}", body.name, w + 1), *body.stress);
    columns.insert(columns.end(), own.begin(), own.end());
  }
  const auto width = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(width, static_cast<Eigen::Index>(times.size()));
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::vector<char> wanted(bodies[b].stress->cells().size(), 0);
    for (const Watched& one : watched)
      if (one.body == b && one.cell >= 0) wanted[static_cast<std::size_t>(one.cell)] = 1;
    bodies[b].stress->evaluate(
        rows,
        [&](std::size_t cell, std::size_t first, const SmallRows& values) {
          for (std::size_t w = 0; w < watched.size(); ++w)
            if (watched[w].body == b && watched[w].cell == static_cast<std::ptrdiff_t>(cell))
              all.block(starts[w], static_cast<Eigen::Index>(first), values.rows(), values.cols()) = values;
        },
        &wanted);
  }
  MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, comm);
  output::SeriesFile file(comm, path, columns);
  petsc::agree(comm, [&] {
    for (std::size_t i = 0; i < times.size(); ++i)
      file.row(times[i], {all.data() + static_cast<std::ptrdiff_t>(i) * width, static_cast<std::size_t>(width)});
  });
  file.finish();
}

/// A scene and its plan, which refers to it.
struct Planned {
  scene::Scene scene;
  plan::Plan plan;
  Planned(scene::Scene of, MPI_Comm comm) : scene(std::move(of)), plan(plan::prepare(scene, comm)) {}
  Planned(const Planned&) = delete;
  Planned& operator=(const Planned&) = delete;
};

/// What bodies from files were reduced from, by their names.
using Sources = std::map<std::string, std::unique_ptr<Planned>>;

Sources sources_of(const StressRequest& request, const plan::Plan& plan, MPI_Comm comm) {
  Sources sources;
  for (const std::string& word : request.sources) {
    const auto colon = word.find(':');
    const std::string name = word.substr(0, colon);
    scene::Scene scene;
    petsc::agree(comm, [&] {
      std::vector<std::string> names;
      for (const plan::PlannedBody& body : plan.bodies)
        if (body.spec.reduced) names.push_back(body.spec.name);
      if (colon == std::string::npos || std::find(names.begin(), names.end(), name) == names.end())
        throw InputError(fmt::format("--source {}: names no body from a file; expected BODY:SCENE.yaml{}", word,
                                     names.empty() ? "" : fmt::format(" with one of {}", fmt::join(names, ", "))));
      scene = scene::read_scene(word.substr(colon + 1));
    });
    sources[name] = std::make_unique<Planned>(std::move(scene), comm);
  }
  return sources;
}

/// The body that a file was made from: of its name there, or the only one with elements. @throws InputError
int body_in(const plan::Plan& source, const plan::PlannedBody& from) {
  std::vector<int> all;
  for (std::size_t b = 0; b < source.bodies.size(); ++b) {
    const scene::Body& spec = source.bodies[b].spec;
    if (spec.rigid || spec.reduced) continue;
    all.push_back(static_cast<int>(b));
    if (spec.name == from.spec.reduced->file->name) return all.back();
  }
  if (all.size() == 1) return all.front();
  throw InputError(fmt::format("--source: {} has {} flexible bodies, and none is called {}", source.scene.file,
                               all.size(), from.spec.reduced->file->name));
}

/// Whether beams in space have fibres without W, as sections given by constants have.
bool lacks_torsion(const plan::Plan& plan, const plan::PlannedBody& body) {
  return plan.scene.dimension == 3 &&
         std::any_of(body.points.begin(), body.points.end(), [](const fem::StressPoints& points) {
           return (!points.fibres.empty() || points.radius > 0) && points.W == 0;
         });
}

/// How many elements of beams and shells have no stresses, and how many there are. Collective.
std::array<long long, 2> without_stresses(const plan::PlannedBody& body) {
  std::array<long long, 2> counts{0, 0};
  for (const fem::Mesh::Cell& cell : body.structure.mesh.cells) {
    const fem::Section& section = body.structure.sections[cell.part];
    if (std::holds_alternative<fem::PointMass>(section) || std::holds_alternative<fem::NodeSpring>(section)) continue;
    ++counts[1];
    if (!body.points[cell.part].known()) ++counts[0];
  }
  petsc::check(MPI_Allreduce(MPI_IN_PLACE, counts.data(), 2, MPI_LONG_LONG, MPI_SUM, body.structure.mesh.comm));
  return counts;
}

/// All flexible bodies whose elements are known. Collective.
std::vector<Recovered> recover(const StressRequest& request, const plan::Plan& plan, const Sources& sources,
                               const output::NodeMotion& motion, MPI_Comm comm, std::vector<std::string>& notes) {
  std::vector<std::size_t> all(motion.times().size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<Recovered> bodies;
  for (std::size_t b = 0; b < plan.bodies.size(); ++b) {
    const scene::Body& spec = plan.bodies[b].spec;
    const auto source = sources.find(spec.name);
    if (spec.rigid) continue;
    if (!motion.has(spec.name) || (spec.reduced && source == sources.end())) {
      notes.push_back(fmt::format(
          "body {} {}, and is omitted", spec.name,
          spec.reduced ? "is from a file without elements (--source BODY:SCENE.yaml)" : "has no mesh in the results"));
      continue;
    }
    const plan::Plan& of = spec.reduced ? source->second->plan : plan;
    const int number = spec.reduced ? body_in(of, plan.bodies[b]) : static_cast<int>(b);
    bodies.push_back(
        {spec.name, std::make_unique<BodyStress>(of, number, spec.name, motion, !request.uncorrected), {}});
    bodies.back().extremes = find_extremes(*bodies.back().stress, all, comm);
    if (lacks_torsion(of, of.bodies[static_cast<std::size_t>(number)]))
      notes.push_back(fmt::format(
          "body {}: von Mises' stress of beams whose sections are given by constants and fibres is without torsion",
          spec.name));
    if (const auto [without, elements] = without_stresses(of.bodies[static_cast<std::size_t>(number)]); without > 0)
      notes.push_back(fmt::format(
          "body {}: {} have forces and moments, but no stresses: their sections have no shape and no fibres{}; "
          "expected fibre or fibres of a section of beams, or stress points C to F of PBAR or PBEAM",
          spec.name,
          without < elements ? fmt::format("{} of {} elements", without, elements)
                             : fmt::format("all {} elements", elements),
          without < elements ? " (the maximum is that of the others)" : ""));
  }
  return bodies;
}

void show(const std::vector<Recovered>& bodies, const std::vector<double>& times) {
  output::Table table;
  table.columns = {{"body", ""},  {"", ""},      {"von Mises", "Pa", 5}, {"t", "s", 5},
                   {"x", "m", 4}, {"y", "m", 4}, {"z", "m", 4},          {"remark", ""}};
  for (const Recovered& body : bodies)
    for (const bool regular : {false, true}) {
      const Peak& peak = regular ? body.extremes.regular : body.extremes.greatest;
      if (!(peak.value >= 0) || (regular && peak.singular == body.extremes.greatest.singular)) continue;
      table.rows.push_back({body.name, regular ? "elsewhere" : "maximum", peak.value, times[peak.row], peak.at[0],
                            peak.at[1], peak.at[2], words_of(peak.singular)});
    }
  if (!table.rows.empty()) fmt::print("{}", output::to_text(table));
}

}  // namespace

void stress(const StressRequest& request, MPI_Comm comm) {
  std::optional<output::NodeMotion> motion;
  scene::Scene whole;
  petsc::agree(comm, [&] {
    motion.emplace(comm, request.folder);
    whole = scene_of(request, *motion);
  });
  const output::Waiting waiting(comm, "recovering stresses");
  const Planned planned(motion->formulation() == "cfr" ? whole : plan::split_frames(whole, comm), comm);
  const Sources sources = sources_of(request, planned.plan, comm);
  const std::vector<double>& times = motion->times();
  std::vector<std::size_t> rows;
  petsc::agree(comm, [&] { rows = chosen_rows(request, times); });
  std::vector<std::string> notes;
  const std::vector<Recovered> bodies = recover(request, planned.plan, sources, *motion, comm, notes);
  if (bodies.empty()) throw InputError(fmt::format("stress '{}': no flexible body has a mesh", request.folder));
  std::vector<Watched> watched;
  std::vector<std::string> places;
  for (const std::string& word : request.histories) {
    std::pair<std::string, Eigen::Vector3d> place;
    petsc::agree(comm, [&] { place = place_of(word, bodies); });
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (bodies[b].name == place.first) watched.push_back({b, nearest_cell(*bodies[b].stress, place.second, comm)});
    places.push_back(word);
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Peak& peak = bodies[b].extremes.greatest;
    if (!(peak.value >= 0)) continue;
    if (request.histories.empty()) {
      watched.push_back({b, peak.rank == petsc::rank_of(comm) ? static_cast<std::ptrdiff_t>(peak.cell) : -1});
      places.push_back(fmt::format("{}, where von Mises' stress is greatest", bodies[b].name));
    }
    if (request.at.empty() && request.frames == 0) rows.push_back(peak.row);
  }
  if (rows.empty()) rows.push_back(times.size() - 1);
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());

  std::map<std::string, output::CellFields> cells;
  std::vector<std::unique_ptr<Frames>> frames;
  for (const Recovered& body : bodies) {
    output::CellFields& of = cells[body.name];
    of.cells = body.stress->cells(), of.fields = body.stress->fields();
    frames.push_back(std::make_unique<Frames>(*body.stress, rows));
    of.values = [own = frames.back().get()](std::size_t frame) { return own->values(frame); };
    of.constants = constant_fields();
    of.constant_values = constant_values(body.extremes, *body.stress, times);
  }
  output::MotionRequest file;
  file.results = request.folder;
  file.xdmf = request.out ? *request.out : (file.results / "stress.xdmf").string();
  file.amplify = request.amplify, file.overwrite = request.force, file.what = "stress";
  file.rows = rows, file.cells = &cells;
  const output::MotionWritten written = output::write_motion(comm, file);
  const std::filesystem::path csv = std::filesystem::path(file.xdmf).replace_extension(".csv");
  if (!watched.empty()) write_histories(bodies, watched, times, csv, comm);
  if (!petsc::first_rank(comm)) return;
  show(bodies, times);
  fmt::print("{} instants, {} of them with fields, {} elements of {}{}\n", times.size(), written.t.size(),
             written.cells, fmt::join(written.bodies, ", "),
             !request.uncorrected && motion->has_correction() ? "; with the correction of the error estimate" : "");
  for (const std::string& note : notes) fmt::print("Note: {}\n", note);
  fmt::print("For ParaView: {}\n", file.xdmf.string());
  for (std::size_t w = 0; w < places.size(); ++w) fmt::print("History {} in {}: {}\n", w + 1, csv.string(), places[w]);
}

}  // namespace floe::app
