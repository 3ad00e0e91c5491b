#include "sweep.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include "drawing.h"
#include "floe/output/provenance.h"
#include "floe/petsc/error.h"
#include "floe/petsc/rank.h"
#include "floe/petsc/together.h"
#include "interruption.h"
#include "run.h"
#include "sweep_file.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

/// The scene's text, and what of it changes from member to member.
struct Plan {
  std::string file, text;
  scene::Formulation formulation;
  std::vector<std::vector<scene::Variation>> members;
  bool estimate = false;
  std::string title = {};
};

/// Of columns, without their components.
std::vector<std::string> probes_of(const std::vector<assembly::ProbeColumn>& columns) {
  std::vector<std::string> names;
  for (const assembly::ProbeColumn& column : columns)
    if (std::string name = column.name.substr(0, column.name.rfind('.')); names.empty() || names.back() != name)
      names.push_back(std::move(name));
  return names;
}

/// The total errors of a member; what they lack becomes a warning.
void read_errors(const RunResult& result, Member& member) {
  const ordered_json estimate = result.summary.value("estimate", ordered_json::object());
  const ordered_json total = estimate.value("total", ordered_json::object());
  for (const std::string& probe : probes_of(result.series.columns)) {
    const bool known = total.contains("probes") && total["probes"].contains(probe);
    member.errors.push_back(known ? total["probes"][probe].get<double>() : NAN);
  }
  if (total.contains("missing"))
    for (const auto& [probe, parts] : total["missing"].items())
      for (const auto& part : parts)
        member.warnings.push_back(
            fmt::format("estimated error of probe {} without the {} error", probe, part.get<std::string>()));
  if (estimate.contains("none"))
    member.warnings.push_back("no estimate of the reduction error: " + estimate["none"].get<std::string>());
  for (const char* part : {"model", "mesh", "step"})
    if (estimate.contains(part) && estimate[part].contains("none"))
      member.warnings.push_back(
          fmt::format("no estimate of the {} error: {}", part, estimate[part]["none"].get<std::string>()));
}

/// The ranks that simulate a member together.
class Group {
 public:
  Group(MPI_Comm all, int size) {
    int rank = 0, ranks = 1;
    MPI_Comm_rank(all, &rank);
    MPI_Comm_size(all, &ranks);
    number = rank / size, count = (ranks + size - 1) / size;
    MPI_Comm_split(all, number, rank, &comm);
    leads = petsc::first_rank(comm);
  }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;
  ~Group() { MPI_Comm_free(&comm); }
  MPI_Comm comm = MPI_COMM_NULL;
  int number = 0, count = 1;
  bool leads = true;  ///< this rank has the member's results
};

/// Keeps the last bodies that were reduced: members that differ in what acts on them share these.
class Offline {
 public:
  explicit Offline(MPI_Comm comm) : comm_(comm) {}
  /// Collective.
  const assembly::ReducedBodies& bodies(const Plan& plan, std::size_t member, const scene::Scene& scene) {
    std::string inputs = scene::offline_inputs(plan.text, plan.file, plan.members[member]);
    if (!bodies_ || inputs != inputs_) {
      bodies_.reset();
      bodies_ = assembly::reduce_once(scene, plan.formulation, comm_);
      inputs_ = std::move(inputs);
      ++reductions;
    }
    return *bodies_;
  }
  std::int64_t reductions = 0;

 private:
  MPI_Comm comm_;
  std::string inputs_;
  std::shared_ptr<const assembly::ReducedBodies> bodies_;
};

/// Greatest absolute value, root of the mean square over time (trapezoidal rule) and last value of each probe.
void measure(Member& member, std::size_t columns) {
  member.greatest.assign(columns, 0), member.rms.assign(columns, 0), member.last.assign(columns, 0);
  const double duration = member.rows.back()[0] - member.rows.front()[0];
  for (std::size_t c = 0; c < columns; ++c) {
    double integral = 0;
    for (std::size_t i = 0; i < member.rows.size(); ++i) {
      const double value = member.rows[i][c + 1];
      member.greatest[c] = std::max(member.greatest[c], std::abs(value));
      if (i == 0) continue;
      const double before = member.rows[i - 1][c + 1];
      integral += 0.5 * (member.rows[i][0] - member.rows[i - 1][0]) * (value * value + before * before);
    }
    member.rms[c] = duration > 0 ? std::sqrt(integral / duration) : 0;
    member.last[c] = member.rows.back()[c + 1];
  }
}

/// Of ranks that do not lead the fault alone. Collective on the group.
Member simulate_member(const Plan& plan, std::size_t number, Offline& offline, const Group& group) {
  Member member;
  const std::string fault = petsc::failed_together(group.comm, [&] {
    const scene::Scene scene = scene::parse_scene(plan.text, plan.file, plan.members[number]);
    RunPlan quiet;
    quiet.quiet = true, quiet.estimate = plan.estimate;
    const auto shared = [&] {
      assembly::Model model = assembly::build_on(offline.bodies(plan, number, scene), scene);
      return move(scene, model, 0, group.comm, std::nullopt, quiet);
    };
    if (plan.estimate) ++offline.reductions;  // with the factors that estimates need
    const RunResult result = plan.estimate ? run(scene, plan.formulation, group.comm, std::nullopt, quiet) : shared();
    if (!group.leads) return;
    member.steps = result.steps;
    member.end = result.end;
    for (std::size_t i = 0; i < result.series.t.size(); ++i) {
      auto& row = member.rows.emplace_back(1, result.series.t[i]);
      row.insert(row.end(), result.series.values[i].begin(), result.series.values[i].end());
    }
    measure(member, result.series.columns.size());
    member.warnings = result.warnings;
    if (plan.estimate) read_errors(result, member);
  });
  return fault.empty() ? member : Member{.fault = fault};
}

/// A member as numbers, the texts of its fault and of its warnings last, each ended by a zero.
std::vector<double> packed(std::size_t number, const Member& member) {
  const std::size_t columns = member.rows.empty() ? 0 : member.rows.front().size();
  std::vector<double> numbers{static_cast<double>(number),
                              static_cast<double>(member.steps),
                              member.end,
                              static_cast<double>(member.rows.size()),
                              static_cast<double>(columns),
                              static_cast<double>(member.errors.size())};
  for (const auto& row : member.rows) numbers.insert(numbers.end(), row.begin(), row.end());
  numbers.insert(numbers.end(), member.errors.begin(), member.errors.end());
  const auto put = [&](const std::string& text) {
    for (const char c : text) numbers.push_back(static_cast<unsigned char>(c));
    numbers.push_back(0);
  };
  put(member.fault);
  for (const std::string& warning : member.warnings) put(warning);
  return numbers;
}

Member unpacked(const std::vector<double>& numbers, std::size_t& number) {
  number = static_cast<std::size_t>(numbers[0]);
  Member member;
  member.steps = static_cast<PetscInt>(numbers[1]), member.end = numbers[2];
  const auto rows = static_cast<std::size_t>(numbers[3]), columns = static_cast<std::size_t>(numbers[4]);
  const auto errors = static_cast<std::ptrdiff_t>(numbers[5]);
  auto next = numbers.begin() + 6;
  for (std::size_t i = 0; i < rows; ++i, next += static_cast<std::ptrdiff_t>(columns))
    member.rows.emplace_back(next, next + static_cast<std::ptrdiff_t>(columns));
  member.errors.assign(next, next + errors);
  next += errors;
  std::vector<std::string> texts(1);
  for (; next != numbers.end(); ++next) {
    if (*next == 0)
      texts.emplace_back();
    else
      texts.back() += static_cast<char>(static_cast<unsigned char>(*next));
  }
  member.fault = texts.front();
  member.warnings.assign(texts.begin() + 1, texts.end() - 1);  // after the last zero nothing follows
  if (rows > 0) measure(member, columns - 1);
  return member;
}

/// What other ranks send to rank 0, and it puts into its file in the order of the members.
class Collection {
 public:
  Collection(const Plan& plan, MPI_Comm comm, SweepFile* file) : plan_(plan), comm_(comm), file_(file) {}
  /// On rank 0.
  void put(std::size_t number, Member member) {
    waiting_.emplace(number, std::move(member));
    for (auto first = waiting_.begin(); first != waiting_.end() && first->first == next_; ++next_) {
      keep([&] { file_->add(plan_.members[next_], first->second); });
      if (!first->second.fault.empty())
        std::fprintf(stderr, "floe: member %zu failed: %s\n", next_ + 1, first->second.fault.c_str());
      first = waiting_.erase(first);
    }
  }
  /// On rank 0: takes what has come in; `all`: waits for every member.
  void take(bool all) {
    while (next_ < plan_.members.size()) {
      MPI_Status status;
      int there = 1, count = 0;
      if (all)
        MPI_Probe(MPI_ANY_SOURCE, tag, comm_, &status);
      else
        MPI_Iprobe(MPI_ANY_SOURCE, tag, comm_, &there, &status);
      if (!there) return;
      MPI_Get_count(&status, MPI_DOUBLE, &count);
      std::vector<double> numbers(count);
      MPI_Recv(numbers.data(), count, MPI_DOUBLE, status.MPI_SOURCE, tag, comm_, MPI_STATUS_IGNORE);
      std::size_t number = 0;
      Member member = unpacked(numbers, number);
      put(number, std::move(member));
    }
  }
  /// On rank 0: writes as long as that is possible; after a failure what comes in is received, and lost.
  template <class Work>
  void keep(Work&& work) {
    if (lost_) return;
    try {
      work();
    } catch (const RunError&) {
      lost_ = std::current_exception();
    }
  }
  /// @throws RunError  what could not be written
  void check() const {
    if (lost_) std::rethrow_exception(lost_);
  }
  /// On other ranks.
  void send(std::size_t number, const Member& member) {
    sent_.push_back(packed(number, member));
    MPI_Isend(sent_.back().data(), static_cast<int>(sent_.back().size()), MPI_DOUBLE, 0, tag, comm_,
              &requests_.emplace_back());
  }
  void wait() { MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE); }

 private:
  static constexpr int tag = 77;
  const Plan& plan_;
  MPI_Comm comm_;
  SweepFile* file_;
  std::map<std::size_t, Member> waiting_;
  std::size_t next_ = 0;
  std::exception_ptr lost_;
  std::vector<std::vector<double>> sent_;
  std::vector<MPI_Request> requests_;
};

Plan plan_of(const SweepRequest& request, int ranks) {
  if (!scene::is_reduced(request.formulation))
    throw InputError(fmt::format("--formulation {}: a sweep simulates reduced models; expected vm+md or vm",
                                 scene::name_of(request.formulation)));
  if (request.ranks_per_member < 1 || request.ranks_per_member > ranks)
    throw InputError(fmt::format("--ranks-per-member: is {}; expected 1 to {}, the number of ranks of this sweep",
                                 request.ranks_per_member, ranks));
  const std::string& file = request.scene;
  Plan plan{file, scene::read_scene(file).text, request.formulation, members_of(request.varied, request.together),
            request.estimate};
  const scene::Scene first = scene::parse_scene(plan.text, file, plan.members.front());  // are the paths there
  if (first.motion.end <= 0)
    throw InputError(file + ": motion: is missing; expected end time and time step, as `motion: {end: 3, step: 1e-3}`");
  if (first.probes.empty())
    throw InputError(file + ": probes: is missing; expected the quantities that the sweep records");
  plan.title = first.title;
  return plan;
}

/// Columns of the probes, as the scene has them. Those of a first model, which is built for nothing else, are the
/// members'. Collective.
std::vector<assembly::ProbeColumn> columns_of(const Plan& plan, Offline& offline, MPI_Comm comm) {
  std::vector<assembly::ProbeColumn> columns;
  for (std::size_t m = 0; m < plan.members.size(); ++m) {
    const auto build = [&] {
      const scene::Scene scene = scene::parse_scene(plan.text, plan.file, plan.members[m]);
      columns = assembly::probe_columns(assembly::build_on(offline.bodies(plan, m, scene), scene));
    };
    if (m + 1 == plan.members.size())
      petsc::together(comm, build);
    else if (petsc::failed_together(comm, build).empty())
      break;
  }
  return columns;
}

ordered_json summary_of(const Plan& plan, const SweepRequest& request, MPI_Comm comm) {
  ordered_json j{{"status", "running"},
                 {"scene", {{"file", plan.file}, {"title", plan.title}}},
                 {"formulation", scene::name_of(plan.formulation)},
                 {"provenance", output::provenance(comm)}};
  j["ranks_per_member"] = request.ranks_per_member;
  for (const Varied& each : request.varied) j["varied"].push_back({{"path", each.path}, {"values", each.values}});
  j["members"] = plan.members.size();
  j["failures"] = ordered_json::array();
  j["warnings"] = ordered_json::array();
  return j;
}

}  // namespace

namespace {

void sweep_into(const SweepRequest& request, MPI_Comm comm, const output::ResultFolder& folder) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  Plan plan;
  petsc::agree(comm, [&] { plan = plan_of(request, ranks); });
  const Group group(comm, request.ranks_per_member);
  Offline offline(group.comm);
  std::unique_ptr<SweepFile> file;
  output::remove_replaced(comm, folder);
  petsc::together(comm, [&] {
    if (group.number != 0) return;
    const std::vector<assembly::ProbeColumn> columns = columns_of(plan, offline, group.comm);
    if (rank != 0) return;
    std::vector<std::string> paths;
    for (const Varied& each : request.varied) paths.push_back(each.path);
    file = std::make_unique<SweepFile>(folder, plan.text, summary_of(plan, request, comm), paths, columns,
                                       plan.estimate ? probes_of(columns) : std::vector<std::string>());
  });
  Collection collection(plan, comm, file.get());
  const Interruption interruption;
  const double begin = MPI_Wtime();
  double saved = begin;
  bool stopped = false;
  for (std::size_t m = group.number; m < plan.members.size(); m += group.count) {
    Member member = stopped ? Member{.fault = "not simulated: the sweep was interrupted"}
                            : simulate_member(plan, m, offline, group);
    stopped = stopped || Interruption::happened(group.comm);
    if (!group.leads) continue;
    if (rank != 0) {
      collection.send(m, member);
      continue;
    }
    collection.put(m, std::move(member));
    collection.take(false);
    if (MPI_Wtime() - saved < 1) continue;
    collection.keep([&] { file->save("running"); });
    saved = MPI_Wtime();
  }
  if (rank == 0) collection.take(true);
  collection.wait();
  const bool ended = Interruption::happened(comm);
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    collection.check();
    file->finish(ended || file->failed() > 0 ? "failed" : "finished");
  });
  std::int64_t numbers[2] = {file ? file->failed() : 0, 0};
  MPI_Bcast(numbers, 1, MPI_INT64_T, 0, comm);
  const std::int64_t reductions = group.leads ? offline.reductions : 0;
  MPI_Allreduce(&reductions, &numbers[1], 1, MPI_INT64_T, MPI_SUM, comm);
  const double seconds = MPI_Wtime() - begin;
  if (rank == 0) {
    fmt::print("{} members ({} failed) in {:.3g} s; {} reductions of bodies\n", plan.members.size(), numbers[0],
               seconds, numbers[1]);
    for (const SweepWarning& warning : file->warnings()) fmt::print("Note: {}\n", words_of(warning));
    fmt::print("Results: {}\nPicture: {}\n", folder.path.string(), draw("sweep", folder.path.string()));
  }
  interruption.check(comm);
  if (numbers[0] > 0) throw RunError(fmt::format("{} of {} members failed", numbers[0], plan.members.size()));
}

}  // namespace

void sweep(const SweepRequest& request, MPI_Comm comm, const output::ResultFolder& folder) {
  try {
    sweep_into(request, comm, folder);
  } catch (const std::exception&) {
    output::discard_if_empty(folder);
    throw;
  }
}

}  // namespace floe::app
