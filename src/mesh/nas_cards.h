#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "faults.h"
#include "mapped_file.h"

namespace floe::mesh {

/// A card of bulk data: its name and its fields after the name, eight of each small line, four of each large one.
struct NasCard {
  std::string name;                      // upper case, without *
  std::vector<std::string_view> fields;  // field 2, 3, ... of the first line, then 12, 13, ... of the second
  std::vector<Where> lines;              // of each eight fields
  std::vector<std::pair<Where, std::string>> beyond;  // of lines with more fields: what is wrong

  std::string_view text(std::size_t i) const { return i < fields.size() ? fields[i] : std::string_view(); }
  bool blank(std::size_t i) const { return text(i).empty(); }
  bool blank_from(std::size_t i) const;
  Where where(std::size_t i = 0) const { return lines.at(std::min(i / 8, lines.size() - 1)); }
};

/// What a walk leaves out before BEGIN BULK.
struct NasControl {
  Where where;
  long long lines = 0;
};

/// Calls visit(card) for each card of a file and of those that it includes, in order. Rank-local.
/// @throws InputError  a file that cannot be read, or that includes itself
NasControl each_card(const std::string& path, Faults& faults, const std::function<void(const NasCard&)>& visit);

/// Reads a card's fields; what is wrong becomes a fault with card, field and what was expected, and is 0.
class NasFields {
 public:
  NasFields(const NasCard& of, Faults& faults) : card(of), faults_(faults) {}
  const NasCard& card;

  bool good() const { return good_; }
  Faults& faults() { return faults_; }
  void refuse(std::size_t i, const std::string& text);  // "CBAR: field 4 <text>"
  void refuse_card(const std::string& text);            // "CBAR 7 <text>"

  long long integer(std::size_t i, const char* what);  // required, and greater than 0
  long long integer(std::size_t i, const char* what, long long otherwise);
  double real(std::size_t i, const char* what);
  double real(std::size_t i, const char* what, double otherwise);
  double positive(std::size_t i, const char* what);
  bool is_integer(std::size_t i) const;  // and not a real number

 private:
  Faults& faults_;
  bool good_ = true;
};

}  // namespace floe::mesh
