#pragma once
#include <set>

#include "moved_text.h"

namespace floe::scene {

/// `reduction` of a copied body: in the labels of `columns`, as `attachment root.moment` or `derivative 1,root.moment`,
/// the joints and loads that are copied have the names of their copies. Any other node is returned as it is.
/// @param prefix  of the names of copies
YAML::Node with_renamed_columns(const YAML::Node& reduction, const std::set<std::string>& copied,
                                const std::string& prefix);

}  // namespace floe::scene
