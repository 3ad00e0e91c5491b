#include "sweep_file.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "floe/output/summary.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

/// In quotation marks where a cell of CSV needs them.
std::string cell(std::string text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) text.insert(at, 1, '"');
  return '"' + text + '"';
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

}  // namespace

SweepFile::SweepFile(const output::ResultFolder& folder, const std::string& scene_text, ordered_json summary,
                     const std::vector<std::string>& paths, const std::vector<assembly::ProbeColumn>& columns,
                     const std::vector<std::string>& estimated)
    : folder_(folder), summary_(std::move(summary)), columns_(columns), estimated_(estimated.size()) {
  std::vector<std::string> of_member{"member"};
  of_member.insert(of_member.end(), paths.begin(), paths.end());
  for (const char* name : {"failed", "steps", "end [s]"}) of_member.push_back(name);
  ordered_json of_rows{"member", "t [s]"};
  for (const assembly::ProbeColumn& column : columns) {
    for (const char* which : {"greatest", "rms", "last"})
      of_member.push_back(fmt::format("{} {} [{}]", which, column.name, column.unit));
    of_rows.push_back(fmt::format("{} [{}]", column.name, column.unit));
  }
  for (const std::string& probe : estimated) of_member.push_back(fmt::format("estimated error {} [-]", probe));
  for (const std::string& name : of_member) table_ += (table_.empty() ? "" : ",") + cell(name);
  table_ += ",message\n";
  file_ = std::make_unique<output::ResultFile>(PETSC_COMM_SELF, folder_.sweep());
  file_->write_text("scene", scene_text);
  file_->write_text("columns", ordered_json{{"members", of_member}, {"probes", of_rows}}.dump(2));
  file_->add_series("members", static_cast<std::int64_t>(of_member.size()),
                    {"",
                     "one row per member: its number from 1, the varied values, whether it failed (1), steps, time "
                     "reached, maximum absolute value, root mean square over time and last value of each probe; where "
                     "errors are estimated the relative total error of each probe"});
  file_->add_series("probes", static_cast<std::int64_t>(of_rows.size()),
                    {"", "all members in sequence: the member's number, time, probes"});
  file_->publish();
  save("running");
}

void SweepFile::add(const std::vector<scene::Variation>& variations, const Member& member) {
  const bool failed = !member.fault.empty();
  std::vector<double> row{static_cast<double>(++members_)};
  for (const scene::Variation& each : variations) row.push_back(each.value);
  row.insert(row.end(), {failed ? 1.0 : 0.0, static_cast<double>(member.steps), member.end});
  for (std::size_t c = 0; c < columns_.size(); ++c)
    for (const auto* values : {&member.greatest, &member.rms, &member.last})
      row.push_back(failed ? none : (*values)[c]);
  for (std::size_t p = 0; p < estimated_; ++p) row.push_back(failed ? none : member.errors[p]);
  for (const std::vector<double>& instant : member.rows) {
    std::vector<double> numbers{static_cast<double>(members_)};
    numbers.insert(numbers.end(), instant.begin(), instant.end());
    file_->append("probes", numbers);
  }
  file_->append("members", row);
  for (std::size_t i = 0; i < row.size(); ++i)
    table_ += (i == 0 ? "" : ",") + (std::isnan(row[i]) ? std::string() : fmt::format("{}", row[i]));
  table_ += "," + cell(member.fault) + "\n";
  for (const std::string& warning : member.warnings) note(variations, warning);
  if (!failed) return;
  ++failed_;
  summary_["failures"].push_back({{"member", members_}, {"reason", member.fault}});
}

void SweepFile::note(const std::vector<scene::Variation>& variations, const std::string& warning) {
  const auto [at, is_new] = warning_of_.emplace(without_numbers(warning), warnings_.size());
  if (is_new) warnings_.push_back({warning, {}, variations});
  std::vector<std::int64_t>& members = warnings_[at->second].members;
  if (members.empty() || members.back() != members_) members.push_back(members_);
}

void SweepFile::save(const std::string& status) {
  summary_["status"] = status;
  summary_["done"] = members_;
  summary_["failed"] = failed_;
  summary_["warnings"] = ordered_json::array();
  for (const SweepWarning& warning : warnings_) {
    ordered_json& j = summary_["warnings"].emplace_back(ordered_json{{"text", warning.text}});
    for (const scene::Variation& each : warning.of) j["first"][each.path] = each.value;
    j["members"] = warning.members;
  }
  output::write_file_atomically(folder_.sweep_table(), table_);
  output::write_summary(PETSC_COMM_SELF, folder_, summary_);
}

void SweepFile::finish(const std::string& status) {
  file_->finish();
  save(status);
}

}  // namespace floe::app
