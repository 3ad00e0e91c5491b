#pragma once
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "floe/scene/schema.h"

/// What most keys of the grammar accept, and how the less simple ones are written.
namespace floe::scene {

inline constexpr double inf = INFINITY;
inline constexpr Range any{};
inline constexpr Range positive{0, inf, true, true};
inline constexpr Range nonnegative{0, inf, false, true};
inline constexpr Range counts{1, 1e8};
inline constexpr const char* required = Key::required;

/// Of a section of its own.
inline Key part(const char* name, Type type, const char* fallback, const char* text, const char* section) {
  return {name, type, "", fallback, text, any, {}, {}, section};
}
inline Key choice(const char* name, const char* fallback, const char* text, std::vector<std::string> choices) {
  return {name, Type::choice, "", fallback, text, any, std::move(choices)};
}
inline Key in_plane(Key key) {
  key.dimension = 2;
  return key;
}
inline Key in_space(Key key) {
  key.dimension = 3;
  return key;
}
/// Resolved before anything is read (copies.h).
inline Key like(const char* of) {
  return {"like", Type::text, "", "",
          "name of another " + std::string(of) +
              ", all of whose keys this one has unless they are given here (a mapping or list as a whole)"};
}
/// For these kinds of the section alone.
inline Key only(std::vector<std::string> kinds, Key key) {
  key.kinds = std::move(kinds);
  return key;
}

}  // namespace floe::scene
