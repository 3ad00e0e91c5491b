#include "nas_reader.h"
#include "text.h"

namespace floe::mesh {
namespace {

void read_spc(NasReader& r) {
  const auto& card = r.card.card;
  r.count_ignored(card.name);
  const long long set = r.card.integer(0, "the set's number", 0);
  auto& nodes = r.model.supports[set];
  if (card.name == "SPC") {
    for (std::size_t i : {1, 4})  // some programs write 0 where there is no second grid
      if (const long long grid = r.card.integer(i, "a grid", 0); grid != 0) nodes.emplace_back(grid, r.where());
    return;
  }
  if (upper(card.text(3)) == "THRU") {
    const long long first = r.card.integer(2, "a grid"), last = r.card.integer(4, "a grid");
    if (r.card.good()) r.model.support_ranges.push_back({set, first, last, r.where()});
    return;
  }
  for (std::size_t i = 2; i < card.fields.size(); ++i)
    if (!card.blank(i)) nodes.emplace_back(r.card.integer(i, "a grid"), r.where());
}

void read_param(NasReader& r) {
  if (upper(r.card.card.text(0)) == "WTMASS") {
    r.model.mass_factor = r.card.positive(1, "a factor on all masses");
    return;
  }
  r.count_ignored(r.card.card.name);
}

void read_defaults(NasReader& r) {
  if (r.card.card.name != "GRDSET" && !r.model.beams.empty()) r.card.refuse_card("is expected before the first beam");
  if (r.card.card.name == "GRDSET" && NasGrid::are_constrained(r.card.card.text(6))) r.count_ignored("GRDSET PS");
  NasCard& kept = r.model.defaults[r.card.card.name] = r.card.card;
  for (auto& field : kept.fields) field = r.model.texts.emplace_back(field);
}

using Read = void (*)(NasReader&);
const std::map<std::string, Read>& nas_readers() {
  static const std::map<std::string, Read> all{{"GRID", read_grid},
                                               {"GRDSET", read_defaults},
                                               {"BAROR", read_defaults},
                                               {"BEAMOR", read_defaults},
                                               {"CORD1R", read_axes},
                                               {"CORD1C", read_axes},
                                               {"CORD1S", read_axes},
                                               {"CORD2R", read_axes},
                                               {"CORD2C", read_axes},
                                               {"CORD2S", read_axes},
                                               {"CQUAD4", read_shell},
                                               {"CQUADR", read_shell},
                                               {"CTRIA3", read_shell},
                                               {"CTRIAR", read_shell},
                                               {"CQUAD8", read_shell},
                                               {"CTRIA6", read_shell},
                                               {"CBAR", read_beam},
                                               {"CBEAM", read_beam},
                                               {"PSHELL", read_pshell},
                                               {"PCOMP", read_pcomp},
                                               {"PCOMPG", read_pcomp},
                                               {"PBAR", read_pbar},
                                               {"PBARL", read_pbarl},
                                               {"PBEAM", read_pbeam},
                                               {"PBEAML", read_pbarl},
                                               {"MAT1", read_mat1},
                                               {"MAT2", read_mat2},
                                               {"MAT8", read_mat8},
                                               {"MAT3", read_other_material},
                                               {"MAT9", read_other_material},
                                               {"MAT10", read_other_material},
                                               {"MAT11", read_other_material},
                                               {"CROD", read_rod},
                                               {"CTUBE", read_rod},
                                               {"CONROD", read_conrod},
                                               {"PROD", read_prod},
                                               {"PTUBE", read_prod},
                                               {"CELAS1", read_celas},
                                               {"CELAS2", read_celas},
                                               {"PELAS", read_pelas},
                                               {"CBUSH", read_cbush},
                                               {"PBUSH", read_pbush},
                                               {"CONM2", read_conm2},
                                               {"CONM1", read_conm1},
                                               {"CMASS1", read_cmass},
                                               {"CMASS2", read_cmass},
                                               {"PMASS", read_pmass},
                                               {"RBE2", read_rbe2},
                                               {"RBE3", read_rbe3},
                                               {"RBAR", read_rbar},
                                               {"SPC", read_spc},
                                               {"SPC1", read_spc},
                                               {"PARAM", read_param}};
  return all;
}

using Groups = std::vector<std::pair<const char*, std::vector<const char*>>>;

std::map<std::string, std::string> reasons_of(const Groups& groups) {
  std::map<std::string, std::string> all;
  for (const auto& [why, names] : groups)
    for (const char* name : names) all.emplace(name, why);
  return all;
}

const std::map<std::string, std::string>& nas_ignored() {
  static const auto all = reasons_of(
      {{"",
        {"PARAM",   "EIGRL",   "EIGR",    "EIGB",    "EIGC",    "EIGP",    "TSTEP",   "TSTEPNL", "NLPARM",  "NLPCI",
         "NLSTEP",  "FREQ",    "FREQ1",   "FREQ2",   "FREQ3",   "FREQ4",   "TABLED1", "TABLED2", "TABLED3", "TABLED4",
         "TABLEM1", "TABLES1", "TABRND1", "RANDPS",  "ASET",    "ASET1",   "OMIT",    "OMIT1",   "BSET",    "BSET1",
         "CSET",    "CSET1",   "QSET",    "QSET1",   "USET",    "USET1",   "SET1",    "SET3",    "MDLPRM",  "DTI",
         "PLOTEL",  "DESVAR",  "DVPREL1", "DVPREL2", "DCONSTR", "DRESP1",  "DRESP2",  "DOPTPRM", "DEQATN",  "DLINK",
         "DSCREEN", "TOPVAR",  "PSET",    "PVAL",    "MONPNT1", "ECHOON",  "ECHOOFF", "SEQGP",   "SESET",   "SNORM",
         "DCONADD", "DVMREL1", "MODTRAK", "SUPAX",   "CONTRLT", "TSTEP1",  "PSOLID",  "PELAST",  "PBUSHT",  "PDAMP",
         "PVISC",   "PSHEAR",  "PGAP",    "PLSOLID", "PBUSH1D", "PFAST",   "PWELD",   "TABLEM2", "TABLEM3", "TABLEM4",
         "RANDT1",  "TABRNDG", "PLPLANE", "CBARAO",  "DTABLE",  "DVGRID",  "NLCNTL2", "NLCNTLG", "TABLED5", "PDAMPT",
         "PFASTT",  "SURF",    "PANEL",   "SWLDPRM", "DRESP3",  "DSCONS",  "DVCREL1", "DVCREL2", "DVMREL2", "DVSET",
         "TOMVAR",  "BMFACE",  "GROUP",   "MONPNT3", "MONDSP1", "TSTEPE",  "SEQSET",  "SEQSET1", "SEBSET",  "SEBSET1",
         "SECSET",  "SECSET1", "SEUSET",  "SEUSET1", "SESUP",   "SELABEL", "SEBNDRY", "SETREE",  "SELOAD",  "SEEXCLD",
         "RVDOF",   "RVDOF1",  "BNDFREE", "BNDFRE1", "BNDFIX",  "BNDFIX1", "MASSSET", "SET2",    "OUTPUT",  "OUTRCV",
         "GMBC",    "GMLOAD",  "FEEDGE",  "FEFACE",  "FECURV",  "GMCURV",  "GMSURF",  "RANDVAR", "PRESPT",  "FREQ5",
         "RCROSS",  "RCROSSC", "DYNRED",  "TEMPAX",  "POINT",   "ADAPT",   "EIGRAL",  "DEBUG"}},
       {"loads are those of the scene",
        {"FORCE",  "FORCE1", "FORCE2", "MOMENT", "MOMENT1", "MOMENT2", "PLOAD", "PLOAD1", "PLOAD2", "PLOAD4", "PLOADB3",
         "GRAV",   "ACCEL",  "ACCEL1", "RFORCE", "LOAD",    "TEMP",    "TEMPD", "TEMPP1", "TEMPRB", "SLOAD",  "DAREA",
         "TLOAD1", "TLOAD2", "RLOAD1", "RLOAD2", "DLOAD",   "LSEQ",    "DELAY", "DPHASE", "DEFORM", "TIC",    "NOLIN1",
         "NOLIN2", "NOLIN3", "NOLIN4", "CLOAD",  "PLOADX1", "TEMPP3",  "TF",    "BOLT",   "BOLTFOR"}},
       {"supports are joints of the scene", {"SPC", "SPC1", "SPCADD", "SPCD", "SPCOFF", "SUPORT", "SUPORT1", "SPCR"}},
       {"the nodes are not tied by it", {"MPCADD", "CYJOIN", "CYSYM"}},
       {"damping is that of the scene",
        {"TABDMP1", "DAMPING", "CDAMP1", "CDAMP2", "CDAMP3", "CDAMP4", "CDAMP5", "CVISC"}},
       {"the material is linear elastic, at one temperature",
        {"MATS1", "MATT1", "MATT2", "MATT3", "MATT8", "MATT9", "MATT11", "CREEP", "MATHP", "MATEP", "MATF", "MATG"}},
       {"heat does not concern the body",
        {"MAT4",  "MAT5",  "MATT4",  "MATT5",  "CHBDYE", "CHBDYG", "CHBDYP", "CONV",  "PCONV",  "QBDY1",
         "QBDY2", "QBDY3", "QVOL",   "VIEW",   "VIEW3D", "PHBDY",  "QHBDY",  "CONVM", "PCONVM", "RADM",
         "RADMT", "RADBC", "RADSET", "RADCAV", "RADLST", "RADMTX", "BDYOR",  "TEMPBC"}},
       {"acoustics do not concern the body",
        {"ACMODL", "AMLREG", "ACORDER", "ACADAPT", "ACSRCE", "ACPLNW", "MICPNT", "PMIC", "BEDGE", "CHACAB", "CHACBR",
         "PACABS", "PACBAR", "CAABSF", "PAABSF", "CACINF3", "CACINF4", "PACINF"}},
       {"rotors rotate by joints of the scene",
        {"ROTORG", "ROTORD", "ROTORSE", "RGYRO", "RSPINR", "RSPINT", "UNBALNC"}},
       {"a point without coordinates is no node of the body", {"SPOINT", "EPOINT"}},
       {"contact is not represented",
        {"CGAP",    "BCTABLE", "BCBODY",  "BCONP",   "BSURF",   "BSURFS",  "BCTSET",  "BCTADD",  "BCTPARM", "BCPARA",
         "BCBDPRP", "BCPROP",  "BLSEG",   "BFRIC",   "BCTPARA", "BCRPARA", "CONTACT", "BGSET",   "BGADD",   "BGPARM",
         "BCONPRG", "BCONPRP", "BCTABL1", "BCBODY1", "BCONECT", "BCMOVE",  "BCRIGID", "BCRGSRF", "BCPATCH", "BCBZIER",
         "BCNURBS", "BCNURB2", "BCAUTOP", "BCSCAP",  "BCGRID",  "BCHANGE", "BCSEG",   "BCONUDS", "BSQUEAL"}},
       {"matrices of a file are not added", {"DMIG", "DMI", "DMIK", "DMIJ"}},
       {"aerodynamic forces are those of the scene",
        {"AERO",    "AEROS",   "CAERO1",  "CAERO2",  "PAERO1",  "PAERO2",  "SPLINE1", "SPLINE2", "AEFACT",
         "AESTAT",  "AESURF",  "AELIST",  "AELINK",  "TRIM",    "AECOMP",  "AECOMPL", "AEDW",    "AEFORCE",
         "AEPARM",  "AEPRESS", "AESCALE", "AESURFS", "CAERO3",  "CAERO4",  "CAERO5",  "CSSCHD",  "FLUTTER",
         "MKAERO2", "PAERO3",  "PAERO4",  "PAERO5",  "SPLINE3", "SPLINE4", "SPLINE5", "SPLINE6", "SPLINE7",
         "SPBLND1", "SPBLND2", "UXVEC",   "MONPNT2", "AELISTC", "MKAERO1", "FLFACT",  "GUST",    "DIVERG"}},
       {"a density, NSM or CONM2 is expected instead", {"NSM", "NSM1", "NSML", "NSML1", "NSMADD"}}});
  return all;
}

const std::map<std::string, std::string>& nas_others() {
  static const auto all = reasons_of(
      {{"a solid", {"CTETRA", "CHEXA", "CPENTA", "CPYRAM", "CTRIAX6", "CTRIAX", "CQUADX", "CQUADX4", "CQUADX8"}},
       {"a shell of nine nodes; use CQUAD8", {"CQUAD"}},
       {"a beam of second order or a curved one", {"CBEAM3", "CBEND"}},
       {"a shear panel", {"CSHEAR"}},
       {"a spring of another kind; use CBUSH or CELAS2 between grids",
        {"CELAS3", "CELAS4", "CBUSH1D", "CBUSH2D", "GENEL"}},
       {"a connector", {"CFAST", "CWELD", "CSEAM"}},
       {"a mass at scalar points; use CONM2 or CMASS2", {"CMASS3", "CMASS4"}},
       {"a rigid element of another kind; use RBE2 or RBAR",
        {"RBE1", "RBAR1", "RROD", "RTRPLT", "RTRPLT1", "RSPLINE", "RSSCON", "RJOINT"}},
       {"an equation of displacements, which ties nodes; use RBE2 or RBAR", {"MPC", "MPCY"}},
       {"axes by another rule; use CORD2R", {"CORD3G", "CORD3R", "CORD3C", "CORD3S"}},
       {"a section that is not read; use PBAR, PBARL or PBEAM", {"PBRSECT", "PBMSECT", "PBCOMP", "PBEND", "PBEAM3"}},
       {"a part of the model connected by a matrix or other points",
        {"SECONCT", "SELOC", "SEMPLN", "CSUPEXT", "SEELT"}}});
  return all;
}

}  // namespace

std::vector<std::string> nas_names() {
  std::vector<std::string> names;
  for (const auto& [name, unused] : nas_readers()) names.push_back(name);
  for (const auto& [name, unused] : nas_ignored()) names.push_back(name);
  for (const auto& [name, unused] : nas_others()) names.push_back(name);
  return names;
}

std::string nas_refusal(const std::string& name) {
  const auto found = nas_others().find(name);
  return found == nas_others().end() ? "" : found->second;
}

std::string nas_reason(const std::string& name) {
  static const std::map<std::string, std::string> of_fields{
      {"GRID PS", "supports are joints of the scene"},
      {"GRDSET PS", "supports are joints of the scene"},
      {"PSHELL without MID2 (membranes)", "these shells have the bending stiffness of MID1 and the thickness"},
      {"PSHELL MID3",
       "shells of first order have no transverse shear deformation, those of second order have 5/6 of G of their "
       "material"},
      {"MAT1 G", "shells take E and nu, beams E and G, which differ by more than 1 % from E = 2 G (1 + nu)"},
      {"GE", "damping is that of the scene"},
      {"second order of CQUAD8 without grids between corners", "read as CQUAD4"},
      {"second order of CTRIA6 without grids between corners", "read as CTRIA3"},
      {"axis of the NSM of PBEAML", "the nonstructural mass is at the centroid, as that of the section"},
      {"PBEAM M1, M2", "the nonstructural mass is at the centroid (N1, N2), as that of the section"},
      {"PBEAM S1, S2", "shear forces of beams are not relieved by taper"},
      {"PBEAM NSI", "the nonstructural mass is spread over the section"},
      {"PBEAM CW", "beams have no warping stiffness"},
      {"CBEAM SA, SB", "beams have no warping stiffness"},
      {"MAT1 without E and G", "no shell or beam uses it"},
      {"MAT3", "no shell or beam uses it"},
      {"MAT9", "no shell or beam uses it"},
      {"MAT10", "no shell or beam uses it"},
      {"MAT11", "no shell or beam uses it"},
      {"PBUSH B, GE", "damping is that of the scene"},
      {"PBUSH M", "a spring has no mass; use CONM2"}};
  if (const auto found = of_fields.find(name); found != of_fields.end()) return found->second;
  const auto found = nas_ignored().find(name);
  return found == nas_ignored().end() ? "" : found->second;
}

void read_nas_card(const NasCard& card, NasModel& model, Faults& faults) {
  NasFields fields(card, faults);
  NasReader reader{fields, model};
  const auto& readers = nas_readers();
  const auto count = [&](std::map<std::string, NasCount>& in) {
    in.try_emplace(card.name, NasCount{card.where(), 0}).first->second.times++;
  };
  if (const auto read = readers.find(card.name); read != readers.end()) {
    for (const auto& [where, text] : card.beyond) faults.add(where, text);
    read->second(reader);
  } else if (nas_ignored().contains(card.name))
    count(model.ignored);
  else if (nas_others().contains(card.name))
    count(model.refused);
  else
    count(model.unknown);
}

}  // namespace floe::mesh
