#include "replaceable.h"

#include <fstream>

#include "floe/output/hdf5.h"

namespace floe::output {

namespace fs = std::filesystem;

bool is_of_format(const fs::path& path, const std::string& format) {
  std::error_code ignored;
  if (fs::file_size(path, ignored) == 0) return true;
  silence_hdf5();
  try {
    if (H5Fis_hdf5(path.c_str()) <= 0) return false;
    const Hid file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (H5Aexists(file, "format") <= 0) return false;
    const Hid attribute(H5Aopen(file, "format", H5P_DEFAULT), H5Aclose), type(H5Aget_type(attribute), H5Tclose);
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) return false;
    std::string text(H5Aget_storage_size(attribute), '\0');
    check_hdf5(H5Aread(attribute, type, text.data()));
    return text.substr(0, text.find('\0')) == format;
  } catch (const RunError&) {
    return false;
  }
}

bool is_xdmf(const fs::path& path) {
  std::ifstream file(path);
  std::string start(512, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  return file.gcount() == 0 || start.find("<Xdmf") != std::string::npos;
}

}  // namespace floe::output
