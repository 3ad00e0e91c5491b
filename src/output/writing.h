#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "floe/error.h"
#include "floe/output/folder.h"

namespace floe::output {

/// Runs rank-local work whose failures are failures to write `path`.
template <class Work>
void writing(const std::filesystem::path& path, Work&& work) {
  try {
    work();
  } catch (const std::filesystem::filesystem_error& fault) {
    throw RunError(fmt::format("cannot write {}: {}", path.string(), fault.code().message()));
  } catch (const RunError& fault) {
    const std::string text = fault.what();
    throw RunError(text.starts_with("cannot write") ? text : fmt::format("cannot write {}: {}", path.string(), text));
  }
}

/// The file's own name for that of its drafts.
inline std::string with_name(std::string text, const std::filesystem::path& path) {
  const std::filesystem::path draft = draft_of(path);
  for (const std::filesystem::path& each : {draft_of(draft), draft})
    if (const auto at = text.find(each.string()); at != std::string::npos)
      text.replace(at, each.string().size(), path.string());
  return text;
}

}  // namespace floe::output
