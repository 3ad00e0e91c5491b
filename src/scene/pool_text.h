#pragma once
#include <map>

#include "floe/scene/pool.h"

namespace floe::scene {

/// The scene's text with the selected columns in its bodies, in place of what their reduction says of columns, and the
/// steps of a motion.
/// @param files  bodies that are read from these instead
std::string pool_text(const Scene& scene, const std::vector<PoolColumn>& columns, const Selection& selection,
                      const Motion& motion, const std::map<std::string, std::string>& files,
                      bool share_frames);

}  // namespace floe::scene
