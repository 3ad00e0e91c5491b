#include <algorithm>
#include <numeric>

#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {

int InpSets::find(const std::string& name) const {
  const std::string sought = upper(name);
  for (std::size_t i = 0; i < sets.size(); ++i)
    if (upper(sets[i].name) == sought) return static_cast<int>(i);
  return -1;
}

int InpSets::named(const std::string& name, Where where) {
  const int found = find(name);
  if (found >= 0) return found;
  sets.push_back({name, where, {}, {}, {}});
  return static_cast<int>(sets.size()) - 1;
}

std::vector<int> InpSets::with_members(int set) const {
  std::vector<int> all{set};
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const auto& name : sets[all[i]].members) {
      const int member = find(name);
      if (member >= 0 && std::find(all.begin(), all.end(), member) == all.end()) all.push_back(member);
    }
  return all;
}

std::vector<std::string> InpSets::names() const {
  std::vector<std::string> result;
  for (const auto& set : sets) result.push_back(set.name);
  return result;
}

namespace {

bool has(const InpBlock& block, const char* key) { return block.parameters.contains(key); }

void read_ranges(const InpBlock& block, InpSet& set, Faults& faults) {
  block.each_line([&](Where where, std::string_view line) {
    std::vector<std::string_view> fields;
    split_fields(line, fields);
    std::array<long long, 3> range{0, 0, 1};
    bool good = fields.size() == 2 || fields.size() == 3;
    for (std::size_t i = 0; good && i < fields.size(); ++i) {
      const auto value = number<long long>(fields[i]);
      good = value.has_value();
      range[i] = value.value_or(0);
    }
    constexpr long long most = 1LL << 60;  // differences of labels stay numbers
    if (!good || range[2] < 1 || range[1] < range[0] || range[0] < -most || range[1] > most)
      return faults.add(where, "GENERATE expects first, last[, step], found " + in_quotes(line));
    set.ranges.push_back({range[0], range[1], range[2]});
  });
}

// Numbers and names of other sets; each rank takes its share of the lines.
void read_members(const InpBlock& block, InpSet& set, InpName kind, std::size_t most_fields, InpReading& reading) {
  const long long lines = block.lines(), first = reading.rank * lines / reading.ranks;
  std::vector<std::string_view> fields;
  block.each_line(first, (reading.rank + 1) * lines / reading.ranks - first, [&](Where where, std::string_view line) {
    split_fields(line, fields);
    if (fields.size() > most_fields) fields.resize(most_fields);
    for (const auto field : fields) {
      if (const auto label = number<long long>(field))
        set.labels.push_back(*label);
      else if (field.empty() || field.front() == '-' || (field.front() >= '0' && field.front() <= '9'))
        reading.faults.add(where, "expected numbers or names of sets, found " + in_quotes(field));
      else
        set.members.push_back(reading.scopes.own(std::string(field), kind));
    }
  });
}

bool of_the_instance(const InpBlock& block, InpReading& reading) {
  const auto instance = block.parameters.find("INSTANCE");
  if (instance == block.parameters.end() || upper(instance->second) == upper(reading.instance)) return true;
  reading.faults.add(block.where, "there is no instance " + in_quotes(instance->second));
  return false;
}

}  // namespace

void read_set(const InpBlock& block, InpReading& reading) {
  const bool nodes = block.keyword == "NSET";
  const std::string name = required(block, nodes ? "NSET" : "ELSET", reading);
  if (name.empty() || !of_the_instance(block, reading)) return;
  auto& sets = nodes ? reading.node_sets : reading.element_sets;
  const InpName kind = nodes ? InpName::nodes : InpName::elements;
  auto& set = sets.sets[sets.named(reading.scopes.own(name, kind), block.where)];
  if (has(block, "GENERATE"))
    read_ranges(block, set, reading.faults);
  else
    read_members(block, set, kind, std::numeric_limits<std::size_t>::max(), reading);
}

void read_surface(const InpBlock& block, InpReading& reading) {
  const auto type = block.parameters.find("TYPE");
  if (type == block.parameters.end() || upper(type->second) == "ELEMENT") return read_element_surface(block, reading);
  if (upper(type->second) != "NODE" || has(block, "COMBINE"))
    return ignore(block, "only surfaces of nodes and of elements are read", reading);
  const std::string name = reading.scopes.own(required(block, "NAME", reading), InpName::surface);
  if (name.empty()) return;
  InpSurface surface{name, block.where, {}, reading.node_sets.named(name + " (surface)", block.where)};
  read_members(block, reading.node_sets.sets[surface.set], InpName::nodes, 1, reading);
  reading.surfaces.push_back(std::move(surface));
}

void agree_members(MPI_Comm comm, InpReading& reading) {
  for (auto* sets : {&reading.node_sets, &reading.element_sets}) {
    std::vector<std::string> mine;
    for (std::size_t i = 0; i < sets->sets.size(); ++i)
      for (const auto& name : sets->sets[i].members) {
        mine.push_back(std::to_string(i));
        mine.push_back(name);
      }
    const auto all = gather_texts(comm, mine);
    for (auto& set : sets->sets) set.members.clear();
    for (std::size_t i = 0; i + 1 < all.size(); i += 2) {
      auto& set = sets->sets[std::stoul(all[i])];
      set.members.push_back(all[i + 1]);
      if (sets->find(all[i + 1]) < 0)
        reading.faults.add(set.where, "set " + set.name + " holds " + in_quotes(all[i + 1]) + ", which is not a set" +
                                          suggestion(all[i + 1], sets->names()));
    }
  }
}

namespace {

// Labels of a set and its members that this rank found, each once.
std::vector<long long> labels_of(const InpReading& reading, int number) {
  std::vector<long long> labels;
  for (const int i : reading.node_sets.with_members(number)) {
    const auto& set = reading.node_sets.sets[i];
    labels.insert(labels.end(), set.labels.begin(), set.labels.end());
    for (const auto& range : set.ranges)
      std::copy_if(reading.mesh.node_labels.begin(), reading.mesh.node_labels.end(), std::back_inserter(labels),
                   [&](long long label) { return range.holds(label); });
  }
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  return labels;
}

}  // namespace

void add_places(InpReading& reading) {
  auto& mesh = reading.mesh;
  for (std::size_t i = 0; i < reading.node_sets.sets.size(); ++i) {
    const auto& set = reading.node_sets.sets[i];
    mesh.places.push_back({set.name, set.where, labels_of(reading, static_cast<int>(i))});
  }
}

}  // namespace floe::mesh
