#include "document.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <tuple>

#include "floe/math/nearest.h"

namespace floe::scene {
namespace {

// One line per fault, whatever the file contains.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ' || c == 127) c = ' ';
  }
  return text;
}

// `bodies.blade` of `bodies.blade.section.A`.
std::string entry_of(const std::string& key) {
  const auto first = key.find('.');
  return first == std::string::npos ? key : key.substr(0, key.find('.', first + 1));
}

// `bodies.blade.section.A` without the name of the entry, which copies of a body differ in.
std::string without_entry(const std::string& key) {
  return key.substr(0, key.find('.')) + key.substr(entry_of(key).size());
}

}  // namespace

std::string Where::text() const {
  std::string out = file;
  if (line > 0) out += fmt::format(":{}:{}", line, column);
  if (!key.empty()) out += ": " + key;
  return out;
}

void Document::fault(const Where& where, const std::string& wrong, const std::string& expected, const std::string& word,
                     const std::vector<std::string>& known) {
  std::string said = wrong;
  if (!expected.empty()) said += "; expected " + expected;
  if (const std::string near = math::nearest(word, known); !near.empty())
    said += fmt::format("; did you mean \"{}\"?", near);
  faults_.push_back({where.line, where.column, one_line(where.text() + ": " + said), without_entry(where.key) + said,
                     entry_of(where.key)});
}

void Document::fault(const Where& where, const InputError& error) {
  for (const auto& text : error.faults())
    faults_.push_back({where.line, where.column, one_line(text), text, entry_of(where.key)});
}

void Document::throw_faults() const {
  if (faults_.empty()) return;
  auto sorted = faults_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Fault& a, const Fault& b) {
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  });
  std::set<std::string> entries;
  for (const auto& fault : sorted) entries.insert(fault.entry);
  // its own faults are reported once those of the original are mended
  const auto of_original = [&](const Fault& fault) {
    for (auto from = copied.find(fault.entry); from != copied.end(); from = copied.find(from->second))
      if (entries.count(from->second)) return true;
    return false;
  };
  std::vector<std::string> texts;
  std::set<std::tuple<int, int, std::string>> said;  // once, however many copies have the value
  for (const auto& fault : sorted)
    if (!of_original(fault) && said.emplace(fault.line, fault.column, fault.said).second) texts.push_back(fault.text);
  throw InputError(texts);
}

std::string Document::beside(const std::string& path) const {
  return (std::filesystem::path(file).parent_path() / path).lexically_normal().string();
}

std::shared_ptr<const output::ReducedBodyFile> Document::reduced_file(const std::string& path) {
  std::shared_ptr<const output::ReducedBodyFile>& file_of_body = reduced_files_[path];
  if (!file_of_body)
    file_of_body = std::make_shared<const output::ReducedBodyFile>(output::read_reduced_body(PETSC_COMM_SELF, path));
  return file_of_body;
}

Where Document::place_of(const YAML::Mark& mark, const std::string& key) const {
  return {file, mark.line + 1, mark.column + 1, key};
}

}  // namespace floe::scene
