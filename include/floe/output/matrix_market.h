#pragma once
#include <petscmat.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace floe::output {

/// Writes rows and columns of a symmetric matrix in Matrix Market's coordinate format: the lower triangle column by
/// column, without zeros, numbers to the last bit. The order does not depend on the number of ranks.
///
/// @param A         MATSBAIJ
/// @param numbers   of this rank's rows: where they are in the file, from 0; -1 for those that are left out
/// @param rows      of the file; each of 0 ... rows - 1 is one rank's row
/// @param comments  lines at the head of the file
/// @throws InputError  2^31 entries and more; RunError  path and reason. No moment leaves half a file there
/// Collective. Rank 0 takes all entries (24 bytes each) and writes them, through a draft. Source: Boisvert, Pozo and
/// Remington 1996.
void write_matrix_market(Mat A, const std::vector<std::int64_t>& numbers, std::int64_t rows,
                         const std::filesystem::path& path, const std::vector<std::string>& comments);

}  // namespace floe::output
