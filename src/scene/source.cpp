#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

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

// Where a second document starts, if there is one. YAML::LoadAll shows it, too, but never returns from a text that
// begins with a comma: it takes it for empty documents without end.
class DocumentStarts : public YAML::EventHandler {
 public:
  std::vector<YAML::Mark> starts;
  void OnDocumentStart(const YAML::Mark& mark) override { starts.push_back(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

std::vector<YAML::Mark> first_two_documents(const std::string& text) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  DocumentStarts handler;
  if (parser.HandleNextDocument(handler)) parser.HandleNextDocument(handler);
  return handler.starts;
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
  YAML::Node root;
  std::vector<YAML::Mark> documents;
  try {
    documents = first_two_documents(text);
    root = YAML::Load(text);
  } catch (const YAML::DeepRecursion& error) {
    throw InputError(
        fmt::format("{}:{}:{}: is nested too deeply for a scene", file, error.mark.line + 1, error.mark.column + 1));
  } catch (const YAML::Exception& error) {
    throw InputError(
        fmt::format("{}:{}:{}: is not valid YAML: {}", file, error.mark.line + 1, error.mark.column + 1, error.msg));
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: is not valid YAML: {}", file, error.what()));
  }
  if (documents.size() > 1) {
    throw InputError(fmt::format("{}:{}:{}: does not belong to the first YAML document; expected one", file,
                                 documents[1].line + 1, documents[1].column + 1));
  }
  if (root.IsNull()) throw InputError(file + ": is empty; expected a scene");
  return {root, {file, 1, 1, ""}};
}

}  // namespace floe::scene
