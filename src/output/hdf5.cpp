#include "floe/output/hdf5.h"

namespace floe::output {
namespace {

herr_t innermost(unsigned, const H5E_error2_t* error, void* reason) {
  if (error->desc && *error->desc) *static_cast<std::string*>(reason) = error->desc;
  return 0;
}

/// HDF5 wraps the system's reason: "file write failed: time = ..., errno = 28, error message = '...', buf = ...".
std::string plain(std::string reason) {
  const std::string before = "error message = '";
  const auto start = reason.find(before);
  if (start == std::string::npos) return reason;
  reason.erase(0, start + before.size());
  return reason.substr(0, reason.find('\''));
}

}  // namespace

void silence_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

void check_hdf5(herr_t status) {
  if (status >= 0) return;
  std::string reason = "HDF5 gives no reason";
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, innermost, &reason);
  H5Eclear2(H5E_DEFAULT);
  throw RunError(plain(reason));
}

Hid::Hid(hid_t id, Close how) : id_(id), close_(how) {
  if (id < 0) check_hdf5(-1);
}

void Hid::close() {
  if (id_ >= 0) check_hdf5(close_(std::exchange(id_, -1)));
}

}  // namespace floe::output
