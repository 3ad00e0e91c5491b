#pragma once
#include <filesystem>
#include <string>

namespace floe::output {

/// Whether --force may replace a file: one that is empty, or HDF5 whose attribute `format` is this. Rank-local.
bool is_of_format(const std::filesystem::path& path, const std::string& format);

/// Likewise an XDMF file. Rank-local.
bool is_xdmf(const std::filesystem::path& path);

}  // namespace floe::output
