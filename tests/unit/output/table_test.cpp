#include "floe/output/table.h"

#include <catch2/catch.hpp>

using namespace floe::output;

namespace {

const Table table{
    {{"mode", ""}, {"frequency", "Hz", 6}, {"dofs", ""}, {"kind", ""}},
    {{std::int64_t{1}, 0.231244123, std::int64_t{60}, "bending | 1"}, {std::int64_t{12}, 1432.7, "", "axial, \"α\""}}};

}  // namespace

TEST_CASE("a table is aligned for a terminal") {
  CHECK(to_text(table) ==
        "mode  frequency  dofs  kind\n"
        "           [Hz]\n"
        "----  ---------  ----  -----------\n"
        "   1   0.231244    60  bending | 1\n"
        "  12     1432.7        axial, \"α\"\n");
}

TEST_CASE("a table without units has no line for them") {
  CHECK(to_text({{{"a", ""}, {"b", ""}}, {{1e-7, 123456.0}}}) ==
        "    a          b\n-----  ---------\n1e-07  1.235e+05\n");
}

TEST_CASE("a table has powers of ten for small and very great numbers alone") {
  const auto cell = [](double value, int digits) {
    const std::string text = to_text({{{"a", "", digits}}, {{value}}});
    const std::string line = text.substr(text.find('\n', text.find('-')) + 1);
    return line.substr(line.find_first_not_of(' '), line.find('\n') - line.find_first_not_of(' '));
  };
  CHECK(cell(99.7, 2) == "100");
  CHECK(cell(27123, 3) == "27100");
  CHECK(cell(-99999, 3) == "-1e+05");
  CHECK(cell(2.5e-7, 2) == "2.5e-07");
}

TEST_CASE("a table as Markdown") {
  CHECK(to_markdown(table) ==
        "| mode | frequency [Hz] | dofs | kind         |\n"
        "| ---: | -------------: | ---: | ------------ |\n"
        "|    1 |       0.231244 |   60 | bending \\| 1 |\n"
        "|   12 |         1432.7 |      | axial, \"α\"   |\n");
}

TEST_CASE("a table as CSV keeps every digit") {
  CHECK(to_csv(table) ==
        "mode,frequency [Hz],dofs,kind\n"
        "1,0.231244123,60,bending | 1\n"
        "12,1432.7,,\"axial, \"\"α\"\"\"\n");
}
