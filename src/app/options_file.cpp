#include "options_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace floe::app {
namespace {

using Words = std::vector<std::string>;

/// PETSc's own rule (PetscOptionsValidKey): a dash, and a letter after it.
bool is_option(const std::string& word) {
  const std::size_t dashes = word.rfind("--", 0) == 0 ? 2 : 1;
  return word.size() > dashes && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[dashes]));
}

/// The words of a line before its comment; text in double quotes is one.
Words words_of(std::string line) {
  line = line.substr(0, line.find('#'));
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return std::iscntrl(c); }, ' ');
  Words words;
  std::istringstream rest(line);
  for (std::string word; rest >> word;) {
    if (word[0] == '"' && (word.size() == 1 || word.back() != '"')) {
      std::string more;
      std::getline(rest, more, '"');
      word += more;
    }
    words.push_back(word);
  }
  return words;
}

/// Empty, or what is wrong with the words of a line.
std::string fault_of(const Words& words) {
  if (words.empty()) return "";
  const bool alias = words[0] == "alias" || words[0] == "ALIAS";
  if (alias && words.size() == 3 && is_option(words[1]) && is_option(words[2])) return "";
  if (alias) return "alias has no two options after it; expected alias -NEW -OLD";
  if (!is_option(words[0]))
    return fmt::format("\"{}\" is not an option; expected -NAME VALUE, or # before a comment", words[0]);
  if (words.size() > 2) return fmt::format("\"{}\" follows option and value; expected one option in a line", words[2]);
  return "";
}

/// Empty, or the first fault of a file.
std::string fault_of_file(const std::string& path) {
  std::ifstream file(path);
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (const std::string fault = fault_of(words_of(line)); !fault.empty())
      return fmt::format("{}:{}: {}", path, number, fault);
  }
  return "";
}

/// Those that PETSc reads whether it is asked to or not.
Words files_of_petsc() {
  Words files = {".petscrc", "petscrc"};
  if (const char* home = std::getenv("HOME")) files.push_back(std::string(home) + "/.petscrc");
  return files;
}

}  // namespace

std::vector<std::string> take_bad_option_files(Words& words) {
  Words faults, kept;
  bool skips = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const std::string value = i + 1 < words.size() && !is_option(words[i + 1]) ? words[i + 1] : "";
    std::string fault;
    if (word == "-options_file" && value.empty())
      fault = "option -options_file: has no file after it";
    else if (word == "-options_file" && std::ifstream(value).peek() == EOF)
      fault = fmt::format("option -options_file: {} cannot be read, or is empty", value);
    else if (word == "-options_file")
      fault = fault_of_file(value);
    else if (word == "-options_file_yaml" || word == "-options_string_yaml")
      fault = fmt::format("option {}: is not read; expected -options_file FILE, one option in a line", word);
    skips = skips || word == "-skip_petscrc";
    if (fault.empty()) {
      kept.push_back(word);
      continue;
    }
    faults.push_back(fault);
    if (!value.empty()) ++i;
  }
  words = kept;
  std::error_code ignored;
  bool bad = false;
  for (const std::string& file : skips ? Words() : files_of_petsc())
    if (std::filesystem::is_regular_file(file, ignored))
      if (const std::string fault = fault_of_file(file); !fault.empty()) faults.push_back(fault), bad = true;
  if (bad) words.push_back("-skip_petscrc");
  return faults;
}

}  // namespace floe::app
