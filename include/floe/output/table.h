#pragma once
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace floe::output {

/// An empty text stands for "not known".
using Cell = std::variant<std::string, double, std::int64_t>;

/// Name and unit of a column, and how its numbers are printed.
struct TableColumn {
  std::string name, unit;
  int digits = 4;  ///< significant digits of its numbers
};

/// Rows under named columns with units. Every row has as many cells as there are columns.
struct Table {
  std::vector<TableColumn> columns;
  std::vector<std::vector<Cell>> rows;
};

/// Aligned for a terminal: names, units (where there are any), a rule, rows; numbers to the right, texts to the left.
std::string to_text(const Table& table);
/// Characters of the longest line of to_text.
int text_width(const Table& table);
/// A pipe table of Markdown.
std::string to_markdown(const Table& table);
/// RFC 4180; header `name [unit]`; numbers as short as read back exactly.
std::string to_csv(const Table& table);

}  // namespace floe::output
