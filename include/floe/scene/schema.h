#pragma once
#include <cmath>
#include <string>
#include <vector>

namespace floe::scene {

/// What a value of the file may be. Reading, the printed reference and the messages take their words from describe().
enum class Type {
  text,
  texts,
  flag,
  integer,
  integers,
  number,
  share,
  numbers,
  point,
  points,
  pairs,
  joins,
  pair,
  formula,
  formulas,
  load_force,
  load_moment,
  formula_of_sensors,
  rotating,
  rigid,
  inertia,
  formula_of_place,
  formula_of_point,
  choice,
  derivatives,
  products,
  place,
  places,
  own_place,
  own_places,
  body,
  parameters,
  functions,
  section,
  modes,
  accuracy,
  frame,
  named_sections
};

/// Numbers that a key accepts; NaN and infinity never.
struct Range {
  double least = -INFINITY, greatest = INFINITY;
  bool least_excluded = false, greatest_excluded = false;
  bool contains(double value) const;  ///< and finite
  std::string text() const;           ///< `> 0`, `0 <= value < 1`; empty: any finite number
};

/// One key of the grammar: the only place where it is declared.
struct Key {
  static constexpr const char* required = "required";
  std::string name;
  Type type;
  std::string unit;
  std::string fallback;  ///< the default as one would write it; `required`; empty: may be absent, `text` says what then
  std::string text;
  Range range = {};
  std::vector<std::string> choices = {};  ///< of Type::choice
  std::vector<std::string> kinds = {};    ///< the values of the section's `type` to which the key applies; empty: all
  std::string section = {};  ///< of Type::section, modes, accuracy, frame, named_sections: the section that it holds
  int dimension = 0;         ///< 2 or 3: only in scenes of the plane, or in space
};

/// The keys that may stand together in one mapping.
struct SchemaSection {
  std::string name, text, example;
  std::vector<Key> keys;
  /// @throws std::logic_error when the program asks for a key it never declared
  const Key& key(const std::string& name) const;
};

/// The whole grammar, outermost section first.
const std::vector<SchemaSection>& schema();
/// @throws std::logic_error when the program asks for a section it never declared
const SchemaSection& schema_section(const std::string& name);

/// In words: `a number or a formula of the parameters`, `one of pinned, clamped, mean-axis`.
/// @param dimension  of the scene: how many coordinates a point has
std::string describe(const Key& key, int dimension = 2);
/// The same for the scenes in which the key occurs: planar, spatial or both, where these differ.
std::string described(const SchemaSection& section, const Key& key);
/// The default as printed, with three components where they differ in spatial scenes; empty: required, or none.
std::string default_text(const Key& key);

/// The whole grammar as Markdown, a heading and a table for each section: what the manual shows. Sections have targets
/// `scene-NAME`, and keys that hold a section link to it.
std::string schema_markdown();

}  // namespace floe::scene
