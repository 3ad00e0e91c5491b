#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

/// Calls visit(kind, name) for each name that a block defines.
template <class Visit>
void each_definition(const InpBlock& block, const Visit& visit) {
  static const std::tuple<const char*, const char*, InpName> definitions[] = {
      {"NSET", "NSET", InpName::nodes},      {"NODE", "NSET", InpName::nodes},
      {"ELSET", "ELSET", InpName::elements}, {"ELEMENT", "ELSET", InpName::elements},
      {"SURFACE", "NAME", InpName::surface}, {"ORIENTATION", "NAME", InpName::orientation}};
  for (const auto& [keyword, parameter, kind] : definitions)
    if (const auto name = block.parameters.find(parameter); block.keyword == keyword && name != block.parameters.end())
      visit(kind, upper(name->second));
}

}  // namespace

bool InpScopes::enter(const std::string& keyword) {
  if (keyword == "PART" || keyword == "INSTANCE") in_part = true;
  if (keyword == "ENDPART" || keyword == "ENDINSTANCE") in_part = false;
  return in_part;
}

void InpScopes::find(const std::vector<InpBlock>& blocks) {
  std::set<std::pair<InpName, std::string>> of_part;
  for (const InpBlock& block : blocks) {
    const bool inside = enter(block.keyword);
    if (const auto name = block.parameters.find("NAME"); block.keyword == "INSTANCE" && name != block.parameters.end())
      instance = name->second;
    each_definition(block, [&](InpName kind, const std::string& name) {
      if (inside) of_part.insert({kind, name});
    });
  }
  for (const InpBlock& block : blocks) {
    const bool inside = enter(block.keyword);
    each_definition(block, [&](InpName kind, const std::string& name) {
      if (!inside && of_part.contains({kind, name})) twice.insert({kind, name});
    });
  }
  in_part = false;
}

std::string InpScopes::own(const std::string& name, InpName kind) const {
  if (instance.empty()) return name;
  const auto dot = name.find('.');
  const bool qualified = dot != std::string::npos && upper(name.substr(0, dot)) == upper(instance);
  if (!qualified && !in_part) return name;
  const std::string plain = qualified ? name.substr(dot + 1) : name;
  return twice.contains({kind, upper(plain)}) ? instance + "." + plain : plain;
}

std::string InpScopes::whole(const std::string& name) const {
  for (const InpName kind : {InpName::nodes, InpName::surface})
    if (const std::string found = own(name, kind); in_part && found != name) return found;
  return name;
}

}  // namespace floe::mesh
