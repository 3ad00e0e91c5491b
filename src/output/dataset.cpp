#include "dataset.h"

#include <algorithm>
#include <limits>

namespace floe::output {
namespace {

Hid property_list(hid_t kind) { return Hid(H5Pcreate(kind), H5Pclose); }

Hid make_groups() {
  Hid list = property_list(H5P_LINK_CREATE);
  check_hdf5(H5Pset_create_intermediate_group(list, 1));
  return list;
}

/// H5Lexists wants every group on the way to exist.
bool exists(hid_t file, const std::string& name) {
  for (auto slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1))
    if (H5Lexists(file, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0;
}

}  // namespace

void remove_object(hid_t file, const std::string& name) {
  if (exists(file, name)) check_hdf5(H5Ldelete(file, name.c_str(), H5P_DEFAULT));
}

namespace {

Hid create(hid_t file, const std::string& name, hid_t type, hid_t space, hid_t how) {
  remove_object(file, name);
  return Hid(H5Dcreate2(file, name.c_str(), type, space, make_groups(), how, H5P_DEFAULT), H5Dclose);
}

/// Without times of change, so that writing numbers touches nothing but their own place.
Hid plain_dataset() {
  Hid list = property_list(H5P_DATASET_CREATE);
  check_hdf5(H5Pset_obj_track_times(list, false));
  check_hdf5(H5Pset_alloc_time(list, H5D_ALLOC_TIME_EARLY));
  return list;
}

Hid text_type(const std::string& text) {
  Hid type(H5Tcopy(H5T_C_S1), H5Tclose);
  check_hdf5(H5Tset_size(type, std::max<std::size_t>(text.size(), 1)));
  check_hdf5(H5Tset_strpad(type, H5T_STR_NULLPAD));
  check_hdf5(H5Tset_cset(type, H5T_CSET_UTF8));
  return type;
}

/// About 1 MiB, and no more than a short series needs.
Extent chunk_of(hsize_t rows, hsize_t columns) {
  constexpr hsize_t numbers = 131072, few = 1024;
  const hsize_t across = std::min(columns, numbers);
  return {std::clamp<hsize_t>(numbers / across, 1, std::max(rows, few)), across};
}

}  // namespace

Hid open_file(const std::filesystem::path& path, Open how, MPI_Comm comm) {
  silence_hdf5();
  const Hid access = property_list(H5P_FILE_ACCESS);
  check_hdf5(H5Pset_file_locking(access, false, true));
  if (comm != MPI_COMM_NULL) check_hdf5(H5Pset_fapl_mpio(access, comm, MPI_INFO_NULL));
  if (how == Open::create) return Hid(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  return Hid(H5Fopen(path.c_str(), H5F_ACC_RDWR, access), H5Fclose);
}

Hid create_array(hid_t file, const std::string& name, const Extent& shape) {
  const Hid space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Hid how = plain_dataset();
  check_hdf5(H5Pset_fill_time(how, H5D_FILL_TIME_NEVER));  // whoever creates it writes all of it
  return create(file, name, H5T_IEEE_F64LE, space, how);
}

Hid create_series(hid_t file, const std::string& name, hsize_t rows, hsize_t columns) {
  const Extent shape{rows, columns}, most{H5S_UNLIMITED, columns};
  const Extent chunk = chunk_of(rows, columns);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Hid space(H5Screate_simple(2, shape.data(), most.data()), H5Sclose);
  const Hid how = plain_dataset();
  check_hdf5(H5Pset_chunk(how, 2, chunk.data()));
  check_hdf5(H5Pset_fill_value(how, H5T_NATIVE_DOUBLE, &nan));
  return create(file, name, H5T_IEEE_F64LE, space, how);
}

std::uint64_t series_bytes(std::uint64_t rows, std::uint64_t columns) {
  const Extent chunk = chunk_of(rows, columns);
  const auto chunks = [](hsize_t all, hsize_t each) { return (all + each - 1) / each; };
  return chunks(rows, chunk[0]) * chunks(columns, chunk[1]) * (chunk[0] * chunk[1] * sizeof(double) + 256);
}

Extent series_extent(hid_t file, const std::string& name) {
  if (!exists(file, name)) return {};
  const Hid dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose), space(H5Dget_space(dataset), H5Sclose);
  Extent extent(std::max(H5Sget_simple_extent_ndims(space), 0));
  if (!extent.empty()) check_hdf5(H5Sget_simple_extent_dims(space, extent.data(), nullptr));
  return extent;
}

void resize_series(hid_t file, const std::string& name, hsize_t rows) {
  Hid dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hid space(H5Dget_space(dataset), H5Sclose);
  hsize_t now[2] = {};
  check_hdf5(H5Sget_simple_extent_dims(space, now, nullptr));
  const hsize_t wanted[2] = {rows, now[1]};
  check_hdf5(H5Dset_extent(dataset, wanted));
  dataset.close();
}

void write_text_dataset(hid_t file, const std::string& name, const std::string& text, bool writer) {
  const Hid type = text_type(text), space(H5Screate(H5S_SCALAR), H5Sclose), all(H5Screate(H5S_SCALAR), H5Sclose);
  Hid dataset = create(file, name, type, space, plain_dataset());
  if (!writer) {
    check_hdf5(H5Sselect_none(space));
    check_hdf5(H5Sselect_none(all));
  }
  check_hdf5(H5Dwrite(dataset, type, all, space, H5P_DEFAULT, text.c_str()));
  dataset.close();
}

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
  if (text.empty()) return;
  const Hid type = text_type(text), space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hid attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check_hdf5(H5Awrite(attribute, type, text.c_str()));
}

void write_hyperslab(hid_t dataset, const Extent& start, const Extent& count, hid_t type, const void* data,
                     bool parallel) {
  const Hid there(H5Dget_space(dataset), H5Sclose);
  if (H5Sget_simple_extent_npoints(there) == 0) return;  // it has no place in the file
  const Hid here(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose);
  if (!data) {
    check_hdf5(H5Sselect_none(there));
    check_hdf5(H5Sselect_none(here));
  } else if (!count.empty()) {
    check_hdf5(H5Sselect_hyperslab(there, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
  }
  const Hid transfer = property_list(H5P_DATASET_XFER);
  if (parallel) check_hdf5(H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE));
  const double none = 0;  // HDF5 wants an address
  check_hdf5(H5Dwrite(dataset, type, here, there, transfer, data ? data : &none));
}

void write_block(hid_t dataset, const Extent& start, const Extent& count, std::span<const double> data, bool parallel) {
  write_hyperslab(dataset, start, count, H5T_NATIVE_DOUBLE, data.empty() ? nullptr : data.data(), parallel);
}

}  // namespace floe::output
