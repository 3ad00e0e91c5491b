#pragma once
#include <cstdint>
#include <filesystem>

namespace floe::output {

/// Gives the file room for a dataset of so many bytes and its description before HDF5 writes it: HDF5 1.10 cannot close
/// a file that met a full disk, and crashes when the program ends.
///
/// @throws RunError  path and reason
/// Rank-local.
void reserve(const std::filesystem::path& path, std::uint64_t dataset);

}  // namespace floe::output
