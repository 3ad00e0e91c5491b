#include "floe/scene/schema.h"

#include <yaml-cpp/yaml.h>

#include <catch2/catch.hpp>
#include <set>
#include <sstream>

#include "floe/scene/scene.h"

using namespace floe::scene;

TEST_CASE("the printed reference has every key with unit, default and range") {
  const std::string reference = schema_reference();
  for (const auto& section : schema()) {
    CHECK(reference.find("\n" + section.name + "\n---") != std::string::npos);
    for (const Key& key : section.keys) {
      INFO(section.name << "." << key.name);
      CHECK(reference.find("  " + key.name + " ") != std::string::npos);
      CHECK(reference.find(key.text) != std::string::npos);
      CHECK_FALSE(key.text.empty());
      if (!key.unit.empty()) CHECK(reference.find("[" + key.unit + "]") != std::string::npos);
    }
  }
  CHECK(reference.find("0 <= value < 1; default 0.8") != std::string::npos);
  CHECK(reference.find("only for type prismatic") != std::string::npos);
  CHECK(reference.find("two numbers [x, y]; in spatial scenes three numbers [x, y, z]") != std::string::npos);
  CHECK(reference.find("default 0; in spatial scenes [0, 0, 0]") != std::string::npos);
}

TEST_CASE("the Markdown reference has a heading for each section and a row for each key, of five columns") {
  const std::string reference = schema_markdown();
  std::size_t rows = 0, keys = 0;
  for (const auto& section : schema()) {
    CHECK(reference.find(")=\n## " + section.name + "\n") != std::string::npos);
    keys += section.keys.size();
    for (const Key& key : section.keys) CHECK(reference.find("\n| `" + key.name + "` | ") != std::string::npos);
  }
  std::istringstream lines(reference);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("| `", 0) != 0) continue;
    ++rows;
    int bars = 0;
    for (std::size_t i = 0; i < line.size(); ++i) bars += line[i] == '|' && (i == 0 || line[i - 1] != '\\');
    CHECK(bars == 6);
  }
  CHECK(rows == keys);
  CHECK(reference.find("[`line`](scene-line)") != std::string::npos);
}

TEST_CASE("no key is declared twice and every named section exists") {
  for (const auto& section : schema()) {
    std::set<std::string> names;
    for (const Key& key : section.keys) {
      CHECK(names.insert(key.name).second);
      if (!key.section.empty()) CHECK_NOTHROW(schema_section(key.section));
      CHECK((key.type == Type::choice) == !key.choices.empty());
      for (const auto& kind : key.kinds) {
        const auto& kinds = section.key("type").choices;
        CHECK(std::count(kinds.begin(), kinds.end(), kind) == 1);
      }
    }
  }
  CHECK_THROWS_AS(schema_section("none"), std::logic_error);
  CHECK_THROWS_AS(schema_section("line").key("none"), std::logic_error);
}

TEST_CASE("the example of each section uses keys that it has") {
  for (const auto& section : schema()) {
    INFO(section.name);
    for (const auto& entry : YAML::Load(section.example)) CHECK_NOTHROW(section.key(entry.first.as<std::string>()));
  }
}

TEST_CASE("a range holds its inside and only the ends that it includes") {
  const Range range{0, 1, false, true};
  CHECK(range.contains(0));
  CHECK(range.contains(0.5));
  CHECK_FALSE(range.contains(1));
  CHECK_FALSE(range.contains(-1e-300));
  CHECK_FALSE(Range{}.contains(NAN));
  CHECK_FALSE(Range{}.contains(INFINITY));
  CHECK(range.text() == "0 <= value < 1");
  CHECK(Range{}.text().empty());
}
