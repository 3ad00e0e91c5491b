#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "floe/error.h"

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

}  // namespace floe::output
