// Reduced bodies. An input that begins as HDF5 does is a file. Any other is a list of changes to a sound file, such as
// no damage to bytes would make past HDF5's own checksums: numbers, shapes, types, what is missing, what is else.
#include <array>
#include <cstring>
#include <vector>

#include "floe/output/reduced_file.h"
#include "reduced_file_hdf5.h"
#include "reduced_file_image.h"
#include "session.h"

namespace {

using namespace floe;
using namespace floe::output;

constexpr std::array datasets{"body/name",
                              "body/dimension",
                              "body/dofs",
                              "body/nodes",
                              "body/cells",
                              "inertia/m",
                              "inertia/s0",
                              "inertia/C0",
                              "inertia/S",
                              "inertia/h",
                              "inertia/M",
                              "inertia/W",
                              "line/m",
                              "line/h",
                              "line/M",
                              "elasticity/bending",
                              "elasticity/F",
                              "elasticity/pairs",
                              "damping",
                              "places/names",
                              "places/x",
                              "places/S",
                              "places/psi",
                              "places/H",
                              "columns/kind",
                              "columns/label",
                              "columns/omega",
                              "columns/kept",
                              "frequencies/omega",
                              "frequencies/residual",
                              "frame/kind",
                              "frame/origin",
                              "frame/axes",
                              "made/scene",
                              "made/ranks",
                              "made/phases",
                              "made/seconds",
                              "elasticity",
                              "places",
                              "columns/new_part",
                              "columns/interaction"};
constexpr std::array attributes{"format", "version", "complete", "shapes", "checksum"};

/// Two coordinates, two places: every dataset has entries.
ReducedBodyFile sound() {
  constexpr int d = 2, k = 2;
  ReducedBodyFile file;
  file.name = "arm";
  file.dofs = 12, file.nodes = 4, file.cells = 3;
  body::Inertia inertia(d, k);
  inertia.m = 1;
  inertia.C0.setIdentity(), inertia.S.setOnes();
  inertia.allocate_rotary();
  file.body.inertia = file.body.line = inertia;
  file.body.elasticity.bending = Eigen::MatrixXd::Identity(k, k);
  file.body.elasticity.pairs = {{0, 0}, {0, 1}, {1, 1}};
  file.body.elasticity.F = Eigen::MatrixXd::Ones(4, k + 3);
  file.damping = Eigen::MatrixXd::Identity(k, k);
  for (const char* name : {"start", "end"})
    file.places.push_back({name, {Eigen::Vector2d(0, 1), Eigen::MatrixXd::Ones(d, k), Eigen::MatrixXd::Ones(1, k)}});
  file.columns = {{"mode", "mode 1", 10, 1, true, 0}, {"derivative", "derivative 1,1", 0, 0.5, true, 1}};
  file.omega = {10}, file.residual = {1e-12};
  file.frame = {"pinned", Eigen::Vector2d::Zero(), Eigen::MatrixXd::Identity(d, d)};
  file.made = {"0.1.0", "abc", "2024-05-06T07:08:09Z", "floe reduce", "", "bodies: {}\n", 1, {{"modes", 0.1}}};
  return file;
}

/// The input, a few bytes at a time; zeros behind its end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  bool any() const { return left_ > 0; }
  template <class Value>
  Value take() {
    Value value{};
    const std::size_t count = std::min(left_, sizeof value);
    std::memcpy(&value, data_, count);
    data_ += count, left_ -= count;
    return value;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

hid_t type_of(std::uint8_t choice) {
  constexpr int known = 6;
  switch (choice % known) {
    case 0:
      return H5Tcopy(H5T_NATIVE_DOUBLE);
    case 1:
      return H5Tcopy(H5T_NATIVE_INT64);
    case 2:
      return H5Tcopy(H5T_NATIVE_FLOAT);
    case 3:
      return H5Tcopy(H5T_STD_U8BE);
    case 4: {
      const hid_t text = H5Tcopy(H5T_C_S1);
      H5Tset_size(text, choice < 128 ? 3 : H5T_VARIABLE);
      return text;
    }
    default:
      return H5Tcreate(H5T_COMPOUND, 8);
  }
}

/// A dataset of another shape or type in place of one, never written: HDF5's zeros.
void replace(hid_t file, const char* name, Bytes& bytes) {
  H5Ldelete(file, name, H5P_DEFAULT);
  const hid_t type = type_of(bytes.take<std::uint8_t>());
  Extent shape(bytes.take<std::uint8_t>() % 5);
  for (hsize_t& length : shape) {
    const auto step = bytes.take<std::uint8_t>();
    constexpr int great[] = {31, 32, 33, 61, 62, 63};  // powers of two; they fill no memory until they are read
    length = step < 250 ? step % 7 : hsize_t{1} << great[step - 250];
  }
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t made = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (made >= 0) H5Dclose(made);
  H5Sclose(space), H5Tclose(type);
}

/// One number, or some letters, of a dataset.
void set_entry(hid_t file, const char* name, Bytes& bytes) {
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
  if (dataset < 0) return;
  const hid_t type = H5Dget_type(dataset), space = H5Dget_space(dataset);
  const auto count = H5Sget_simple_extent_npoints(space);
  const auto size = H5Tget_size(type) * static_cast<std::size_t>(std::max<hssize_t>(count, 0));
  if (size > 0 && size < (1 << 16) && H5Tis_variable_str(type) <= 0) {
    std::vector<char> all(size);
    H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
    const std::size_t at = bytes.take<std::uint8_t>() * std::size_t{8} % size;
    const auto value = bytes.take<std::array<char, 8>>();
    std::memcpy(all.data() + at, value.data(), std::min<std::size_t>(8, size - at));
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
  }
  H5Sclose(space), H5Tclose(type), H5Dclose(dataset);
}

void change(hid_t file, Bytes& bytes) {
  const auto what = bytes.take<std::uint8_t>(), which = bytes.take<std::uint8_t>();
  const char* name = datasets[which % datasets.size()];
  switch (what % 6) {
    case 0:
    case 1:
      return set_entry(file, name, bytes);
    case 2:
      return replace(file, name, bytes);
    case 3:
      H5Ldelete(file, name, H5P_DEFAULT);
      return;
    case 4: {
      H5Ldelete(file, name, H5P_DEFAULT);
      const hid_t group = H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      if (group >= 0) H5Gclose(group);
      return;
    }
    default: {
      const char* attribute = attributes[which % attributes.size()];
      H5Adelete(file, attribute);
      const hid_t type = type_of(bytes.take<std::uint8_t>());
      const hsize_t length = bytes.take<std::uint8_t>() % 3;
      const hid_t space = H5Screate_simple(1, &length, nullptr);
      const hid_t made = H5Acreate2(file, attribute, type, space, H5P_DEFAULT, H5P_DEFAULT);
      if (made >= 0) H5Aclose(made);
      H5Sclose(space), H5Tclose(type);
    }
  }
}

std::vector<char> changed(Bytes bytes) {
  static const std::vector<char> whole = image_of(sound(), true).bytes;
  std::vector<char> image = whole;
  const Hid access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, 1 << 16, false);
  H5Pset_file_image(access, image.data(), image.size());
  const Hid file(H5Fopen("changed", H5F_ACC_RDWR, access), H5Fclose);
  for (int i = 0; i < 12 && bytes.any(); ++i) change(file, bytes);
  H5Eclear2(H5E_DEFAULT);
  return bytes_of(file);
}

/// As read_reduced_body, without the file's checksum.
void read_changed(std::vector<char> image) {
  try {
    image_of(parse(open_image(image)), true);
  } catch (const Fault& fault) {
    throw InputError(fault.what());
  } catch (const RunError& hdf5) {
    throw InputError(hdf5.what());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::File file;
  silence_hdf5();
  if (size >= 4 && std::memcmp(data, "\x89HDF", 4) == 0) {
    file.put(data, size);
    fuzz::try_to([] { output::read_reduced_body(MPI_COMM_SELF, file.path()); });
  } else {
    fuzz::try_to([&] { read_changed(changed({data, size})); });
  }
  return 0;
}
