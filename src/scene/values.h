#pragma once
#include <array>
#include <string>
#include <vector>

#include "document.h"
#include "floe/scene/schema.h"

namespace floe::scene {

// Each reads one value as its key in the grammar says; a wrong one is noted as a fault and replaced by NaN, 0 or
// nothing.

/// How a message shows a value: `is "TEXT"`, `is a list`, `is a mapping`, `is empty`.
std::string shown(const YAML::Node& node);
/// In quotation marks, cut to 60 characters.
std::string in_quotes(const std::string& text);

double read_number(Document& document, const Value& value, const Key& key);
double read_share(Document& document, const Value& value, const Key& key);
int read_integer(Document& document, const Value& value, const Key& key);
bool read_flag(Document& document, const Value& value, const Key& key);
std::string read_choice(Document& document, const Value& value, const Key& key);
math::Formula read_formula(Document& document, const Value& value, const Key& key,
                           const std::vector<std::string>& variables);
Point read_point(Document& document, const Value& value, const Key& key);

/// The entries of a list, of which there must be `count` (0: any number). Nothing after a fault.
std::vector<Value> read_list(Document& document, const Value& value, const Key& key, std::size_t count = 0);

/// A list of texts, each once, at least one. Nothing after a fault.
std::vector<std::string> read_texts(Document& document, const Value& value, const Key& key);

/// Pairs of integers from 1. Nothing after a fault.
std::vector<std::array<int, 2>> read_pairs(Document& document, const Value& value, const Key& key);

/// One entry of a mapping.
struct Entry {
  std::string name;
  Where where;  ///< of the name
  Value value;
};

/// The entries of a mapping, without those whose name is no text or stands twice (faults). `expected` is for messages.
std::vector<Entry> read_mapping(Document& document, const Value& value, const std::string& expected);

}  // namespace floe::scene
