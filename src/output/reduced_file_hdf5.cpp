#include "reduced_file_hdf5.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <numeric>

namespace floe::output {
namespace {

template <class Number>
constexpr bool real = std::is_same_v<Number, double>;
template <class Number>
hid_t native() {
  return real<Number> ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
}

hsize_t size_of(const Extent& shape) {
  return std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
}

Hid text_type(std::size_t size) {
  Hid type(H5Tcopy(H5T_C_S1), H5Tclose);
  check_hdf5(H5Tset_size(type, size));
  check_hdf5(H5Tset_strpad(type, H5T_STR_NULLPAD));
  check_hdf5(H5Tset_cset(type, H5T_CSET_UTF8));
  return type;
}

/// Groups on the way to a dataset.
void make_groups(hid_t file, const std::string& name) {
  const Hid how = plain_object(H5P_GROUP_CREATE);
  for (auto end = name.find('/'); end != std::string::npos; end = name.find('/', end + 1)) {
    const std::string group = name.substr(0, end);
    if (H5Lexists(file, group.c_str(), H5P_DEFAULT) <= 0)
      Hid(H5Gcreate2(file, group.c_str(), H5P_DEFAULT, how, H5P_DEFAULT), H5Gclose).close();
  }
}

Hid create(hid_t file, const std::string& name, hid_t type, const Extent& shape, const Label& label) {
  make_groups(file, name);
  const Hid how = plain_object(H5P_DATASET_CREATE);
  check_hdf5(H5Pset_alloc_time(how, H5D_ALLOC_TIME_EARLY));
  check_hdf5(H5Pset_fill_time(how, H5D_FILL_TIME_NEVER));
  const Hid space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  Hid dataset(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose);
  write_attribute(dataset, "unit", label.unit);
  write_attribute(dataset, "description", label.description);
  return dataset;
}

std::string shown(const Extent& shape) {
  if (shape.empty()) return "one";
  std::vector<std::string> lengths;
  for (const hsize_t each : shape) lengths.push_back(each == any ? "any" : fmt::format("{}", each));
  return fmt::format("{}", fmt::join(lengths, " x "));
}

void put_texts(hid_t file, const std::string& name, const Extent& shape, const std::vector<std::string>& texts,
               const Label& label) {
  std::size_t length = 1;
  for (const auto& text : texts) length = std::max(length, text.size());
  std::string all;
  for (const auto& text : texts) all += text + std::string(length - text.size(), '\0');
  const Hid type = text_type(length);
  Hid dataset = create(file, name, type, shape, label);
  if (!texts.empty()) check_hdf5(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()));
  dataset.close();
}

/// Each group on the way must exist before its members may be asked for.
Hid open_dataset(hid_t file, const std::string& name) {
  for (std::size_t end = 0; end != std::string::npos;) {
    end = name.find('/', end + 1);
    if (H5Lexists(file, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) fail(name, "a dataset", "none");
  }
  const hid_t id = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (id < 0) fail(name, "a dataset", "something else");
  return Hid(id, H5Dclose);
}

Extent shape_of(hid_t dataset) {
  const Hid space(H5Dget_space(dataset), H5Sclose);
  Extent shape(std::max(0, H5Sget_simple_extent_ndims(space)));
  check_hdf5(H5Sget_simple_extent_dims(space, shape.data(), nullptr));
  return shape;
}

}  // namespace

void fail(const std::string& dataset, const std::string& expected, std::string found) {
  std::replace_if(
      found.begin(), found.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  throw Fault(fmt::format("dataset '{}': expected {}, found {}", dataset, expected, found));
}

Hid plain_object(hid_t kind) {
  Hid how(H5Pcreate(kind), H5Pclose);
  check_hdf5(H5Pset_obj_track_times(how, false));
  check_hdf5(H5Pset_attr_creation_order(how, H5P_CRT_ORDER_TRACKED));
  if (kind != H5P_DATASET_CREATE) check_hdf5(H5Pset_link_creation_order(how, H5P_CRT_ORDER_TRACKED));
  return how;
}

template <class Number>
Hid create_dataset(hid_t file, const std::string& name, const Extent& shape, const Label& label) {
  return create(file, name, real<Number> ? H5T_IEEE_F64LE : H5T_STD_I64LE, shape, label);
}

template <class Number>
void write_rows(hid_t dataset, const Extent& start, const Extent& count, std::span<const Number> data, bool parallel) {
  write_hyperslab(dataset, start, count, native<Number>(), data.empty() ? nullptr : data.data(), parallel);
}

template <class Number>
void write_whole(hid_t file, const std::string& name, const Extent& shape, std::span<const Number> data,
                 const Label& label) {
  if (size_of(shape) != data.size())
    throw std::invalid_argument(fmt::format("{}: {} numbers do not fill {}", name, data.size(), shown(shape)));
  Hid dataset = create_dataset<Number>(file, name, shape, label);
  write_rows(dataset, Extent(shape.size(), 0), shape, data, false);
  dataset.close();
}

void write_texts(hid_t file, const std::string& name, const std::vector<std::string>& texts, const Label& label) {
  put_texts(file, name, {texts.size()}, texts, label);
}

void write_text(hid_t file, const std::string& name, const std::string& text) { put_texts(file, name, {}, {text}, {}); }

void write_flag(hid_t file, const std::string& name, std::int64_t value) {
  const Hid space(H5Screate(H5S_SCALAR), H5Sclose);
  Hid flag = H5Aexists(file, name.c_str()) > 0
                 ? Hid(H5Aopen(file, name.c_str(), H5P_DEFAULT), H5Aclose)
                 : Hid(H5Acreate2(file, name.c_str(), H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check_hdf5(H5Awrite(flag, H5T_NATIVE_INT64, &value));
  flag.close();
}

namespace {

/// A dataset of such numbers; `shape` becomes what is found.
template <class Number>
Hid open_numbers(hid_t file, const std::string& name, Extent& shape, const std::string& expected) {
  Hid dataset = open_dataset(file, name);
  const Hid type(H5Dget_type(dataset), H5Tclose);
  if (H5Tget_class(type) != (real<Number> ? H5T_FLOAT : H5T_INTEGER)) fail(name, expected, "another type");
  const Extent found = shape_of(dataset);
  const auto fits = [](hsize_t wanted, hsize_t is) { return wanted == any || wanted == is; };
  if (!std::equal(shape.begin(), shape.end(), found.begin(), found.end(), fits)) fail(name, expected, shown(found));
  if (size_of(found) > 0 && H5Dget_storage_size(dataset) / size_of(found) != sizeof(Number))
    fail(name, expected, "numbers that are not of 8 bytes");
  shape = found;
  return dataset;
}

template <class Number>
std::string numbers_of(const Extent& shape) {
  return fmt::format("{} {}", shown(shape), real<Number> ? "finite numbers" : "integers");
}

template <class Number>
void check_finite(const std::string& name, const std::string& expected, const std::vector<Number>& data) {
  if constexpr (real<Number>) {
    const auto bad = std::find_if(data.begin(), data.end(), [](double x) { return !std::isfinite(x); });
    if (bad != data.end()) fail(name, expected, fmt::format("{} at entry {}", *bad, bad - data.begin()));
  }
}

}  // namespace

template <class Number>
std::vector<Number> read_whole(hid_t file, const std::string& name, Extent& shape) {
  const std::string expected = numbers_of<Number>(shape);
  const Hid dataset = open_numbers<Number>(file, name, shape, expected);
  std::vector<Number> data(size_of(shape));
  if (!data.empty()) check_hdf5(H5Dread(dataset, native<Number>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()));
  check_finite(name, expected, data);
  return data;
}

template <class Number>
std::vector<Number> read_block(hid_t file, const std::string& name, const Extent& shape, const Extent& start,
                               const Extent& count) {
  Extent found = shape;
  const std::string expected = numbers_of<Number>(shape);
  const Hid dataset = open_numbers<Number>(file, name, found, expected);
  std::vector<Number> data(size_of(count));
  if (data.empty()) return data;
  const Hid there(H5Dget_space(dataset), H5Sclose);
  const Hid here(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose);
  check_hdf5(H5Sselect_hyperslab(there, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
  check_hdf5(H5Dread(dataset, native<Number>(), here, there, H5P_DEFAULT, data.data()));
  check_finite(name, expected, data);
  return data;
}

std::vector<std::string> read_texts(hid_t file, const std::string& name) {
  const Hid dataset = open_dataset(file, name), type(H5Dget_type(dataset), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0)
    fail(name, "texts of one length", "another type");
  const Extent shape = shape_of(dataset);
  const std::size_t length = H5Tget_size(type), count = size_of(shape);
  if (shape.size() > 1) fail(name, "a list of texts", shown(shape));
  if (count > 0 && H5Dget_storage_size(dataset) / count != length) fail(name, "a list of texts", "less");
  std::string all(length * count, '\0');
  if (count > 0) check_hdf5(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()));
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    texts.push_back(all.substr(i * length, length));
    texts.back().erase(texts.back().find_last_not_of('\0') + 1);
  }
  return texts;
}

std::string read_text(hid_t file, const std::string& name) {
  const auto texts = read_texts(file, name);
  if (texts.size() != 1) fail(name, "one text", fmt::format("{}", texts.size()));
  return texts.front();
}

std::int64_t read_flag(hid_t file, const std::string& name) {
  if (H5Aexists(file, name.c_str()) <= 0) throw Fault(fmt::format("expected an attribute '{}', found none", name));
  const Hid flag(H5Aopen(file, name.c_str(), H5P_DEFAULT), H5Aclose), space(H5Aget_space(flag), H5Sclose);
  const Hid type(H5Aget_type(flag), H5Tclose);
  if (H5Sget_simple_extent_npoints(space) != 1 || H5Tget_class(type) != H5T_INTEGER)
    throw Fault(fmt::format("attribute '{}': expected one integer, found something else", name));
  std::int64_t value = 0;
  check_hdf5(H5Aread(flag, H5T_NATIVE_INT64, &value));
  return value;
}

template Hid create_dataset<double>(hid_t, const std::string&, const Extent&, const Label&);
template Hid create_dataset<std::int64_t>(hid_t, const std::string&, const Extent&, const Label&);
template void write_rows(hid_t, const Extent&, const Extent&, std::span<const double>, bool);
template void write_rows(hid_t, const Extent&, const Extent&, std::span<const std::int64_t>, bool);
template void write_whole(hid_t, const std::string&, const Extent&, std::span<const double>, const Label&);
template void write_whole(hid_t, const std::string&, const Extent&, std::span<const std::int64_t>, const Label&);
template std::vector<double> read_whole(hid_t, const std::string&, Extent&);
template std::vector<std::int64_t> read_whole(hid_t, const std::string&, Extent&);
template std::vector<double> read_block(hid_t, const std::string&, const Extent&, const Extent&, const Extent&);
template std::vector<std::int64_t> read_block(hid_t, const std::string&, const Extent&, const Extent&, const Extent&);

}  // namespace floe::output
