#include <set>

#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

struct Keyword {
  std::vector<std::string> parameters;
  void (*read)(const InpBlock&, InpReading&);
};

void nothing(const InpBlock&, InpReading&) {}

void left_out(const InpBlock& block, InpReading& reading) {
  const std::string why = block.keyword == "BOUNDARY" ? ": supports are joints of the scene" : "";
  reading.notices.push_back(reading.faults.text_of(block.where) + ": " + block.name + " is ignored" + why);
}

void read_instance(const InpBlock& block, InpReading& reading) {
  if (!reading.instance.empty()) reading.faults.add(block.where, "a second *INSTANCE: one is read, for one body");
  if (block.lines()) reading.faults.add(block.where, "an *INSTANCE that is moved is not read");
  reading.instance = required(block, "NAME", reading);
}

const std::map<std::string, Keyword>& keywords() {
  static const std::map<std::string, Keyword> all{
      {"NODE", {{"NSET"}, nothing}},
      {"ELEMENT", {{"TYPE", "ELSET"}, nothing}},
      {"NSET", {{"NSET", "GENERATE", "UNSORTED", "INTERNAL", "INSTANCE"}, read_set}},
      {"ELSET", {{"ELSET", "GENERATE", "UNSORTED", "INTERNAL", "INSTANCE"}, read_set}},
      {"SURFACE", {{"NAME", "TYPE", "INTERNAL"}, read_surface}},
      {"MATERIAL", {{"NAME", "DESCRIPTION"}, read_material}},
      {"ELASTIC", {{"TYPE"}, read_elastic}},
      {"DENSITY", {{}, read_density}},
      {"ORIENTATION", {{"NAME", "SYSTEM", "DEFINITION"}, read_orientation}},
      {"SHELLSECTION", {{"ELSET", "MATERIAL", "OFFSET", "ORIENTATION", "COMPOSITE", "CONTROLS"}, read_shell_section}},
      {"BEAMSECTION",
       {{"ELSET", "MATERIAL", "SECTION", "OFFSET1", "OFFSET2", "TEMPERATURE", "POISSON"}, read_beam_section}},
      {"BEAMGENERALSECTION",
       {{"ELSET", "MATERIAL", "SECTION", "OFFSET1", "OFFSET2", "DENSITY", "POISSON"}, read_beam_general_section}},
      {"MASS", {{"ELSET"}, read_mass}},
      {"RIGIDBODY",
       {{"NSET", "TIENSET", "REFNODE", "ROTNODE", "ELSET", "PINNSET", "ANALYTICALSURFACE"}, read_rigid_body}},
      {"MPC", {{}, read_mpc}},
      {"COUPLING", {{"CONSTRAINTNAME", "REFNODE", "SURFACE"}, read_coupling}},
      {"KINEMATIC", {{}, read_kinematic}},
      {"PART", {{"NAME"}, nothing}},
      {"ENDPART", {{}, nothing}},
      {"ASSEMBLY", {{"NAME"}, nothing}},
      {"ENDASSEMBLY", {{}, nothing}},
      {"INSTANCE", {{"NAME", "PART"}, read_instance}},
      {"ENDINSTANCE", {{}, nothing}},
      {"HEADING", {{}, nothing}},
      {"PREPRINT", {{"ECHO", "MODEL", "HISTORY", "CONTACT"}, nothing}},
      {"BOUNDARY", {{"OP", "FIXED", "AMPLITUDE", "TYPE"}, left_out}},
      {"AMPLITUDE", {{"NAME", "TIME", "DEFINITION", "VALUE", "USER", "SHIFTX", "SHIFTY"}, left_out}},
      {"TIMEPOINTS", {{"NAME", "TIME", "GENERATE"}, left_out}},
      {"EXPANSION", {{"TYPE", "ZERO"}, left_out}},
      {"CONDUCTIVITY", {{"TYPE"}, left_out}},
      {"SPECIFICHEAT", {{}, left_out}},
  };
  return all;
}

void check_parameters(const InpBlock& block, const Keyword& keyword, Faults& faults) {
  for (const auto& [key, value] : block.parameters)
    if (std::find(keyword.parameters.begin(), keyword.parameters.end(), key) == keyword.parameters.end())
      faults.add(block.where, "parameter " + in_quotes(key) + " of " + block.name + " is unknown" +
                                  suggestion(key, keyword.parameters));
}

// From *STEP on: skips to *END STEP, and says once what is skipped.
std::size_t skip_steps(const std::vector<InpBlock>& blocks, std::size_t i, InpReading& reading) {
  const auto& step = blocks[i];
  std::string inside;
  std::set<std::string> told;
  for (++i; i < blocks.size() && blocks[i].keyword != "ENDSTEP"; ++i)
    if (told.insert(blocks[i].keyword).second) inside += (inside.empty() ? " (" : ", ") + blocks[i].name;
  if (i == blocks.size())
    reading.faults.add(step.where, "*STEP has no *END STEP");
  else
    reading.notices.push_back(reading.faults.text_of(step.where) + ": what is between *STEP and *END STEP (line " +
                              std::to_string(blocks[i].where.at) + ") is ignored" + inside +
                              (inside.empty() ? "" : ")") + ": supports and loads are those of the scene");
  return i;
}

void refuse_unknown(const InpBlock& block, Faults& faults) {
  std::vector<std::string> known;
  for (const auto& [name, unused] : keywords()) known.push_back("*" + name);
  faults.add(block.where, "keyword " + in_quotes(block.name) + " is not read" + suggestion("*" + block.keyword, known));
}

// *PART, *ASSEMBLY: one part, and no nodes or elements outside it.
void check_nesting(const InpBlock& block, int& parts, bool& in_assembly, Faults& faults) {
  if (block.keyword == "PART" && ++parts > 1) faults.add(block.where, "a second *PART: one is read, for one body");
  if (block.keyword == "ASSEMBLY" || block.keyword == "ENDINSTANCE") in_assembly = true;
  if (block.keyword == "INSTANCE" || block.keyword == "ENDASSEMBLY") in_assembly = false;
  if (in_assembly && (block.keyword == "NODE" || block.keyword == "ELEMENT"))
    faults.add(block.where, block.name + " of the *ASSEMBLY is not read: define it in the *PART");
}

}  // namespace

void read_blocks(const std::vector<InpBlock>& blocks, InpReading& reading) {
  InpShares shares = shares_of(blocks, reading.rank, reading.ranks, reading.faults);
  int parts = 0;
  bool in_assembly = false;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto& block = blocks[i];
    const auto keyword = keywords().find(block.keyword);
    if (reading.coupling && block.keyword != "KINEMATIC")
      reading.faults.add(std::exchange(reading.coupling, std::nullopt)->where,
                         "*COUPLING is read with *KINEMATIC only");
    if (block.keyword == "STEP") {
      i = skip_steps(blocks, i, reading);
      continue;
    }
    if (keyword == keywords().end()) {
      refuse_unknown(block, reading.faults);
      continue;
    }
    check_nesting(block, parts, in_assembly, reading.faults);
    check_parameters(block, keyword->second, reading.faults);
    if (block.keyword == "NODE") read_inp_nodes(block, shares, reading);
    if (block.keyword == "ELEMENT") read_inp_elements(block, shares, reading);
    keyword->second.read(block, reading);
  }
  if (reading.coupling) reading.faults.add(reading.coupling->where, "*COUPLING is read with *KINEMATIC only");
}

}  // namespace floe::mesh
