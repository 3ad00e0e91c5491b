#pragma once
#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "floe/output/hdf5.h"

namespace floe::output {

using Extent = std::vector<hsize_t>;

enum class Open { create, change };

/// Opens result files; with a communicator through MPI-IO (collective), without (MPI_COMM_NULL) by this rank alone.
/// Takes no locks, so that a reader never stops a run.
Hid open_file(const std::filesystem::path& path, Open how, MPI_Comm comm);

/// What is under `name`, if anything.
void remove_object(hid_t file, const std::string& name);

/// A dataset of doubles under `name`, groups made on the way; one that was there is replaced.
Hid create_array(hid_t file, const std::string& name, const Extent& shape);

/// An extendible dataset, rows x columns, in chunks of about 1 MiB that are given their place, full of NaN, as soon as
/// it grows.
Hid create_series(hid_t file, const std::string& name, hsize_t rows, hsize_t columns);

/// Bytes that a series of this size takes in the file, at most.
std::uint64_t series_bytes(std::uint64_t rows, std::uint64_t columns);

/// Rows and columns of a series; empty: there is none.
Extent series_extent(hid_t file, const std::string& name);

/// Makes a series that many rows long; new ones are NaN.
void resize_series(hid_t file, const std::string& name, hsize_t rows);

/// A scalar text, collective where the file is; `writer` gives the bytes.
void write_text_dataset(hid_t file, const std::string& name, const std::string& text, bool writer);

/// A text attribute; nothing for an empty text.
void write_attribute(hid_t object, const std::string& name, const std::string& text);

/// Writes the block `count` at `start` from numbers of a native type. Collective on an MPI-IO file.
/// @param data  row-major, of that shape; null: this rank takes part and writes nothing
void write_hyperslab(hid_t dataset, const Extent& start, const Extent& count, hid_t type, const void* data,
                     bool parallel);

/// Writes the block `count` at `start` from row-major `data` of that shape. Collective on an MPI-IO file; a rank with
/// an empty `data` takes part and writes nothing.
void write_block(hid_t dataset, const Extent& start, const Extent& count, std::span<const double> data, bool parallel);

}  // namespace floe::output
