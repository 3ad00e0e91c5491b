#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "floe/error.h"
#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

constexpr long long of_assembly = 1'000'000'000;  // numbers of parts are smaller

struct Instance {
  std::string name, part;
  Where where;
};

std::string value(const InpBlock& block, const char* key) {
  const auto found = block.parameters.find(key);
  return found == block.parameters.end() ? "" : found->second;
}

bool same(const std::string& a, const std::string& b) { return upper(a) == upper(b); }

std::string listed_shortly(std::vector<std::string> names) {
  constexpr std::size_t most = 10;
  if (names.size() > most) {
    const std::size_t more = names.size() - most;
    names.resize(most);
    names.push_back(fmt::format("{} more", more));
  }
  return listed(names);
}

std::vector<Instance> instances_of(const InpBlocks& deck) {
  std::vector<Instance> all;
  for (const InpBlock& block : deck.blocks)
    if (block.keyword == "INSTANCE") all.push_back({value(block, "NAME"), value(block, "PART"), block.where});
  return all;
}

/// Follows the keywords of a deck.
struct Place {
  std::string part, instance;
  bool in_step = false, in_assembly = false;
  void enter(const InpBlock& block) {
    if (block.keyword == "PART") part = value(block, "NAME");
    if (block.keyword == "INSTANCE") instance = value(block, "NAME");
    if (block.keyword == "ASSEMBLY") in_assembly = true;
    if (block.keyword == "STEP") in_step = true;
  }
  void leave(const InpBlock& block) {
    if (block.keyword == "ENDPART") part.clear();
    if (block.keyword == "ENDINSTANCE") instance.clear();
    if (block.keyword == "ENDASSEMBLY") in_assembly = false;
    if (block.keyword == "ENDSTEP") in_step = false;
  }
  bool outside() const { return part.empty() && instance.empty() && !in_step; }
};

using Kinds = std::vector<InpName>;  // what a text may name, in this order; none: it names nothing

/// What a parameter refers to.
Kinds kinds_of(const std::string& keyword, const std::string& key) {
  using enum InpName;
  if (keyword == "COUPLING" && key == "SURFACE") return {surface, nodes};
  if (keyword == "RIGIDBODY" && (key == "NSET" || key == "TIENSET" || key == "PINNSET")) return {nodes};
  if (keyword == "TRANSFORM" && key == "NSET") return {nodes};
  if (key == "REFNODE") return {nodes};
  if (key == "ELSET" && (keyword == "RIGIDBODY" || keyword == "MASS" || keyword == "SPRING")) return {elements};
  return {};
}

/// What the i-th field of a data line refers to; of *EQUATION: of a line of terms.
Kinds kinds_of(const InpBlock& block, std::size_t i) {
  using enum InpName;
  const std::string& keyword = block.keyword;
  if (keyword == "NSET") return {nodes};
  if (keyword == "ELSET") return {elements};
  if (keyword == "SURFACE" && i == 0) return same(value(block, "TYPE"), "NODE") ? Kinds{nodes} : Kinds{elements};
  if (keyword == "MPC" && i > 0) return {nodes};
  if (keyword == "TIE" && i < 2) return {surface, nodes};
  if (keyword == "EQUATION" && i % 3 == 0) return {nodes};
  if (keyword == "NODALTHICKNESS" && i == 0) return {nodes};
  if (keyword == "ELEMENT" && i > 0) return {nodes};
  return {};
}

/// What a block defines.
std::optional<std::pair<InpName, std::string>> definition_of(const InpBlock& block) {
  const auto named = [&](InpName kind, const char* key) { return std::pair(kind, upper(value(block, key))); };
  if (block.keyword == "NSET" || block.keyword == "NODE") return named(InpName::nodes, "NSET");
  if (block.keyword == "ELSET" || block.keyword == "ELEMENT") return named(InpName::elements, "ELSET");
  if (block.keyword == "SURFACE") return named(InpName::surface, "NAME");
  return std::nullopt;
}

/// What stays of the blocks of an assembly for one of its instances.
class OfInstance {
 public:
  OfInstance(InpBlocks& deck, const std::vector<Instance>& all, const Instance& chosen) : deck_(deck) {
    for (const Instance& one : all)
      if (!same(one.name, chosen.name)) others_.insert(upper(one.name));
  }

  /// Leaves out what names other instances, and numbers the nodes of the assembly (reference points) anew.
  /// @return something stays
  bool keep(InpBlock& block, bool in_assembly) {
    const bool stays = reduce(block, in_assembly);
    if (const auto defined = definition_of(block); defined && !defined->second.empty())
      (stays ? kept_ : left_out_).insert(*defined);
    return stays;
  }

  /// Lines of joints that name other instances, by keyword.
  const std::map<std::string, long long>& left_out() const { return counts_; }

 private:
  bool reduce(InpBlock& block, bool in_assembly) {
    if (const std::string instance = value(block, "INSTANCE"); !instance.empty())
      return !others_.contains(upper(instance));
    if (block.keyword == "KINEMATIC" || block.keyword == "DISTRIBUTING") return coupling_stays_;
    for (const auto& [key, text] : block.parameters)
      if (of_another(text, kinds_of(block.keyword, key))) {
        coupling_stays_ = false;
        ++counts_[block.name];
        return false;
      }
    coupling_stays_ = true;
    if (in_assembly) {
      if (block.keyword == "NODE") add_points(block);
      if (const auto point = block.parameters.find("REFNODE"); point != block.parameters.end())
        point->second = number_of(point->second);
    }
    const bool whole = block.lines() == 0 || (block.keyword == "NODE" && !in_assembly);
    return whole || reduce_lines(block, in_assembly);
  }

  bool of_another(const std::string& text, const Kinds& kinds) const {
    if (kinds.empty()) return false;
    const std::string name = upper(text);
    if (const auto dot = name.find('.'); dot != std::string::npos) return others_.contains(name.substr(0, dot));
    for (const InpName kind : kinds) {
      if (kept_.contains({kind, name})) return false;
      if (left_out_.contains({kind, name})) return true;
    }
    return false;
  }

  std::string number_of(const std::string& text) const {
    const auto label = number<long long>(text);
    return label && points_.contains(*label) ? std::to_string(*label + of_assembly) : text;
  }

  void add_points(const InpBlock& block) {
    std::vector<std::string_view> fields;
    block.each_line([&](Where, std::string_view line) {
      split_fields(line, fields);
      if (const auto label = fields.empty() ? std::nullopt : number<long long>(fields[0])) points_.insert(*label);
    });
  }

  /// A record of a set loses its fields of others, one of *EQUATION goes as a whole, as other lines.
  bool reduce_lines(InpBlock& block, bool in_assembly) {
    if (kinds_of(block, 0).empty() && kinds_of(block, 1).empty() && block.keyword != "NODE") return true;
    const bool set = block.keyword == "NSET" || block.keyword == "ELSET";
    const bool range = set && block.parameters.contains("GENERATE");
    const bool points =
        in_assembly && block.keyword != "ELSET" && !(block.keyword == "SURFACE" && is_of_elements(block));
    std::vector<InpLines> kept;
    std::size_t of_record = 0, missing = 0;  // *EQUATION: kept lines before this record, its fields to come
    bool record_stays = true;
    std::vector<std::string_view> fields;
    block.each_line([&](Where where, std::string_view line) {
      split_fields(line, fields);
      const bool head = block.keyword == "EQUATION" && missing == 0;
      if (head) {
        const auto terms = fields.size() == 1 ? number<long long>(fields[0]) : std::nullopt;
        missing = terms && *terms > 0 ? 3 * static_cast<std::size_t>(*terms) : 0;
        of_record = kept.size(), record_stays = true;
      } else if (block.keyword == "EQUATION") {
        missing -= std::min(missing, fields.size());
      }
      std::vector<std::string> texts;
      bool stays = true;
      for (std::size_t i = 0; i < fields.size(); ++i) {
        const Kinds kinds = head ? Kinds{} : kinds_of(block, i);
        const std::string text(fields[i]);
        const bool other = of_another(text, kinds);
        const bool point = block.keyword == "NODE" ? i == 0 : !kinds.empty() && !(range && i > 1);
        if (other && set) continue;
        stays = stays && !other;
        texts.push_back(points && point ? range ? end_of_range(text, fields) : number_of(text) : text);
      }
      if (!stays && (block.keyword != "EQUATION" || std::exchange(record_stays, false)) && block.keyword != "SURFACE")
        ++counts_[block.name];
      if (block.keyword == "EQUATION" && !record_stays) {
        kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(of_record), kept.end());
        return;
      }
      if (stays && !texts.empty()) kept.push_back(written(where, texts));
    });
    block.data = std::move(kept);
    return !block.data.empty();
  }

  static bool is_of_elements(const InpBlock& block) { return !same(value(block, "TYPE"), "NODE"); }

  /// Both ends of a range move where it begins at a node of the assembly.
  std::string end_of_range(const std::string& text, const std::vector<std::string_view>& fields) const {
    const auto first = number<long long>(fields[0]), label = number<long long>(text);
    return first && label && points_.contains(*first) ? std::to_string(*label + of_assembly) : text;
  }

  InpLines written(Where where, const std::vector<std::string>& texts) {
    const std::string& line = deck_.written.emplace_back(fmt::format("{}", fmt::join(texts, ",")));
    return {where.file, line.data(), line.data() + line.size(), where.at, 1};
  }

  InpBlocks& deck_;
  std::set<std::string> others_;
  std::set<std::pair<InpName, std::string>> kept_, left_out_;
  std::set<long long> points_;
  std::map<std::string, long long> counts_;
  bool coupling_stays_ = true;
};

/// The instance of a body, where the deck has any.
/// @throws InputError  there are several, or others than the one asked for; a part is not defined
std::optional<Instance> chosen_of(const InpBlocks& deck, const std::vector<Instance>& all, const std::string& name,
                                  const Faults& faults) {
  std::vector<std::string> parts, names;
  for (const InpBlock& block : deck.blocks)
    if (block.keyword == "PART") parts.push_back(in_quotes(value(block, "NAME")));
  for (const Instance& one : all) {
    names.push_back(one.name);
    if (parts.empty() ||
        std::any_of(parts.begin(), parts.end(), [&](const auto& p) { return same(p, in_quotes(one.part)); }))
      continue;
    throw InputError(fmt::format("{}: *INSTANCE of part {}, which is not defined; the deck has {}",
                                 faults.text_of(one.where), in_quotes(one.part), listed_shortly(parts)));
  }
  if (!name.empty()) {
    for (const Instance& one : all)
      if (same(one.name, name)) return one;
    throw InputError(fmt::format("{}: there is no *INSTANCE {}{}", faults.text_of({0, 1}), in_quotes(name),
                                 names.empty() ? std::string() : "; the deck has " + listed_shortly(names)));
  }
  if (all.size() > 1)
    throw InputError(
        fmt::format("{}: a second *INSTANCE: one is read, for one body; expected one of {}, as in file: "
                    "{{path: {}, instance: {}}}",
                    faults.text_of(all[1].where), listed_shortly(names),
                    std::filesystem::path(deck.files.front()->path()).filename().string(), names.front()));
  return all.empty() ? std::nullopt : std::optional(all.front());
}

}  // namespace

void choose_instance(InpBlocks& deck, const DeckRequest& request, Faults& faults, std::vector<std::string>& notices) {
  const std::vector<Instance> all = instances_of(deck);
  const std::optional<Instance> chosen = chosen_of(deck, all, request.instance, faults);
  if (!chosen) return;
  OfInstance of_instance(deck, all, *chosen);
  Place place;
  std::vector<InpBlock> kept;
  for (InpBlock& block : deck.blocks) {
    place.enter(block);
    bool stays = (place.part.empty() || same(place.part, chosen->part)) &&
                 (place.instance.empty() || same(place.instance, chosen->name));
    if (place.outside()) {
      const std::string type = value(block, "TYPE");
      const bool ignored = block.keyword == "ELEMENT" && place.in_assembly &&
                           std::any_of(request.ignore.begin(), request.ignore.end(),
                                       [&](const std::string& name) { return same(name, type); });
      stays = !ignored && of_instance.keep(block, place.in_assembly);
    }
    place.leave(block);
    if (stays) kept.push_back(std::move(block));
  }
  deck.blocks = std::move(kept);
  if (all.size() == 1) return;
  std::vector<std::string> others, counts;
  for (const Instance& one : all)
    if (!same(one.name, chosen->name)) others.push_back(one.name);
  for (const auto& [keyword, times] : of_instance.left_out()) counts.push_back(fmt::format("{} {}", times, keyword));
  notices.push_back(fmt::format("{}: *INSTANCE {} is read; left out: {}{}", faults.text_of(chosen->where), chosen->name,
                                listed_shortly(others),
                                counts.empty() ? "" : ", and what names them: " + listed_shortly(counts)));
}

}  // namespace floe::mesh
