#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace floe {

/// What the user gave cannot be used: a scene, a place, an option, a folder. Exit code 2.
///
/// Holds one line per fault, so that a scene's faults are all told at once.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& fault) : InputError(std::vector<std::string>{fault}) {}
  explicit InputError(std::vector<std::string> faults)
      : std::runtime_error(joined(faults)), faults_(std::move(faults)) {}
  const std::vector<std::string>& faults() const { return faults_; }

 private:
  static std::string joined(const std::vector<std::string>& faults) {
    std::string all;
    for (const auto& fault : faults) all += (all.empty() ? "" : "\n") + fault;
    return all;
  }
  std::vector<std::string> faults_;
};

/// The input was good and the run failed all the same: a solver did not converge, a file could not be written. Exit
/// code 1.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace floe
