#pragma once
#include <hdf5.h>
#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "ordered_rows.h"

/// What floe's XDMF files over HDF5 files have in common.
namespace floe::output {

/// As text within XML, also within quotation marks.
std::string escaped(const std::string& text);
/// A DataItem: an array of 8-byte numbers in the HDF5 file DATA.
std::string xdmf_item(const std::string& dimensions, bool integers, const std::string& data,
                      const std::string& dataset);
/// An Attribute of a grid, indented as its part.
std::string xdmf_attribute(const std::string& name, const char* type, const char* centre, const std::string& values);
/// Topology and geometry.
/// @param size  numbers of the mixed topology
std::string xdmf_mesh(std::int64_t cells, const std::string& topology, std::int64_t size, std::int64_t nodes,
                      const std::string& positions, const std::string& data);
/// The file around its grids.
std::string xdmf_document(const std::string& grids);

/// XDMF's mixed topology of rows (four nodes, part, kind): kind, count of nodes for points and lines, nodes.
Integers mixed_topology(const Integers& cells);

/// An XDMF file and the HDF5 file beside it.
struct XdmfPair {
  std::filesystem::path xdmf;
  std::string what;    ///< `shapes`, for messages
  std::string format;  ///< attribute `format` of the data
  std::filesystem::path data() const;
};
/// Refuses a pair that could not be written.
/// @throws InputError  no name that ends in .xdmf; one of both files is there and not `overwrite`, or not floe's; no
///                     file can be made there. Collective; rank 0 alone touches the file system.
void check_pair(MPI_Comm comm, const XdmfPair& pair, bool overwrite);
/// Writes the data by all ranks together into a draft, then its description; an older pair is taken away first, so that
/// no kill leaves half a file, or a description of another one's data.
/// @param bytes  that the data take at most: the disk's room is taken first
/// @param text   of the XDMF file, asked for on rank 0 after the data
/// @throws RunError  path and reason. Collective.
void write_pair(MPI_Comm comm, const XdmfPair& pair, std::uint64_t bytes, const std::function<void(hid_t)>& data,
                const std::function<std::string()>& text);

}  // namespace floe::output
