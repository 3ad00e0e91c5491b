#include "nas_cards.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "floe/error.h"
#include "nas_replicate.h"
#include "text.h"

namespace floe::mesh {
namespace {

constexpr std::size_t width = 8, fields_of_line = 8, large_fields_of_line = 4, data_columns = 72;
constexpr int deepest = 20;  // includes inside each other

/// The line without its comment.
std::string_view without_comment(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\'' || line[i] == '"') quoted = !quoted;
    if (line[i] == '$' && !quoted) return line.substr(0, i);
  }
  return line;
}

std::string with_blanks(std::string_view line) {
  std::string text;
  for (const char c : line) {
    if (c == '\t')
      text.append(width - text.size() % width, ' ');
    else
      text += c;
  }
  return text;
}

std::string_view columns(std::string_view line, std::size_t first, std::size_t count) {
  return first < line.size() ? trimmed(line.substr(first, count)) : std::string_view();
}

/// The fields after the first: eight, or four of a large line, whose first field has a *.
std::vector<std::string_view> fields_of(std::string_view line, bool free, Where where, NasCard& card) {
  std::vector<std::string_view> fields;
  const auto is_large = [](std::string_view head) { return head.ends_with('*') || head.starts_with('*'); };
  if (!free) {
    const bool large = is_large(columns(line, 0, width));
    const std::size_t wide = large ? 2 * width : width;
    for (std::size_t at = width; at < data_columns; at += wide) fields.push_back(columns(line, at, wide));
    return fields;
  }
  std::vector<std::string_view> all;
  for (std::string_view rest = line;;) {
    const auto comma = rest.find(',');
    all.push_back(trimmed(rest.substr(0, comma)));
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  const std::size_t most = is_large(all[0]) ? large_fields_of_line : fields_of_line;
  for (std::size_t i = most + 1; i < all.size(); ++i)
    if (!all[i].empty() && !all[i].starts_with('+') && !all[i].starts_with('*')) {
      card.beyond.emplace_back(where, "expected at most " + std::to_string(most) + " fields after the name, found " +
                                          in_quotes(all[i]) + " after them: continue on the next line");
      break;
    }
  fields.assign(all.begin() + 1, all.end());
  fields.resize(most);
  return fields;
}

bool begins_bulk(std::string_view line) {
  std::string_view rest = line;
  const std::string first = upper(next_word(rest));
  if (first == "BEGIN_BULK") return true;
  if (first != "BEGIN") return false;
  const std::string word = upper(next_word(rest));
  return word.empty() || word.starts_with("BULK") || word.starts_with("SUPER");
}

bool has_begin(std::string_view text) {
  const char *at = text.data(), *end = at + text.size();
  while (at != end)
    if (begins_bulk(without_comment(next_line(at, end)))) return true;
  return false;
}

class Walk {
 public:
  Walk(Faults& faults, const std::function<void(const NasCard&)>& visit) : faults_(faults), visit_(visit) {}

  NasControl control;

  void file(const std::string& path, int depth) {
    const MappedFile mapped(path);
    const int number = faults_.add_file(path);
    const char *at = mapped.text().data(), *end = at + mapped.text().size();
    bool before = depth == 0 && has_begin(mapped.text());
    for (long long count = 1; at != end && !ended_; ++count) {
      const Where where{number, count};
      const std::string_view line = without_comment(next_line(at, end));
      if (trimmed(line).empty()) continue;
      if (before) {
        before = !begins_bulk(line);
        if (control.lines == 0) control.where = where;
        if (before) ++control.lines;
      } else if (upper(trimmed(line).substr(0, 7)) == "INCLUDE") {
        finish();
        replicate_.forget();
        include(whole_name(line.substr(line.find_first_not_of(" \t") + 7), at, end, count), path, where, depth);
      } else {
        add(line, where);
      }
    }
    finish();  // the fields point into this file
    replicate_.forget();
  }

  /// The card that has ended. It is kept for those that replicate it.
  void finish() {
    if (card_.name.starts_with('=')) {
      replicate_.apply(card_, visit_);
    } else if (!card_.name.empty()) {
      visit_(card_);
      replicate_.keep(card_, kept_);
    }
    card_.name.clear();
    kept_.clear();
  }

 private:
  /// The file's name, which goes on on the next lines until its quote ends.
  static std::string whole_name(std::string_view rest, const char*& at, const char* end, long long& count) {
    std::string name(trimmed(rest));
    const bool quoted = !name.empty() && (name.front() == '\'' || name.front() == '"');
    while (quoted && (name.size() < 2 || name.back() != name.front()) && at != end) {
      name += trimmed(next_line(at, end));
      ++count;
    }
    if (quoted) name = name.substr(1, name.size() - (name.back() == name.front() && name.size() > 1 ? 2 : 1));
    return name;
  }

  void include(const std::string& name, const std::string& from, Where where, int depth) {
    if (name.empty()) return faults_.add(where, "INCLUDE expects a file");
    if (depth == deepest)
      throw InputError(faults_.text_of(where) + ": INCLUDE goes more than " + std::to_string(deepest) +
                       " files deep: does a file include itself?");
    const std::filesystem::path path(name);
    try {
      file(path.is_absolute() ? name : (std::filesystem::path(from).parent_path() / path).string(), depth + 1);
    } catch (const InputError& error) {
      throw InputError(std::string(error.what()) + " (included from " + faults_.text_of(where) + ")");
    }
  }

  /// A line of a card. Lines with tabs are kept until the card is finished.
  void add(std::string_view line, Where where) {
    constexpr std::size_t last_of_free = 10;  // a comma after it belongs to a field, as of DEQATN
    const bool free = line.find(',') < last_of_free;
    const auto stop = std::min(line.find('\t'), free ? line.find(',') : width);
    const std::string_view head = trimmed(line.substr(0, stop));
    const bool continues = head.empty() || head.starts_with('+') || head.starts_with('*');
    if (!continues) {
      finish();
      const std::string name = upper(trimmed(head.substr(0, head.find('*'))));
      if (name.starts_with("ENDDATA")) ended_ = true;
      if (ended_ || begins_bulk(line)) return;
      card_.name = name;
      card_.fields.clear();
      card_.lines.clear();
      card_.beyond.clear();
    } else if (card_.name.empty()) {
      return faults_.add(where, "a continuation without a card before it: " + in_quotes(trimmed(line)));
    }
    if (!free && line.find('\t') != std::string_view::npos) line = kept_.emplace_back(with_blanks(line));
    constexpr std::size_t most = 1000000;
    if (card_.fields.size() > most) return;
    if (card_.fields.size() % fields_of_line == 0) card_.lines.push_back(where);
    const auto fields = fields_of(line, free, where, card_);
    card_.fields.insert(card_.fields.end(), fields.begin(), fields.end());
  }

  Faults& faults_;
  const std::function<void(const NasCard&)>& visit_;
  NasReplicate replicate_{faults_};
  NasCard card_;
  std::deque<std::string> kept_;  // lines of the card whose tabs are blanks
  bool ended_ = false;
};

}  // namespace

bool NasCard::blank_from(std::size_t i) const {
  for (; i < fields.size(); ++i)
    if (!fields[i].empty()) return false;
  return true;
}

NasControl each_card(const std::string& path, Faults& faults, const std::function<void(const NasCard&)>& visit) {
  Walk walk(faults, visit);
  walk.file(path, 0);
  return walk.control;
}

namespace {

// The number that manuals give a field: 2 to 9 on the first line, 12 to 19 on the second.
std::string field_number(std::size_t i) { return std::to_string(2 + i / fields_of_line * 10 + i % fields_of_line); }

}  // namespace

void NasFields::refuse(std::size_t i, const std::string& text) {
  good_ = false;
  faults_.add(card.where(i), card.name + ": field " + field_number(i) + " " + text);
}

void NasFields::refuse_card(const std::string& text) {
  good_ = false;
  faults_.add(card.where(),
              card.name + (card.blank(0) ? "" : " " + std::string(card.text(0).substr(0, width))) + " " + text);
}

bool NasFields::is_integer(std::size_t i) const { return number<long long>(card.text(i)).has_value(); }

long long NasFields::integer(std::size_t i, const char* what) {
  const auto value = number<long long>(card.text(i));
  constexpr long long most = 1LL << 60;
  if (value && *value > 0 && *value < most) return *value;
  refuse(i, std::string("expects ") + what + " (an integer greater than 0), found " + in_quotes(card.text(i)));
  return 0;
}

long long NasFields::integer(std::size_t i, const char* what, long long otherwise) {
  if (card.blank(i)) return otherwise;
  const auto value = number<long long>(card.text(i));
  if (value) return *value;
  refuse(i, std::string("expects ") + what + " (an integer), found " + in_quotes(card.text(i)));
  return otherwise;
}

double NasFields::real(std::size_t i, const char* what, double otherwise) {
  if (card.blank(i)) return otherwise;
  const auto value = fortran_number(card.text(i), true);
  constexpr double most = 1e100;  // its square is a number, too
  if (value && std::abs(*value) <= most) return *value;
  refuse(i, std::string("expects ") + what + " (a real number), found " + in_quotes(card.text(i)));
  return otherwise;
}

double NasFields::real(std::size_t i, const char* what) {
  if (card.blank(i)) refuse(i, std::string("expects ") + what + " (a real number), found nothing");
  return real(i, what, 0);
}

double NasFields::positive(std::size_t i, const char* what) {
  const double value = real(i, what);
  if (good_ && !(value > 0))
    refuse(i, std::string("expects ") + what + " greater than 0, found " + in_quotes(card.text(i)));
  return value;
}

}  // namespace floe::mesh
