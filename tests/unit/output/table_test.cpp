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
  CHECK(to_text({{{"a", ""}, {"b", "", 3}}, {{1e-7, 27123.0}}}) == "    a      b\n-----  -----\n1e-07  27100\n");
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
