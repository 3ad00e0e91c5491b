#pragma once
#include <string>
#include <vector>

namespace floe::math {

/// The known word that `word` was probably meant to be: least edit distance (insert, delete, change, swap two
/// neighbours; case counts nothing), if at most a third of the longer word is wrong; or the only one that begins
/// with it or, from four letters on, contains it (without _, - and spaces). Empty when nothing is near. Used for keys,
/// names of scenes and meshes, and options.
std::string nearest(const std::string& word, const std::vector<std::string>& known);

}  // namespace floe::math
