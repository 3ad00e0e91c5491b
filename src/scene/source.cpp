#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "document.h"

namespace floe::scene {
namespace {

constexpr std::size_t largest = 16u << 20;  // bytes

bool utf8(const std::string& text) {
  int expected = 0;
  for (const char character : text) {
    const auto byte = static_cast<unsigned char>(character);
    if (byte == 0) return false;
    if (expected > 0) {
      if ((byte & 0xC0) != 0x80) return false;
      --expected;
    } else if (byte >= 0x80) {
      expected = (byte & 0xE0) == 0xC0 ? 1 : (byte & 0xF0) == 0xE0 ? 2 : (byte & 0xF8) == 0xF0 ? 3 : -1;
      if (expected < 0) return false;
    }
  }
  return expected == 0;
}

}  // namespace

std::string read_text(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw InputError(path + ": is a folder; expected a scene file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  std::string text(largest + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) throw InputError(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > largest) throw InputError(fmt::format("{}: is larger than {} MiB", path, largest >> 20));
  return text;
}

Value parse_yaml(const std::string& text, const std::string& file) {
  if (!utf8(text)) throw InputError(file + ": is not a text file; expected a scene in YAML (UTF-8)");
  std::vector<YAML::Node> documents;
  try {
    documents = YAML::LoadAll(text);
  } catch (const YAML::DeepRecursion& error) {
    throw InputError(
        fmt::format("{}:{}:{}: is nested deeper than any scene", file, error.mark.line + 1, error.mark.column + 1));
  } catch (const YAML::Exception& error) {
    throw InputError(
        fmt::format("{}:{}:{}: is not valid YAML: {}", file, error.mark.line + 1, error.mark.column + 1, error.msg));
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: is not valid YAML: {}", file, error.what()));
  }
  if (documents.empty() || documents[0].IsNull()) throw InputError(file + ": is empty; expected a scene");
  if (documents.size() > 1) {
    throw InputError(fmt::format("{}:{}: holds {} YAML documents; expected one scene", file,
                                 documents[1].Mark().line + 1, documents.size()));
  }
  return {documents[0], {file, 1, 1, ""}};
}

}  // namespace floe::scene
