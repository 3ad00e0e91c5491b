#pragma once
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "floe/output/result_file.h"
#include "sweep.h"

namespace floe::app {

/// Where rank 0 keeps a sweep: sweep.h5, sweep.csv and summary.json, all whole at every moment.
class SweepFile {
 public:
  /// @param paths    of what is varied
  /// @param columns    of the probes, with units
  /// @param estimated  the probes whose errors are estimated
  SweepFile(const output::ResultFolder& folder, const std::string& scene_text, nlohmann::ordered_json summary,
            const std::vector<std::string>& paths, const std::vector<assembly::ProbeColumn>& columns,
            const std::vector<std::string>& estimated);
  /// The next member. @throws RunError
  void add(const std::vector<scene::Variation>& variations, const Member& member);
  /// Brings sweep.csv and summary.json up to date. @throws RunError
  void save(const std::string& status);
  /// The last of it.
  void finish(const std::string& status);
  std::int64_t failed() const { return failed_; }
  /// Of the members so far, in the order in which they came up.
  const std::vector<SweepWarning>& warnings() const { return warnings_; }

 private:
  void note(const std::vector<scene::Variation>& variations, const std::string& warning);

  output::ResultFolder folder_;
  nlohmann::ordered_json summary_;
  std::vector<assembly::ProbeColumn> columns_;
  std::size_t estimated_;
  std::unique_ptr<output::ResultFile> file_;
  std::string table_;  // of sweep.csv
  std::int64_t members_ = 0, failed_ = 0;
  std::vector<SweepWarning> warnings_;
  std::map<std::string, std::size_t> warning_of_;  // by words, without their numbers
};

}  // namespace floe::app
