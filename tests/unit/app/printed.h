#pragma once
#include <petscsys.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "floe/output/folder.h"

namespace floe::testing {

/// What a command prints on standard output.
template <class Work>
std::string printed(const Work& work) {
  std::fflush(stdout);
  std::FILE* file = std::tmpfile();
  const int terminal = dup(STDOUT_FILENO);
  dup2(fileno(file), STDOUT_FILENO);
  const auto back = [&] {
    std::fflush(stdout);
    dup2(terminal, STDOUT_FILENO);
    close(terminal);
  };
  try {
    work();
  } catch (...) {
    back();
    std::fclose(file);
    throw;
  }
  back();
  std::string text(static_cast<std::size_t>(std::ftell(file)), ' ');
  std::rewind(file);
  text.resize(std::fread(text.data(), 1, text.size(), file));
  std::fclose(file);
  return text;
}

/// Columns of a CSV file by their heads.
inline std::map<std::string, std::vector<std::string>> columns_of(const std::filesystem::path& path) {
  const auto cells = [](const std::string& line) {
    std::vector<std::string> all(1);
    for (const char c : line) {
      if (c == ',')
        all.emplace_back();
      else
        all.back() += c;
    }
    return all;
  };
  std::ifstream file(path);
  std::string line;
  std::vector<std::string> heads;
  while (heads.empty() && std::getline(file, line))
    if (!line.starts_with('#')) heads = cells(line);
  std::map<std::string, std::vector<std::string>> columns;
  while (std::getline(file, line)) {
    const std::vector<std::string> row = cells(line);
    for (std::size_t i = 0; i < heads.size(); ++i) columns[heads[i]].push_back(i < row.size() ? row[i] : "");
  }
  return columns;
}

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A folder of this test case that goes with it.
struct OwnFolder {
  std::filesystem::path path;
  OwnFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "floe-app-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no folder");
    path = name;
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
  ~OwnFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  output::ResultFolder results(const std::string& name) const {
    return output::prepare_folder(PETSC_COMM_WORLD, path / name, false);
  }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name, std::ios::binary) << text;
    return (path / name).string();
  }
};

}  // namespace floe::testing
