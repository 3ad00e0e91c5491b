#include "recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/output/summary.h"
#include "floe/petsc/values.h"
#include "floe/solve/start.h"
#include "record_bodies.h"
#include "run_summary.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

/// What a summary says until the run is assessed: also that of a run which was killed over it.
constexpr const char* unassessed =
    "not done: the run was interrupted while the model's validity was checked or its error was estimated; its results "
    "are complete";

}  // namespace

Recorder::Recorder(const scene::Scene& scene, const assembly::Model& model, MPI_Comm comm,
                   const std::optional<output::ResultFolder>& folder, RunResult& result, const RunPlan& plan)
    : scene_(scene),
      model_(model),
      comm_(comm),
      folder_(folder),
      result_(result),
      checkpoint_every_(plan.checkpoints),
      energies_(plan.energies),
      checks_balance_(plan.balance),
      end_(plan.until.value_or(scene.motion.end)),
      alone_(scene::is_reduced(model.formulation)),
      kept_at_(MPI_Wtime()) {
  result_.summary = first_summary(scene, model, comm, result);
  if (!plan.choice.is_null()) result_.summary["accuracy"] = plan.choice;
  if (!folder_) return;
  if (checkpoint_every_.any()) {
    identity_ = identity_of(scene, model.formulation, comm);
    identity_["checkpoint"] = {{"steps", checkpoint_every_.steps}, {"seconds", checkpoint_every_.seconds}};
  }
  if (plan.from) {
    continue_files(*plan.from);
    return;
  }
  output::remove_replaced(comm, *folder_);
  output::write_summary(comm, *folder_, result_.summary);
  try {
    open_files();
  } catch (const RunError& error) {
    result_.summary["status"] = "failed";
    result_.summary["reason"] = error.what();
    output::write_summary(comm, *folder_, result_.summary);
    throw;
  }
}

void Recorder::open_files() {
  std::vector<output::SeriesColumn> columns;
  for (const auto& column : result_.series.columns) columns.push_back({column.name, column.unit});
  probes_ = std::make_unique<output::SeriesFile>(comm_, folder_->probes(), columns);
  file_ = std::make_unique<output::ResultFile>(comm_, folder_->result());
  file_->write_text("summary", result_.summary.dump(2));
  file_->write_text("scene", scene_.text);
  write_bodies(*file_, model_);
  for (const auto& [name, count, label] : all_series()) file_->add_series(name, count, label, expected_rows());
  file_->publish();
}

std::int64_t Recorder::expected_rows() const {
  const scene::Motion& motion = scene_.motion;
  if (motion.tolerance && !motion.output) return 0;
  const double interval = motion.output.value_or(motion.step * motion.every);
  return static_cast<std::int64_t>(end_ / interval) + 2 + static_cast<std::int64_t>(scene_.events.size());
}

std::vector<std::tuple<std::string, PetscInt, output::Label>> Recorder::all_series() const {
  const PetscInt unknowns = model_.coordinates + model_.multipliers;
  std::vector<std::tuple<std::string, PetscInt, output::Label>> all{
      {"motion/t", 1, {"s", "time"}},
      {"motion/U", unknowns, {"", "coordinates and multipliers"}},
      {"motion/V", unknowns, {"", "their rates"}},
      {"motion/energy", 3, {"J", "kinetic, elastic, potential"}},
      {"motion/constraints", 2, {"", "maximum violation of the constraints, and of their rates"}}};
  if (const int frames = assembly::moving_frames(model_); frames > 0)
    all.emplace_back(
        "motion/attitude", 4 * frames,
        output::Label{
            "", "unit quaternion (w, x, y, z) of each moving frame of a spatial scene, in the order of the bodies"});
  return all;
}

/// Everything as it was at the checkpoint; what was written after it is lost, and comes again.
void Recorder::continue_files(const output::Checkpoint& from) {
  const std::vector<double>& record = from.shared.at("record");
  const auto rows = static_cast<std::int64_t>(record[0]);
  energy_start_ = record[1], energy_now_ = record[2], max_energy_ = record[3];
  change_ = record[4], violation_ = record[5], velocity_violation_ = record[6];
  std::array<double, solve::EnergyBalance::numbers> balance{};
  if (record.size() != 7 + balance.size()) throw RunError("the checkpoint belongs to another version of floe");
  std::copy_n(record.begin() + 7, balance.size(), balance.begin());
  balance_.load(balance);
  first_step_ = kept_step_ = from.words.at("step");
  result_.summary["events"] = from.words.at("events");
  result_.summary["continued"] = from.words.at("continued");
  result_.summary["continued"].push_back({{"step", first_step_}, {"t", from.words.at("t")}});
  std::vector<output::SeriesColumn> columns;
  for (const auto& column : result_.series.columns) columns.push_back({column.name, column.unit});
  std::vector<std::vector<double>> kept;
  probes_ = std::make_unique<output::SeriesFile>(comm_, folder_->probes(), columns, rows, kept);
  for (const auto& row : kept) {
    result_.series.t.push_back(row.front());
    result_.series.values.emplace_back(row.begin() + 1, row.end());
  }
  file_ = std::make_unique<output::ResultFile>(comm_, folder_->result(), output::ResultFile::Existing::keep);
  file_->remove("estimate");  // of a motion that ended elsewhere
  for (const auto& [name, count, label] : all_series()) file_->continue_series(name, count, rows, expected_rows());
  file_->publish();
  output::write_summary(comm_, *folder_, result_.summary);
}

void Recorder::note(const dynamics::EventReport& event) {
  ordered_json j{{"name", event.name}, {"what", event.what}, {"t", event.t}};
  if (event.speed) j["speed"] = *event.speed;
  if (event.work) j["kinetic_energy_gained"] = *event.work;
  if (event.released != 0) j["kinetic_energy_released"] = event.released;
  const double lost = event.lost + std::min(event.damped, 0.);  // negative: drives carry what is locked along
  balance_.pass_event(event.work.value_or(0) + std::max(-lost, 0.), std::max(lost, 0.), std::max(event.damped, 0.),
                      event.released);
  if (!event.impulses.empty()) j["kinetic_energy_lost"] = event.lost + event.damped, j["impulses"] = event.impulses;
  result_.summary["events"].push_back(j);
}

void Recorder::checkpoint_if_due(const solve::Instant& instant, const std::function<bool()>& ending) {
  if (!folder_ || !checkpoint_every_.any() || !instant.state) return;
  const auto [steps, seconds] = checkpoint_every_;
  int due = seconds > 0 && MPI_Wtime() - kept_at_ > seconds;
  if (seconds > 0 && !alone_) MPI_Bcast(&due, 1, MPI_INT, 0, comm_);
  if (steps > 0 && instant.step % steps == 0) due = 1;
  const bool end = ending() || instant.last;
  if ((!due && !end) || instant.step == kept_step_) return;
  kept_step_ = instant.step;
  const double begin = MPI_Wtime();
  write_checkpoint(instant);
  ++checkpoints_;
  kept_at_ = MPI_Wtime();
  kept_seconds_ += kept_at_ - begin;
  seconds_ += kept_at_ - begin;
}

/// Results first: a checkpoint never comes after what is on disk. Where all ranks move copies, rank 0 writes.
void Recorder::write_checkpoint(const solve::Instant& instant) {
  int rank = 0;
  MPI_Comm_rank(comm_, &rank);
  if (alone_ && rank != 0) return;
  output::Checkpoint checkpoint;
  checkpoint.words = {{"run", identity_},
                      {"t", instant.t},
                      {"step", instant.step},
                      {"events", result_.summary.value("events", ordered_json::array())},
                      {"continued", result_.summary.value("continued", ordered_json::array())}};
  checkpoint.shared["record"] = {static_cast<double>(result_.series.t.size()),
                                 energy_start_,
                                 energy_now_,
                                 max_energy_,
                                 change_,
                                 violation_,
                                 velocity_violation_};
  const auto balance = balance_.save();
  checkpoint.shared["record"].insert(checkpoint.shared["record"].end(), balance.begin(), balance.end());
  put_state((*instant.state)(), checkpoint);
  const auto save_probes = [&] { probes_->save(); };
  if (alone_)
    save_probes();
  else
    petsc::agree(comm_, save_probes);
  file_->save(alone_);
  output::write_checkpoint(alone_ ? PETSC_COMM_SELF : comm_, folder_->checkpoint(), checkpoint);
}

bool Recorder::has_estimate() const { return result_.estimate.none.empty() && !result_.estimate.t.empty(); }

void Recorder::write_estimate() {
  const assess::Estimate& estimate = result_.estimate;
  if (!has_estimate()) return;
  const auto rows = static_cast<std::int64_t>(estimate.t.size());
  const auto columns = static_cast<std::int64_t>(result_.series.columns.size());
  std::vector<double> errors;
  for (const auto& row : estimate.errors) errors.insert(errors.end(), row.begin(), row.end());
  file_->write_array("estimate/t", {rows}, estimate.t, {"s", "time"});
  if (estimate.by.empty())
    file_->write_array("estimate/deformation", {rows}, estimate.relative,
                       {"", "estimated error of the deformations, mass-weighted, relative to their root mean square"});
  if (columns > 0)
    file_->write_array("estimate/probes", {rows, columns}, errors,
                       {"", "estimated error of each column of probes.csv: full-order model minus this model"});
  write_deviation(*file_, model_, estimate);
}

void Recorder::store_state(Vec U, Vec V) {
  const auto append = [&](const char* name, Vec vector) {
    petsc::Values values(vector);
    const std::span<const double> part(values.begin(), static_cast<std::size_t>(values.end - values.first));
    if (scene::is_reduced(model_.formulation))
      file_->append(name, part);
    else
      file_->append_distributed(name, values.first, part);
  };
  const petsc::VecHandle shown = shown_state(model_, U);
  append("motion/U", shown.get() ? shown.get() : U);
  append("motion/V", V);
}

/// Whether an instant is one of those that the scene wants: every so many steps, or, with `output`, at a multiple.
bool Recorder::due(const solve::Instant& instant) const {
  if (instant.last || instant.step == 0) return true;
  if (!scene_.motion.output) return instant.step % scene_.motion.every == 0;
  const double number = instant.t / *scene_.motion.output;
  return std::abs(number - std::round(number)) < 1e-9 * std::max(1.0, number);
}

void Recorder::observe(const solve::Instant& instant) {
  note_error(instant);
  bool some = false;  // stored within the step
  if (scene_.motion.output && instant.between && !result_.series.t.empty()) {
    const double interval = *scene_.motion.output, last = result_.series.t.back();
    for (double next = std::floor(last / interval * (1 + 1e-12) + 1e-9) + 1;
         next * interval < instant.t - 1e-9 * interval; ++next) {
      for (petsc::VecHandle* one : {&between_U_, &between_V_, &between_A_})
        if (!*one) *one = model_.system->create_vector();
      const double begin = MPI_Wtime();
      (*instant.between)(next * interval, between_U_, between_V_, between_A_);
      seconds_ += MPI_Wtime() - begin;
      store(next * interval, between_U_, between_V_, between_A_, measured(next * interval, between_U_, between_V_));
      some = true;
    }
  }
  const bool again = !result_.series.t.empty() && result_.series.t.back() == instant.t;  // the last one, once more
  const bool stores = due(instant) && !again;
  if (!stores && !some) return;
  const Measured now = measured(instant.t, instant.U, instant.V);
  look_after(instant, now);
  if (stores) store(instant.t, instant.U, instant.V, instant.accelerations(), now);
}

Recorder::Measured Recorder::measured(double t, Vec U, Vec V) {
  const double begin = MPI_Wtime();
  const auto violation = [&](dynamics::ConstraintLevel level) {
    return solve::constraint_violation(*model_.system, t, U, V, level);
  };
  Measured all{};
  if (energies_) all.energy = model_.system->energy(t, U, V);
  if (checks_balance_)
    all.violations = {violation(dynamics::ConstraintLevel::position), violation(dynamics::ConstraintLevel::velocity)};
  seconds_ += MPI_Wtime() - begin;
  return all;
}

void Recorder::look_after(const solve::Instant& instant, const Measured& now) {
  if (!checks_balance_) return;
  const dynamics::Energy& energy = now.energy;
  energy_now_ = energy.kinetic + energy.elastic + energy.potential;
  if (result_.series.t.empty()) energy_start_ = energy_now_;  // a table of equilibria may begin late
  max_energy_ = std::max({max_energy_, energy.kinetic, energy.elastic, std::abs(energy.potential)});
  change_ = std::max(change_, std::abs(energy_now_ - energy_start_));
  violation_ = std::max(violation_, now.violations[0]);
  velocity_violation_ = std::max(velocity_violation_, now.violations[1]);
  const double begin = MPI_Wtime();
  balance_.add(*model_.system, instant.t, instant.U, instant.V, instant.A, energy_now_, max_energy_);
  seconds_ += MPI_Wtime() - begin;
  refuse_runaway();
}

void Recorder::store(double t, Vec U, Vec V, Vec A, const Measured& now) {
  const double begin = MPI_Wtime();
  const std::vector<double> values = assembly::probe_values(model_, t, U, V, A);
  result_.series.t.push_back(t);
  result_.series.values.push_back(values);
  result_.series.energy.push_back(now.energy);
  if (folder_) {
    const std::vector<double> attitudes = assembly::attitudes(model_, U);
    const auto write = [&] {
      probes_->row(t, values);
      const double at[1] = {t}, e[3] = {now.energy.kinetic, now.energy.elastic, now.energy.potential};
      file_->append("motion/t", at);
      file_->append("motion/energy", e);
      file_->append("motion/constraints", now.violations);
      if (!attitudes.empty()) file_->append("motion/attitude", attitudes);
    };
    if (scene::is_reduced(model_.formulation))
      write();
    else
      petsc::agree(comm_, write);
    store_state(U, V);
  }
  seconds_ += MPI_Wtime() - begin;
}

void Recorder::finish(const solve::IntegrationReport& report, const std::string& stopped, bool assesses) {
  ordered_json& j = result_.summary;
  j["status"] = stopped.empty() ? "finished" : "failed";
  if (!stopped.empty()) j["reason"] = stopped;
  j["warnings"] = result_.warnings;
  j["integration"] = {{"type", report.type},
                      {"reached", report.end},
                      {"steps", report.steps},
                      {"rejected", report.rejected},
                      {"newton_iterations", report.newton},
                      {"linear_solves", report.solves}};
  j["energy"] = {{"start", energy_start_},       {"end", energy_now_},
                 {"greatest_part", max_energy_}, {"greatest_change_of_total_energy", change_},
                 {"work", balance_.work()},      {"greatest_growth_without_work", balance_.growth()}};
  j["constraints"] = {{"greatest_violation", violation_}, {"greatest_velocity_violation", velocity_violation_}};
  if (assesses) j["assessment"] = unassessed;
  if (scene::is_reduced(model_.formulation))
    j["estimate"] = assesses ? ordered_json{{"none", unassessed}} : estimate_json(result_.estimate, model_);
  j["seconds"]["motion"] = result_.motion_seconds;
  j["seconds"]["recording"] = seconds_;
  j["seconds"]["motion_and_recording_processor"] = report.processor_seconds;
  if (report.steps > first_step_)
    j["seconds"]["per_step"] = result_.motion_seconds / static_cast<double>(report.steps - first_step_);
  if (checkpoint_every_.any()) j["checkpoints"] = {{"written", checkpoints_}, {"seconds", kept_seconds_}};
  if (!folder_) return;
  std::exception_ptr fault;  // of one file: the others are finished all the same
  const auto attempt = [&](const auto& work) {
    try {
      work();
    } catch (const RunError& error) {
      if (fault) return;
      fault = std::current_exception();
      if (stopped.empty()) j["status"] = "failed", j["reason"] = error.what();
    }
  };
  attempt([&] { probes_->finish(); });
  attempt([&] {
    file_->flush();
    ordered_json there = j;
    there.erase("assessment");  // else there would always be something to add to a file that may be large
    file_->write_text("summary", written_ = there.dump(2));
    file_->finish();
  });
  attempt([&] { output::write_summary(comm_, *folder_, j); });
  if (fault) std::rethrow_exception(fault);
}

void Recorder::conclude(const ordered_json& budget) {
  ordered_json& j = result_.summary;
  j.erase("assessment");
  j["warnings"] = result_.warnings;
  for (const assess::OutOfRange& one : result_.out_of_range)
    j["out_of_range"].push_back(
        {{"what", one.what}, {"of", one.of}, {"value", one.value}, {"limit", one.limit}, {"text", one.text}});
  if (scene::is_reduced(model_.formulation)) j["estimate"] = estimate_json(result_.estimate, model_);
  if (!budget.is_null()) j["estimate"].update(budget);
  if (!folder_) return;
  output::write_summary(comm_, *folder_, j);
  if (!has_estimate() && j.dump(2) == written_) return;
  write_estimate();
  file_->write_text("summary", j.dump(2));
  file_->publish();
}

void Recorder::conclude_alone(const std::string& why) noexcept {
  if (!folder_) return;
  try {
    ordered_json j = result_.summary;
    j["assessment"] = "failed: " + why;
    if (scene::is_reduced(model_.formulation)) j["estimate"] = {{"none", why}};
    output::write_file_atomically(folder_->summary(), j.dump(2) + "\n");
  } catch (const std::exception&) {  // summary.json says that it was not done
  }
}

}  // namespace floe::app
