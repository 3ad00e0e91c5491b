#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dataset.h"
#include "floe/output/hdf5.h"
#include "floe/output/result_file.h"

namespace floe::output {

/// What is wrong with a dataset, without the file's name.
class Fault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Properties to create a file, a group or a dataset with: without times, so that the same numbers give the same file,
/// and in the order of creation, which has HDF5 write headers with checksums.
Hid plain_object(hid_t kind);

/// A dataset of float64 or int64, groups made on the way, its space allocated at once.
template <class Number>
Hid create_dataset(hid_t file, const std::string& name, const Extent& shape, const Label& label);

/// Writes a block of it; on an MPI-IO file all ranks together, also those with nothing to write.
template <class Number>
void write_rows(hid_t dataset, const Extent& start, const Extent& count, std::span<const Number> data, bool parallel);

/// Texts of one length, filled up with zeros. Rank-local.
void write_texts(hid_t file, const std::string& name, const std::vector<std::string>& texts, const Label& label);
void write_text(hid_t file, const std::string& name, const std::string& text);

void write_flag(hid_t file, const std::string& name, std::int64_t value);

/// A whole array. Rank-local. @throws std::invalid_argument  `data` does not fill `shape`
template <class Number>
void write_whole(hid_t file, const std::string& name, const Extent& shape, std::span<const Number> data,
                 const Label& label);

/// A length that the file may choose.
constexpr hsize_t any = ~hsize_t{0};

/// Reads whole arrays of float64 or int64; numbers must be finite.
///
/// @param shape  expected; `any` becomes what is found
/// @throws Fault  the dataset, what was expected of it, what was found
template <class Number>
std::vector<Number> read_whole(hid_t file, const std::string& name, Extent& shape);
template <class Number>
std::vector<Number> read_whole(hid_t file, const std::string& name, Extent&& shape) {
  return read_whole<Number>(file, name, shape);
}
/// A block of such an array of this shape. @throws Fault
template <class Number>
std::vector<Number> read_block(hid_t file, const std::string& name, const Extent& shape, const Extent& start,
                               const Extent& count);
std::vector<std::string> read_texts(hid_t file, const std::string& name);
std::string read_text(hid_t file, const std::string& name);
/// @throws Fault  there is none
std::int64_t read_flag(hid_t file, const std::string& name);

[[noreturn]] void fail(const std::string& dataset, const std::string& expected, std::string found);

}  // namespace floe::output
