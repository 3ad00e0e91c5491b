#include "inp_blocks.h"

#include <filesystem>

#include "floe/error.h"
#include "text.h"

namespace floe::mesh {
namespace {

constexpr int most_includes = 20;  // inside each other

std::string_view unquoted(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

bool is_data(std::string_view line) { return !trimmed(line).empty() && !trimmed(line).starts_with("**"); }

// A keyword line with those that continue it, which follow a comma at the end.
std::string keyword_line(std::string_view line, const char*& at, const char* end, long long& number) {
  std::string whole(trimmed(line));
  while (whole.ends_with(',') && at != end && *at != '*') {
    whole += trimmed(next_line(at, end));
    ++number;
  }
  return whole;
}

InpBlock block_of(const std::string& line, Where where, Faults& faults) {
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  InpBlock block{where, std::string(fields.empty() ? line : fields[0]), "", {}, {}};
  block.keyword = folded(block.name).substr(1);
  for (std::size_t i = 1; i < fields.size(); ++i) {
    const auto equals = fields[i].find('=');
    const std::string key = folded(fields[i].substr(0, equals));
    const auto value = equals == std::string_view::npos ? std::string_view() : unquoted(fields[i].substr(equals + 1));
    if (key.empty()) continue;
    if (!block.parameters.emplace(key, value).second) faults.add(where, "parameter " + key + " is given twice");
  }
  return block;
}

void walk(const std::string& path, int depth, InpBlocks& result, Faults& faults);

void include(const InpBlock& block, const std::string& from, int depth, InpBlocks& result, Faults& faults) {
  const auto input = block.parameters.find("INPUT");
  if (input == block.parameters.end() || input->second.empty())
    return faults.add(block.where, "*INCLUDE expects INPUT=file");
  if (depth == most_includes)
    throw InputError(faults.text_of(block.where) + ": *INCLUDE goes more than " + std::to_string(most_includes) +
                     " files deep: does a file include itself?");
  const std::filesystem::path path(input->second);
  try {
    walk(path.is_absolute() ? path.string() : (std::filesystem::path(from).parent_path() / path).string(), depth + 1,
         result, faults);
  } catch (const InputError& error) {
    throw InputError(std::string(error.what()) + " (included from " + faults.text_of(block.where) + ")");
  }
}

void walk(const std::string& path, int depth, InpBlocks& result, Faults& faults) {
  result.files.push_back(std::make_unique<MappedFile>(path));
  const auto text = result.files.back()->text();
  const int file = faults.add_file(path);
  const char *at = text.data(), *end = at + text.size();
  bool stray = false, skipping = false;
  InpLines* lines = nullptr;
  for (long long number = 1; at != end; ++number) {
    const char* begin = at;
    const auto line = trimmed(next_line(at, end));
    if (line.starts_with('*') && !line.starts_with("**")) {
      const Where where{file, number};
      InpBlock block = block_of(keyword_line(line, at, end, number), where, faults);
      lines = nullptr;
      skipping = block.keyword == "STEP" || (skipping && block.keyword != "ENDSTEP");
      if (block.keyword == "INCLUDE" && !skipping)
        include(block, path, depth, result, faults);
      else
        result.blocks.push_back(std::move(block));
    } else if (is_data(line)) {
      if (result.blocks.empty() && !std::exchange(stray, true))
        faults.add({file, number}, "expected a keyword (*NODE, *ELEMENT, ...), found " + in_quotes(line) +
                                       ": is this a deck of CalculiX or Abaqus?");
      if (result.blocks.empty()) continue;
      if (!lines) lines = &result.blocks.back().data.emplace_back(InpLines{file, begin, begin, number, 0});
      lines->end = at;
      ++lines->count;
    }
  }
}

}  // namespace

std::string folded(std::string_view text) {
  std::string result = upper(text);
  std::erase_if(result, is_blank);
  return result;
}

void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  while (true) {
    const auto comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) break;
    line.remove_prefix(comma + 1);
  }
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
}

long long InpBlock::lines() const {
  long long total = 0;
  for (const auto& part : data) total += part.count;
  return total;
}

void InpBlock::each_line(long long first, long long count,
                         const std::function<void(Where, std::string_view)>& visit) const {
  long long index = 0;
  for (const auto& part : data) {
    if (index >= first + count) return;
    if (index + part.count <= first) {
      index += part.count;
      continue;
    }
    const char* at = part.begin;
    for (long long number = part.first_line; at != part.end && index < first + count; ++number) {
      const auto line = next_line(at, part.end);
      if (!is_data(line)) continue;
      if (index >= first) visit({part.file, number}, line);
      ++index;
    }
  }
}

InpBlocks inp_blocks(const std::string& path, Faults& faults) {
  InpBlocks result;
  walk(path, 0, result, faults);
  return result;
}

}  // namespace floe::mesh
