#pragma once
#include <hdf5.h>

#include <string>
#include <utility>

#include "floe/error.h"

namespace floe::output {

/// Owns one HDF5 identifier; moves, never copies, closes at the end of its life.
class Hid {
 public:
  using Close = herr_t (*)(hid_t);
  Hid() = default;
  /// @throws RunError  `id` is negative: the call that made it failed
  Hid(hid_t id, Close how);
  Hid(Hid&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hid& operator=(Hid&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  Hid(const Hid&) = delete;
  Hid& operator=(const Hid&) = delete;
  ~Hid() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }
  /// Closes now.
  /// @throws RunError  what was still to be written could not be
  void close();

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// Throws RunError with HDF5's innermost reason when a call returned a negative status; keeps HDF5 from printing its
/// own.
void check_hdf5(herr_t status);

/// Keeps HDF5 from printing its errors. Called by whoever opens a file.
void silence_hdf5();

}  // namespace floe::output
