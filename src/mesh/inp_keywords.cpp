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

/// Without data the nodes after it are in global coordinates, as without it.
void read_system(const InpBlock& block, InpReading& reading) {
  if (block.lines() > 0)
    reading.faults.add(block.where, block.name +
                                        " is read without data lines: expected nodes in global coordinates, "
                                        "or an *INSTANCE that is moved");
}

const std::map<std::string, Keyword>& keywords() {
  static const std::map<std::string, Keyword> all{
      {"NODE", {{"NSET", "SYSTEM"}, nothing}},
      {"ELEMENT", {{"TYPE", "ELSET"}, nothing}},
      {"NSET", {{"NSET", "GENERATE", "UNSORTED", "INTERNAL", "INSTANCE"}, read_set}},
      {"ELSET", {{"ELSET", "GENERATE", "UNSORTED", "INTERNAL", "INSTANCE"}, read_set}},
      {"SURFACE", {{"NAME", "TYPE", "INTERNAL", "COMBINE", "TRIM", "REGIONTYPE", "FILLETRADIUS"}, read_surface}},
      {"MATERIAL", {{"NAME", "DESCRIPTION", "RTOL"}, read_material}},
      {"ELASTIC", {{"TYPE", "MODULI"}, read_elastic}},
      {"DENSITY", {{}, read_density}},
      {"ORIENTATION", {{"NAME", "SYSTEM", "DEFINITION"}, read_orientation}},
      {"SHELLSECTION",
       {{"ELSET", "MATERIAL", "OFFSET", "ORIENTATION", "COMPOSITE", "CONTROLS", "SYMMETRIC", "NODALTHICKNESS",
         "POISSON", "TEMPERATURE", "THICKNESSMODULUS", "SECTIONINTEGRATION", "LAYUP", "DENSITY", "STACKDIRECTION"},
        read_shell_section}},
      {"SHELLGENERALSECTION",
       {{"ELSET", "MATERIAL", "OFFSET", "ORIENTATION", "COMPOSITE", "CONTROLS", "SYMMETRIC", "NODALTHICKNESS",
         "POISSON", "TEMPERATURE", "THICKNESSMODULUS", "LAYUP", "DENSITY"},
        read_shell_general_section}},
      {"TRANSVERSESHEARSTIFFNESS", {{}, read_transverse_shear}},
      {"TRANSVERSESHEAR", {{}, read_transverse_shear}},
      {"SPRING", {{"ELSET", "RTOL"}, read_spring}},
      {"BEAMSECTION",
       {{"ELSET", "MATERIAL", "SECTION", "OFFSET1", "OFFSET2", "TEMPERATURE", "POISSON", "NODALTHICKNESS", "LUMPED"},
        read_beam_section}},
      {"BEAMGENERALSECTION",
       {{"ELSET", "MATERIAL", "SECTION", "OFFSET1", "OFFSET2", "DENSITY", "POISSON", "LUMPED"},
        read_beam_general_section}},
      {"MASS", {{"ELSET", "TYPE"}, read_mass}},
      {"RIGIDBODY",
       {{"NSET", "TIENSET", "REFNODE", "ROTNODE", "ELSET", "PINNSET", "ANALYTICALSURFACE"}, read_rigid_body}},
      {"MPC", {{}, read_mpc}},
      {"COUPLING", {{"CONSTRAINTNAME", "REFNODE", "SURFACE"}, read_coupling}},
      {"KINEMATIC", {{}, read_kinematic}},
      {"DISTRIBUTING", {{"COUPLING", "WEIGHTINGMETHOD"}, read_distributing}},
      {"TIE",
       {{"NAME", "POSITIONTOLERANCE", "ADJUST", "TYPE", "NOROTATION", "CYCLICSYMMETRY", "MULTISTAGE", "FLUIDCYCLIC",
         "FLUIDPERIODIC", "TIEDNSET", "CONSTRAINTRATIO", "NOTHICKNESS"},
        read_tie}},
      {"EQUATION", {{}, read_equation}},
      {"TRANSFORM", {{"NSET", "TYPE"}, read_transform}},
      {"SYSTEM", {{}, read_system}},
      {"PART", {{"NAME"}, nothing}},
      {"ENDPART", {{}, nothing}},
      {"ASSEMBLY", {{"NAME"}, nothing}},
      {"ENDASSEMBLY", {{}, nothing}},
      {"INSTANCE", {{"NAME", "PART"}, read_instance}},
      {"ENDINSTANCE", {{}, read_end_instance}},
      {"HEADING", {{}, nothing}},
      {"PREPRINT", {{"ECHO", "MODEL", "HISTORY", "CONTACT"}, nothing}},
      {"NODALTHICKNESS", {{}, read_nodal_thickness}},
  };
  return all;
}

// What does not make a linear elastic body: keywords by the reason that their notice gives.
const std::map<std::string, std::string>& ignored_keywords() {
  static const std::map<std::string, std::string> all = [] {
    const std::pair<const char*, std::vector<const char*>> groups[] = {
        {"",
         {"AMPLITUDE",
          "CFDCONTROLS",
          "CONSTRAINT",
          "CONTROLS",
          "CORRELATIONLENGTH",
          "IMPERFECTION",
          "DESIGNRESPONSE",
          "DESIGNVARIABLES",
          "ELEMENTOUTPUT",
          "ELFILE",
          "ELPRINT",
          "FACEPRINT",
          "FILEFORMAT",
          "FILTER",
          "NODEFILE",
          "NODEOUTPUT",
          "NODEPRINT",
          "OBJECTIVE",
          "OUTPUT",
          "PHYSICALCONSTANTS",
          "RANDOMFIELD",
          "RESTART",
          "SECTIONCONTROLS",
          "SECTIONPRINT",
          "TIMEPOINTS",
          "USERSUBROUTINES",
          "WAVEFRONTMINIMIZATION"}},
        {"heat and other fields do not concern the body",
         {"CONDUCTIVITY", "ELECTRICALCONDUCTIVITY", "EXPANSION", "FLUIDCONSTANTS", "FLUIDSECTION",
          "MAGNETICPERMEABILITY", "RADIATE", "FILM", "FILMPROPERTY", "SPECIFICGASCONSTANT", "SPECIFICHEAT",
          "VALUESATINFINITY", "VIEWFACTOR", "LATENTHEAT"}},
        {"supports are joints of the scene", {"BOUNDARY", "BASEMOTION", "SUBMODEL"}},
        {"elements have no hourglass modes", {"HOURGLASSSTIFFNESS"}},
        {"nothing that is read varies by it", {"DISTRIBUTION", "DISTRIBUTIONTABLE"}},
        {"loads are those of the scene", {"CLOAD", "DLOAD", "DSLOAD", "TEMPERATURE", "CFLUX", "DFLUX"}},
        {"the body is at rest and without stress at the beginning", {"INITIALCONDITIONS"}},
        {"the nodes are not tied by it",
         {"CYCLICSYMMETRYMODEL", "EMBEDDEDELEMENT", "FASTENER", "DISTRIBUTINGCOUPLING", "PRE-TENSIONSECTION",
          "CONNECTORSECTION"}},
        {"contact is not represented",
         {"CHANGECONTACTTYPE", "CLEARANCE", "CONTACT", "FRICTION", "GAPCONDUCTANCE", "GAPHEATGENERATION",
          "SURFACEBEHAVIOR", "SURFACEINTERACTION", "SURFACEPROPERTYASSIGNMENT", "SURFACESMOOTHING"}},
        {"the material is linear elastic",
         {"CONCRETE", "CREEP", "CYCLICHARDENING", "DAMAGEEVOLUTION", "DAMAGEINITIATION", "DEFORMATIONPLASTICITY",
          "DEPVAR", "DRUCKERPRAGER", "FAILSTRESS", "HYPERELASTIC", "HYPERFOAM", "MOHRCOULOMB", "MOHRCOULOMBHARDENING",
          "PLASTIC", "RATEDEPENDENT", "USERMATERIAL", "VISCOELASTIC", "VISCOUS"}},
        {"damping is that of the scene", {"DAMPING", "DASHPOT"}},
        {"mass that is not of a density or *MASS is not taken over", {"NONSTRUCTURALMASS", "ROTARYINERTIA"}},
        {"elements use the normals of their nodes' positions", {"NORMAL"}},
        {"it is outside of a *STEP",
         {"STATIC", "FREQUENCY", "DYNAMIC", "MODALDYNAMIC", "BUCKLE", "STEADYSTATEDYNAMICS", "HEATTRANSFER", "VISCO",
          "ENDSTEP"}},
        {"it belongs to elements of another kind",
         {"SOLIDSECTION", "MEMBRANESECTION", "GAP", "USERELEMENT", "COHESIVESECTION", "SURFACESECTION",
          "CONNECTORBEHAVIOR", "CONNECTORELASTICITY", "CONNECTORDAMPING"}}};
    std::map<std::string, std::string> reasons;
    for (const auto& [why, names] : groups)
      for (const char* name : names) reasons.emplace(name, why);
    return reasons;
  }();
  return all;
}

// *CONTACT PAIR, *CONTACT FILE, ... are as *CONTACT; *EXPANSION TYPE=ISO lacks a comma.
std::string family_of(const std::string& keyword) {
  for (const char* family : {"CONTACT", "EXPANSION"})
    if (keyword.starts_with(family)) return family;
  return keyword;
}

void check_parameters(const InpBlock& block, const Keyword& keyword, Faults& faults) {
  for (const auto& [key, value] : block.parameters)
    if (std::find(keyword.parameters.begin(), keyword.parameters.end(), key) == keyword.parameters.end())
      faults.add(block.where, "parameter " + in_quotes(key) + " of " + block.name + " is unknown" +
                                  suggestion(key, keyword.parameters));
}

// What a step holds that acts on the body: its lines are counted.
bool acts(const std::string& keyword) {
  static const std::set<std::string> all{"BOUNDARY",    "CLOAD",      "DLOAD",        "DSLOAD",
                                         "TEMPERATURE", "BASEMOTION", "INERTIARELIEF"};
  return all.contains(keyword);
}

// From *STEP on: skips to *END STEP, and says once what is skipped.
std::size_t skip_steps(const std::vector<InpBlock>& blocks, std::size_t i, InpReading& reading) {
  const auto& step = blocks[i];
  std::string inside;
  std::set<std::string> told;
  std::vector<std::pair<std::string, long long>> acting;
  for (++i; i < blocks.size() && blocks[i].keyword != "ENDSTEP"; ++i) {
    if (told.insert(blocks[i].keyword).second) {
      inside += (inside.empty() ? " (" : ", ") + blocks[i].name;
      if (acts(blocks[i].keyword)) acting.emplace_back(blocks[i].name, 0);
    }
    for (auto& [name, lines] : acting)
      if (folded(name) == "*" + blocks[i].keyword) lines += blocks[i].lines();
  }
  std::vector<std::string> counts;
  for (const auto& [name, lines] : acting) counts.push_back(name + " " + counted(lines, "line"));
  if (i == blocks.size())
    reading.faults.add(step.where, "*STEP has no *END STEP");
  else
    reading.notices.push_back(reading.faults.text_of(step.where) + ": what is between *STEP and *END STEP (line " +
                              std::to_string(blocks[i].where.at) + ") is ignored" + inside +
                              (inside.empty() ? "" : ")") + ": supports and loads are those of the scene" +
                              (counts.empty() ? "" : "; not taken over: " + listed(counts)));
  return i;
}

void refuse_unknown(const InpBlock& block, Faults& faults) {
  std::vector<std::string> known;
  for (const auto& [name, unused] : keywords()) known.push_back("*" + name);
  for (const auto& [name, unused] : ignored_keywords()) known.push_back("*" + name);
  faults.add(block.where, "keyword " + in_quotes(block.name) + " is not read" + suggestion("*" + block.keyword, known));
}

/// Where the blocks so far end.
struct Nesting {
  bool part = false, assembly = false, instance = false;  // one was there, it is open, one was there
};

// *PART, *ASSEMBLY: one part, no elements outside it, and no nodes that would move with the instance.
void check_nesting(const InpBlock& block, Nesting& so_far, Faults& faults) {
  if (block.keyword == "PART" && std::exchange(so_far.part, true))
    faults.add(block.where, "a second *PART: one is read, for one body");
  if (block.keyword == "ASSEMBLY" || block.keyword == "ENDINSTANCE") so_far.assembly = true;
  if (block.keyword == "INSTANCE" || block.keyword == "ENDASSEMBLY") so_far.assembly = false;
  so_far.instance = so_far.instance || block.keyword == "INSTANCE";
  const bool early = block.keyword == "NODE" && so_far.assembly && !so_far.instance;
  if (early || (so_far.assembly && block.keyword == "ELEMENT"))
    faults.add(block.where, block.name + " of the *ASSEMBLY is not read" +
                                (early ? " before its *INSTANCE" : ": define it in the *PART"));
}

void refuse_open_coupling(InpReading& reading) {
  reading.faults.add(std::exchange(reading.coupling, std::nullopt)->where,
                     "*COUPLING is read with *KINEMATIC or *DISTRIBUTING after it");
}

}  // namespace

void ignore(const InpBlock& block, const std::string& why, InpReading& reading) {
  for (auto& one : reading.ignored) {
    if (upper(one.name) != upper(block.name)) continue;
    ++one.times, one.lines += block.lines();
    return;
  }
  reading.ignored.push_back({block.where, block.name, why, 1, block.lines()});
}

void report_ignored(InpReading& reading) {
  std::vector<std::string> lines;
  for (const auto& one : reading.ignored) {
    std::string text = reading.faults.text_of(one.where) + ": " + one.name + " is ignored";
    if (!one.why.empty()) text += ": " + one.why;
    if (one.lines > 0 && !one.why.empty()) text += " (" + counted(one.lines, "line") + ")";
    if (one.times > 1) text += ", " + std::to_string(one.times) + " times";
    lines.push_back(std::move(text));
  }
  reading.notices.insert(reading.notices.begin(), lines.begin(), lines.end());
}

void read_blocks(const std::vector<InpBlock>& blocks, InpReading& reading) {
  InpShares shares = shares_of(blocks, reading.rank, reading.ranks, reading.faults);
  reading.scopes.find(blocks);
  Nesting nesting;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto& block = blocks[i];
    reading.scopes.enter(block.keyword);
    const auto keyword = keywords().find(block.keyword);
    if (reading.coupling && block.keyword != "KINEMATIC" && block.keyword != "DISTRIBUTING")
      refuse_open_coupling(reading);
    if (block.keyword == "STEP") {
      i = skip_steps(blocks, i, reading);
      continue;
    }
    if (const auto why = ignored_keywords().find(family_of(block.keyword)); why != ignored_keywords().end()) {
      ignore(block, why->second, reading);
      continue;
    }
    if (keyword == keywords().end()) {
      refuse_unknown(block, reading.faults);
      continue;
    }
    check_nesting(block, nesting, reading.faults);
    check_parameters(block, keyword->second, reading.faults);
    if (block.keyword == "NODE") read_inp_nodes(block, shares, reading);
    if (block.keyword == "ELEMENT") read_inp_elements(block, shares, reading);
    keyword->second.read(block, reading);
  }
  if (reading.coupling) refuse_open_coupling(reading);
}

}  // namespace floe::mesh
