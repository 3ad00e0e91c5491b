#include "share.h"

#include <cmath>
#include <sstream>

#include "floe/error.h"

namespace floe::generate {
namespace {

template <class Value>
std::string text_of(const Value& value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

void Checks::require(bool good, const std::string& text) {
  if (!good) faults_.push_back(of_ + ": " + text);
}

void Checks::at_least(PetscInt least, const std::string& name, PetscInt value) {
  require(value >= least, name + " = " + std::to_string(value) + ", expected at least " + std::to_string(least));
}

void Checks::finite(const std::string& name, const Eigen::Vector3d& value) {
  require(value.allFinite(), name + " = (" + text_of(value.transpose()) + ") has coordinates that are not finite");
}

void Checks::positive(const std::string& name, double value) {
  require(std::isfinite(value) && value > 0, name + " = " + text_of(value) + ", expected a number above 0");
}

void Checks::finish() const {
  if (!faults_.empty()) throw InputError(faults_);
}

void require_countable(const std::string& source, double nodes, double cells) {
  constexpr auto most = PETSC_MAX_INT;
  if (nodes < static_cast<double>(most) && cells < static_cast<double>(most)) return;
  throw InputError(source + ": " + text_of(nodes) + " nodes and " + text_of(cells) +
                   " elements, above the limit of this build, " + std::to_string(most) +
                   ": use a build on petsc64 (PETSc with 64-bit indices)");
}

}  // namespace floe::generate
