#pragma once
#include <string>

#include "floe/assembly/model.h"

namespace floe::assembly {

inline constexpr double max_intra_deflection = 0.05;
inline constexpr double max_intra_deflection_of_modes =
    0.1;  ///< the frequencies of plates err by half a per cent there
/// The warning of `mesh`. @param what  `where it bends most`, `mode 1`, `modes 2, 3`
std::string intra_deflection_text(const std::string& body, const std::string& what, double intra_deflection,
                                  double limit);

/// Of modes that have the last one's frequency, but are beyond the count (BodyReport::left_out > 0).
std::string left_out_text(const std::string& body, const BodyReport& report);

}  // namespace floe::assembly
