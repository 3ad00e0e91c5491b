#pragma once
#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

#include "floe/mesh/deck.h"
#include "nas_cards.h"

namespace floe::mesh {

struct NasGrid {
  long long id, cp, cd;  // axes of its position and of its displacements; 0: basic; -1: that of GRDSET
  Eigen::Vector3d x;
  std::optional<bool> constrained;  // in PS; none: as GRDSET gives it
  Where where;

  static bool are_constrained(std::string_view ps) { return !ps.empty() && ps != "0"; }
};

struct NasShell {
  long long id, property;
  std::array<long long, 4> nodes;
  int count;                                         // of its corners
  double angle;                                      // THETA [deg], where axes is -1
  long long axes;                                    // MCID; -1: none
  double offset;                                     // ZOFFS
  std::array<std::optional<double>, 4> thicknesses;  // T1..T4; none: that of the property
  bool ratio;                                        // of the property's thickness
  Where where;
  std::array<long long, 4> middles{-1, -1, -1, -1};  // of its edges from each corner to the next; of second order alone
  bool quadratic = false;
  bool has_thickness() const {
    const auto end = thicknesses.begin() + count;  // all zero is none, too
    return std::any_of(thicknesses.begin(), end, [](const auto& t) { return t.has_value(); }) &&
           !std::all_of(thicknesses.begin(), end, [](const auto& t) { return t == 0.0; });
  }
};

struct NasBeam {
  long long id, property;
  std::array<long long, 2> nodes;
  Eigen::Vector3d orientation;  // in the displacement axes of GA
  long long orientation_node;   // G0; 0: none
  std::array<Eigen::Vector3d, 2> offsets;
  Where where;
  unsigned releases = 0;                       // PA, PB: bits 0 to 5 and 6 to 11
  bool rod = false;                            // of no orientation
  unsigned alone = 0;                          // bits: ends at grids that rods alone hold
  bool in_basic = false;                       // the orientation vector (OFFT: B)
  std::array<bool, 2> own_axes{false, false};  // of the offsets: those of the element (OFFT: O)
};

/// CELAS1, CELAS2, CBUSH; grid 0: ground.
struct NasSpring {
  long long id;
  std::array<long long, 2> grids;
  std::array<int, 2> components{0, 0};  // 1 to 6 of a scalar spring
  double stiffness = 0;                 // of CELAS2
  long long property = 0;               // 0: none
  long long axes = -1;                  // CID of CBUSH
  Eigen::Vector3d orientation = Eigen::Vector3d::Zero();
  long long orientation_node = 0;
  double at = 0.5;
  Where where = {};
  bool scalar() const { return components != std::array<int, 2>{0, 0}; }
};

struct NasPly {
  long long material;
  double thickness, angle;
};

struct NasShellProperty {
  std::string name;  // PSHELL3
  std::vector<NasPly> plies;
  std::optional<double> bottom;  // Z0
  double extra;                  // nonstructural mass by area
  Where where;
  std::optional<long long> bending = {};  // MID2 where it is not MID1
  double factor = 1;                      // 12 I / T^3
  bool bends_apart() const { return bending || factor != 1; }
};

struct NasBeamProperty {
  std::string name;  // PBAR3
  long long material;
  BeamSection section;  // without material and orientation
  double area, extra;   // nonstructural mass per length
  Where where;
  std::vector<NasBeamProperty> pieces = {};  // of a beam with taper, from end A, of equal length
  unsigned releases = 0;                     // of the ends of such a beam, for constants that are 0
};

struct NasMaterial {
  Material material;
  double shear = 0;  // G of MAT1
  Where where;
};

struct NasAxes {
  char kind;            // R, C, S
  long long reference;  // of points; -1: they are grids
  std::array<Eigen::Vector3d, 3> points;
  std::array<long long, 3> grids;
  Where where;
};

struct NasMass {
  long long grid, axes;  // -1: the centre is given in basic axes
  PointMass mass;
  Where where;
  std::string name;  // CONM2 70
};

/// CONM1: of the three translations and the three rotations of a grid.
struct NasMassMatrix {
  long long grid, axes;
  std::string name;
  Where where;
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
};

/// CMASS1, CMASS2 between a grid and the ground.
struct NasScalarMass {
  long long id;
  std::string card;
  long long grid, property;  // 0: the mass is given
  int component;             // 1 to 6
  double mass;
  Where where;
};

struct NasLink {
  long long reference;
  std::vector<long long> nodes;
  Where where;
  std::string name = {};        // RBE2 7
  std::string constrains = {};  // 123 and some rotations of its dependent grids; empty: all
};

/// RBE3: the mean motion of grids.
struct NasMean {
  long long id, reference;
  std::vector<long long> nodes;
  Where where;
  std::vector<double> weights = {};  // of the nodes
};

/// A card that is not read: how often, and where first.
struct NasCount {
  Where where;
  long long times = 0;
};

/// What the cards say, the same on every rank.
struct NasModel {
  std::vector<NasGrid> grids;
  std::vector<NasShell> shells;
  std::vector<NasBeam> beams;
  std::map<long long, NasShellProperty> shell_properties;
  std::map<long long, NasBeamProperty> beam_properties;
  std::map<long long, NasMaterial> materials;
  std::map<long long, std::string> other_materials;  // names of those that shells and beams do not have
  std::map<long long, NasAxes> axes;
  std::vector<NasMass> masses;
  std::vector<NasMassMatrix> mass_matrices;
  std::vector<NasScalarMass> component_masses;
  std::map<long long, double> scalar_masses;  // PMASS
  std::vector<NasLink> links;
  std::vector<NasMean> means;
  std::vector<NasSpring> springs;
  std::map<long long, double> scalar_stiffness;                            // PELAS
  std::map<long long, std::array<double, 6>> bush_stiffness;               // PBUSH
  std::map<long long, std::vector<std::pair<long long, Where>>> supports;  // of each set: grids
  struct SupportRange {
    long long set, first, last;
    Where where;
  };
  std::vector<SupportRange> support_ranges;                   // THRU: of the grids of all cards
  std::map<std::string, NasCount> ignored, refused, unknown;  // by the card's name
  std::map<std::string, NasCard> defaults;                    // BAROR, BEAMOR, GRDSET
  std::deque<std::string> texts;                              // of their fields, which outlive their file
  double mass_factor = 1;                                     // PARAM,WTMASS
};

/// One card into the model; what is wrong becomes a fault.
void read_nas_card(const NasCard& card, NasModel& model, Faults& faults);

/// All names of cards that are read or ignored.
std::vector<std::string> nas_names();

/// Why a card of another kind is refused, as `a scalar spring`; "" where it is none of them.
std::string nas_refusal(const std::string& name);

/// Why an ignored card does not matter; "" where that is plain.
std::string nas_reason(const std::string& name);

/// Axes of the model, and positions in them, in basic axes.
class NasFrames {
 public:
  NasFrames(const NasModel& model, Faults& faults);

  /// Of a grid: nothing, and a fault at `where`, where there is none.
  std::optional<Eigen::Vector3d> position(long long grid, Where where);
  Eigen::Vector3d position_of(const NasGrid& grid);
  /// Directions 1, 2, 3 of axes at a point given in basic axes.
  Eigen::Matrix3d directions(long long axes, const Eigen::Vector3d& at, Where where);
  Eigen::Vector3d point(long long axes, const Eigen::Vector3d& x, Where where);
  const NasGrid* grid(long long id) const;
  long long displacement_axes(const NasGrid& grid) const { return grid.cd < 0 ? default_cd_ : grid.cd; }
  /// Whether the grid has supports of its own (PS).
  bool constrained(const NasGrid& grid) const { return grid.constrained.value_or(default_constrained_); }

 private:
  struct Frame {
    char kind = 'R';
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  };
  const Frame& frame(long long id, Where where);

  const NasModel& model_;
  Faults& faults_;
  long long default_cp_ = 0, default_cd_ = 0;
  bool default_constrained_ = false;
  std::unordered_map<long long, std::size_t> grids_;
  std::map<long long, Frame> frames_;
  std::vector<long long> at_work_;  // axes that refer to each other
};

}  // namespace floe::mesh
