#pragma once
#include <string>
#include <vector>

#include "floe/output/hdf5.h"

/// Numbers of a dataset as anyone would read them: plain H5Fopen, one process.
struct ReadBack {
  std::vector<hsize_t> shape;
  std::vector<double> data;
};

inline floe::output::Hid open_plain(const std::string& path) {
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
}

inline ReadBack read_back(hid_t file, const std::string& name) {
  using floe::output::Hid;
  const Hid dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose), space(H5Dget_space(dataset), H5Sclose);
  ReadBack all;
  all.shape.resize(H5Sget_simple_extent_ndims(space));
  H5Sget_simple_extent_dims(space, all.shape.data(), nullptr);
  all.data.resize(H5Sget_simple_extent_npoints(space));
  floe::output::check_hdf5(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data.data()));
  return all;
}

inline std::string read_text(hid_t object, const std::string& name, bool attribute) {
  using floe::output::Hid;
  const Hid from = attribute ? Hid(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose)
                             : Hid(H5Dopen2(object, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hid type(attribute ? H5Aget_type(from) : H5Dget_type(from), H5Tclose);
  std::string text(H5Tget_size(type), ' ');
  floe::output::check_hdf5(attribute ? H5Aread(from, type, text.data())
                                     : H5Dread(from, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()));
  return text;
}
