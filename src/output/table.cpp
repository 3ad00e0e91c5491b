#include "floe/output/table.h"

#include <fmt/format.h>

#include <algorithm>

#include "floe/math/rounded.h"

namespace floe::output {
namespace {

using Line = std::vector<std::string>;

std::string shown(const Cell& cell, int digits) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) return fmt::format("{}", *whole);
  return math::rounded(std::get<double>(cell), digits);
}

std::string exact(const Cell& cell) {
  return std::visit([](const auto& value) { return fmt::format("{}", value); }, cell);
}

/// Characters on the terminal: bytes of UTF-8 that do not continue another.
std::size_t width(const std::string& text) {
  return std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; });
}

/// A column stands to the right unless one of its cells is a text that says something.
bool to_the_right(const Table& table, std::size_t column) {
  return std::all_of(table.rows.begin(), table.rows.end(), [column](const auto& row) {
    const auto* text = std::get_if<std::string>(&row[column]);
    return !text || text->empty();
  });
}

std::string aligned(const Line& cells, const std::vector<std::size_t>& widths, const std::vector<bool>& right,
                    const std::string& between) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string gap(widths[i] - width(cells[i]), ' ');
    line += (i ? between : "") + (right[i] ? gap + cells[i] : cells[i] + gap);
  }
  return line;
}

std::string trimmed(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

struct Layout {
  std::vector<Line> body;
  std::vector<std::size_t> widths;
  std::vector<bool> right;
};

Layout layout(const Table& table, const std::vector<Line>& heads) {
  Layout all{{}, std::vector<std::size_t>(table.columns.size(), 1), {}};
  for (const auto& row : table.rows) {
    all.body.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) all.body.back().push_back(shown(row[i], table.columns[i].digits));
  }
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    all.right.push_back(to_the_right(table, i));
    for (const auto& line : heads) all.widths[i] = std::max(all.widths[i], width(line[i]));
    for (const auto& line : all.body) all.widths[i] = std::max(all.widths[i], width(line[i]));
  }
  return all;
}

std::string with_unit(const TableColumn& column) {
  return column.unit.empty() ? column.name : fmt::format("{} [{}]", column.name, column.unit);
}

std::string replaced(std::string text, char what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) text.replace(at, 1, by);
  return text;
}

std::string in_quotes(const std::string& text) {
  return text.find_first_of(",\"\n\r") == std::string::npos ? text : '"' + replaced(text, '"', "\"\"") + '"';
}

}  // namespace

std::string to_text(const Table& table) {
  Line names, units;
  for (const auto& column : table.columns) {
    names.push_back(column.name);
    units.push_back(column.unit.empty() ? "" : fmt::format("[{}]", column.unit));
  }
  const Layout all = layout(table, {names, units});
  const std::string gap = "  ";
  std::string text = trimmed(aligned(names, all.widths, all.right, gap)) + '\n';
  const std::string unit_line = trimmed(aligned(units, all.widths, all.right, gap));
  if (!unit_line.empty()) text += unit_line + '\n';
  Line rule;
  for (const auto w : all.widths) rule.emplace_back(w, '-');
  text += aligned(rule, all.widths, all.right, gap) + '\n';
  for (const auto& line : all.body) text += trimmed(aligned(line, all.widths, all.right, gap)) + '\n';
  return text;
}

int text_width(const Table& table) {
  const std::string text = to_text(table);
  std::size_t widest = 0;
  for (std::size_t from = 0, to = 0; (to = text.find('\n', from)) != std::string::npos; from = to + 1)
    widest = std::max(widest, width(text.substr(from, to - from)));
  return static_cast<int>(widest);
}

std::string to_markdown(const Table& table) {
  Table escaped = table;
  for (auto& row : escaped.rows)
    for (auto& cell : row)
      if (auto* text = std::get_if<std::string>(&cell)) *text = replaced(*text, '|', "\\|");
  Line heads;
  for (const auto& column : table.columns) heads.push_back(replaced(with_unit(column), '|', "\\|"));
  Layout all = layout(escaped, {heads});
  Line rule;
  for (std::size_t i = 0; i < heads.size(); ++i) {
    all.widths[i] = std::max<std::size_t>(all.widths[i], 3);
    rule.push_back(std::string(all.widths[i] - 1, '-') + (all.right[i] ? ":" : "-"));
  }
  std::string text;
  const auto add = [&](const Line& line) { text += "| " + aligned(line, all.widths, all.right, " | ") + " |\n"; };
  add(heads);
  add(rule);
  for (const auto& line : all.body) add(line);
  return text;
}

std::string to_csv(const Table& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    text += (i ? "," : "") + in_quotes(with_unit(table.columns[i]));
  text += '\n';
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i ? "," : "") + in_quotes(exact(row[i]));
    text += '\n';
  }
  return text;
}

}  // namespace floe::output
