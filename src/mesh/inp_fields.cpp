#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {

std::string required(const InpBlock& block, const std::string& key, InpReading& reading) {
  const auto found = block.parameters.find(key);
  if (found != block.parameters.end() && !found->second.empty()) return found->second;
  reading.faults.add(block.where, block.name + " expects " + key + "=...");
  return "";
}

std::optional<std::vector<double>> numbers(std::string_view line, Where where, std::size_t least, std::size_t most,
                                           const std::string& what, Faults& faults) {
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  std::vector<double> values;
  bool good = fields.size() >= least && fields.size() <= most;
  for (const auto field : fields) {
    const auto value = field.empty() ? std::optional(0.0) : fortran_number(field);
    good = good && value;
    values.push_back(value.value_or(0));
  }
  if (good) return values;
  faults.add(where, "expected " + what + ", found " + in_quotes(line));
  return std::nullopt;
}

std::vector<std::pair<Where, std::string_view>> data_lines(const InpBlock& block, std::size_t least, std::size_t most,
                                                           const std::string& what, Faults& faults) {
  std::vector<std::pair<Where, std::string_view>> lines;
  const auto count = static_cast<std::size_t>(block.lines());
  if (count < least || count > most) {
    faults.add(block.where, block.name + " expects " + what + ", found " + std::to_string(count) + " data lines");
    return lines;
  }
  block.each_line([&](Where where, std::string_view line) { lines.emplace_back(where, line); });
  return lines;
}

}  // namespace floe::mesh
