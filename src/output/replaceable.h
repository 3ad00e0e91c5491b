#pragma once
#include <filesystem>
#include <string>

namespace floe::output {

/// Whether --force may replace a file: one that is empty, or HDF5 whose attribute `format` is this. Rank-local.
bool is_of_format(const std::filesystem::path& path, const std::string& format);

/// What floe's own XDMF files say of themselves: a comment, for XDMF 3 wants nothing but domains there.
inline const std::string xdmf_mark = "<!-- written by floe -->";
/// Likewise an XDMF file with this mark, or with that of floe before it was a comment. Rank-local.
bool is_own_xdmf(const std::filesystem::path& path);

/// Likewise a page with the mark that src/plot/report.py writes. Rank-local.
bool is_own_page(const std::filesystem::path& path);

/// Whether the file is JSON whose `provenance` names floe. Rank-local.
bool is_own_json(const std::filesystem::path& path);

/// Whether a file may be the probes of a run: one that is empty, or begins with `t [`. Rank-local.
bool is_series(const std::filesystem::path& path);

}  // namespace floe::output
