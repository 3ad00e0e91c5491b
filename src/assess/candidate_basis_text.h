#pragma once
#include <filesystem>
#include <map>
#include <set>

#include "floe/assess/candidate_basis.h"

namespace floe::assess {

/// The scene's text with the selected columns in its bodies, in place of what their reduction says of columns, and the
/// steps of a motion.
/// @param deformed  bodies that begin deformed: they are not made rigid
/// @param files   bodies that are read from these instead
/// @param folder  where the text will stand: paths in it are taken from there; empty: where the scene stands
std::string candidates_text(const Scene& scene, const std::vector<CandidateVector>& columns, const Selection& selection,
                            const Motion& motion, const std::map<std::string, std::string>& files, bool share_frames,
                            const std::set<std::string>& deformed, const std::filesystem::path& folder = {});

/// The scene's text with the steps of scene.motion and without `accuracy`; `folder` as above.
std::string scene_text(const Scene& scene, const std::filesystem::path& folder);

}  // namespace floe::assess
