#pragma once
#include <algorithm>
#include <string>
#include <vector>

namespace floe::app {

/// `notices` of each, each once: the parts of a split body have the same mesh.
template <class Bodies>
std::vector<std::string> notices_of(const Bodies& bodies) {
  std::vector<std::string> all;
  for (const auto& body : bodies)
    for (const std::string& notice : body.notices)
      if (std::find(all.begin(), all.end(), notice) == all.end()) all.push_back(notice);
  return all;
}

}  // namespace floe::app
