#include "replaceable.h"

#include <fstream>
#include <nlohmann/json.hpp>

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

namespace {

std::string first_bytes(const fs::path& path, std::size_t count) {
  std::ifstream file(path);
  std::string start(count, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(file.gcount());
  return start;
}

}  // namespace

bool is_own_xdmf(const fs::path& path) {
  const std::string start = first_bytes(path, 512), before = "<Information Name=\"program\" Value=\"floe\"/>";
  return start.empty() || start.find(xdmf_mark) != std::string::npos || start.find(before) != std::string::npos;
}

bool is_own_json(const fs::path& path) {
  std::ifstream file(path);
  const auto json = nlohmann::json::parse(file, nullptr, false);
  return json.is_object() && json.contains("provenance") && json["provenance"].is_object() &&
         json["provenance"].contains("floe");
}

bool is_own_page(const fs::path& path) {
  const std::string start = first_bytes(path, 400);
  return start.empty() || start.find("<meta name=\"generator\" content=\"floe\">") != std::string::npos;
}

bool is_series(const fs::path& path) {
  const std::string start = first_bytes(path, 3);
  return start.empty() || start == "t [";
}

}  // namespace floe::output
