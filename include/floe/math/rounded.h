#pragma once
#include <string>

namespace floe::math {

/// To so many significant digits, with powers of ten only below 1e-4 and from 1e5 on: 290, 27100, 2.5e-07.
std::string rounded(double value, int digits);

/// `290 %` of the share 2.9; what is no finite number is `beyond 10000 %`.
std::string percent(double share, int digits = 2);

}  // namespace floe::math
