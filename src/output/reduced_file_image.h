#pragma once
#include <vector>

#include "floe/output/hdf5.h"
#include "floe/output/reduced_file.h"

namespace floe::output {

constexpr const char* reduced_format = "floe reduced body";
constexpr int reduced_version = 5;  ///< the newest; all from 1 on are read

struct Image {
  std::vector<char> bytes;
  std::int64_t checksum;  ///< of all names, numbers and texts; also the file's attribute
};

/// An HDF5 file in memory, and its bytes. Rank-local: a full disk never meets HDF5.
Hid create_image();
std::vector<char> bytes_of(hid_t memory);

/// The bytes of an HDF5 file that holds all but the shapes. Rank-local, in memory: a full disk never meets HDF5, whose
/// 1.10 cannot close a file that could not be written. HDF5's own structure carries checksums, too.
///
/// @param complete  the attribute of that name
/// @throws std::invalid_argument  sizes that do not fit
Image image_of(const ReducedBodyFile& file, bool complete);

/// Opens such bytes as a file.
Hid open_image(std::vector<char>& bytes);

/// Takes everything from an open file. Rank-local. @throws Fault
ReducedBodyFile parse(hid_t file);

/// What parse() cannot see while it reads: pairs, names, kinds, the frame. @throws Fault
void check_contents(const ReducedBodyFile& file);

}  // namespace floe::output
