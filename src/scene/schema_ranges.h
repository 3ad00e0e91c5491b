#pragma once
#include <cmath>

#include "floe/scene/schema.h"

/// What most keys of the grammar accept.
namespace floe::scene {

inline constexpr double inf = INFINITY;
inline constexpr Range any{};
inline constexpr Range positive{0, inf, true, true};
inline constexpr Range nonnegative{0, inf, false, true};
inline constexpr Range counts{1, 1e8};
inline constexpr const char* required = Key::required;

}  // namespace floe::scene
