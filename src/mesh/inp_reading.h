#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <set>

#include "file_mesh.h"
#include "floe/mesh/deck.h"
#include "inp_blocks.h"

namespace floe::mesh {

/// A set of nodes or elements while the deck is read.
struct InpSet {
  struct Range {
    long long first, last, step;
    bool holds(long long label) const { return label >= first && label <= last && (label - first) % step == 0; }
  };
  std::string name;
  Where where;
  std::vector<long long> labels;     // that this rank found
  std::vector<Range> ranges;         // of GENERATE; same on all ranks
  std::vector<std::string> members;  // other sets, by name; same on all ranks after agree_members
};

/// Sets in the order of their first mention, which is the same on all ranks.
struct InpSets {
  std::vector<InpSet> sets;
  int named(const std::string& name, Where where);  // its number; made where it does not exist
  int find(const std::string& name) const;          // -1: none
  std::vector<int> with_members(int set) const;     // itself and all that it holds
  std::vector<std::string> names() const;
};

/// What has a name.
enum class InpName { nodes, elements, surface, orientation };

/// Names of a *PART are others than those of the *ASSEMBLY, where they are INSTANCE.NAME (Abaqus). Those that both have
/// are kept as INSTANCE.NAME; all others may be named from both without the instance.
struct InpScopes {
  std::string instance = {};                             // "" where there is none
  std::set<std::pair<InpName, std::string>> twice = {};  // in upper case
  bool in_part = false;                                  // at the block at work
  void find(const std::vector<InpBlock>& blocks);
  bool enter(const std::string& keyword);                        // in_part from this keyword on
  std::string own(const std::string& name, InpName kind) const;  // under which it is kept
  std::string whole(const std::string& name) const;  // of a node set or surface, for own() outside of the part, too
};

struct InpElement {
  long long label;
  int nodes;  // 1: a mass; 0: one of another kind, which is left out
  int set;    // of *ELEMENT, ELSET=; -1: none
  int use;    // number in InpReading::uses; -1: none yet
  std::array<long long, most_nodes> node_labels;
  Where where;
  int other_use = -1;  // one that does not fit its kind
  bool again = false;  // has two uses that fit, of which the later holds
  CellKind kind = CellKind::point;
  bool axial = false;  // SPRINGA
};

/// An element set that a section, *MASS, *SPRING or the scene names.
struct InpUse {
  enum Kind { shell, beam, mass, spring, scene } kind;
  std::string set;
  Where where;
  double amount;                        // a mass, or a stiffness
  std::array<int, 2> directions{0, 0};  // of SPRING2
};

/// An element of *SPRING: SPRINGA acts along the line of its nodes, SPRING2 between a direction of each.
struct InpSpring {
  long long label;
  std::array<long long, 2> nodes;
  int use;
  bool axial;  // SPRINGA
  Where where;
};

struct InpLink {
  enum Kind { rigid, mean, equal } kind = rigid;  // equal: of nodes at one point
  Where where;
  std::string reference;   // a node, or a set of one
  std::string nodes;       // a node, a set or a surface
  RigidLink free = {};     // the rotations that it leaves free
  bool set_first = false;  // where a node set and a surface have the name
};

/// *TRANSFORM: directions of nodes. R: a along x, b in the plane of x and y; C: a and b on the axis.
struct InpTransform {
  Where where;
  std::string nodes;
  char type;
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = Eigen::Vector3d::Zero();
};

/// *EQUATION: a sum of components that is zero.
struct InpEquation {
  struct Term {
    std::string node;
    int direction;
    double factor;
  };
  Where where;
  std::vector<Term> terms;
  bool turned = false;  // of a part whose *INSTANCE is rotated
};

/// *TIE: nodes of the first surface move with those of the second at the same points.
struct InpTie {
  Where where;
  std::string dependent, independent;
  bool free = false;  // of all rotations: NO ROTATION
};

/// *SURFACE of elements, or the elements of *RIGID BODY: their nodes become a node set.
struct InpSurface {
  struct Item {
    Where where;
    std::string elements;  // a set or an element
    std::string face;      // "": all nodes
  };
  std::string name;
  Where where;
  std::vector<Item> items;  // same on all ranks
  int set = -1;             // of its nodes; -1: it has none
};

/// Elements by sets, members included, and by number.
struct InpElementList {
  std::vector<int> sets;          // same on all ranks
  std::vector<long long> labels;  // that this rank found
  std::string name;               // for messages
  Where where;
};

/// An element of this rank's share that a list holds.
struct InpMember {
  PetscInt element;
  int list;
};

/// *NODAL THICKNESS of a node, or of a node set.
struct InpThickness {
  Where where;
  std::string nodes;
  double value;
};

/// *ORIENTATION, SYSTEM=CYLINDRICAL: x' is radial, z' along the axis from a to b.
struct InpCylinder {
  std::string name;
  Where where;
  Eigen::Vector3d a, b;
  int normal;    // 1, 2, 3: the local axis about the shell's normal
  double angle;  // about it, degrees
};

/// A keyword that is left out.
struct InpIgnored {
  Where where;  // its first
  std::string name, why;
  long long times, lines;
};

/// All that is known of a deck while it is read. What is not of this rank's share is the same on all ranks.
struct InpReading {
  Faults& faults;
  const DeckRequest& request;
  int rank, ranks;
  FileMesh mesh;                     // its nodes
  std::vector<InpElement> elements;  // of this rank's share
  InpSets node_sets, element_sets;
  std::vector<InpUse> uses;
  std::vector<InpLink> links;
  std::vector<InpSurface> surfaces;
  std::vector<InpTie> ties;
  std::vector<InpTransform> transforms;
  std::vector<InpEquation> equations;
  std::vector<InpThickness> thicknesses;
  std::vector<InpCylinder> cylinders;
  Deck deck;
  std::vector<InpIgnored> ignored;  // become notices before these
  std::vector<std::string> notices;
  std::string instance;  // of Abaqus; "" where there is none, or not yet
  InpScopes scopes;
  std::optional<Eigen::Isometry3d> motion;  // of the instance at work
  std::optional<InpLink> coupling;          // that waits for its *KINEMATIC or *DISTRIBUTING
  std::vector<std::pair<std::string, Where>> materials_used, orientations_used;
  std::vector<InpSpring> springs;  // of this rank's share
  std::vector<int> nodal;          // parts of sections with NODAL THICKNESS
  int last_shell = -1;             // section of shells that was read last, if no section of beams came after it
};

/// Leaves out the parts and instances of an assembly but the one asked for (none: the only one), and of the sets,
/// surfaces and joints of the assembly what names the others: fields of sets, lines of others, which a notice counts.
/// Nodes of the assembly itself (reference points) get 1000000000 more than their number there, so that they are others
/// than those of the part. Elements of the assembly of types in request.ignore are left out. Rank-local.
/// @throws InputError  there are several instances and none is asked for, or not this one; its part is not defined
void choose_instance(InpBlocks& deck, const DeckRequest& request, Faults& faults, std::vector<std::string>& notices);

/// The records of this rank among all nodes, or all elements, of the deck.
struct InpShares {
  long long nodes_before = 0, elements_before = 0;  // of the blocks so far
  Share nodes{0, 0}, elements{0, 0};
};

// One function a keyword; each adds what is wrong to reading.faults and goes on. Rank-local.
InpShares shares_of(const std::vector<InpBlock>& blocks, int rank, int ranks, Faults& faults);
void read_inp_nodes(const InpBlock& block, InpShares& shares, InpReading& reading);
void read_inp_elements(const InpBlock& block, InpShares& shares, InpReading& reading);
void read_set(const InpBlock& block, InpReading& reading);
void read_surface(const InpBlock& block, InpReading& reading);
void read_element_surface(const InpBlock& block, InpReading& reading);
void read_material(const InpBlock& block, InpReading& reading);
void read_elastic(const InpBlock& block, InpReading& reading);
void read_density(const InpBlock& block, InpReading& reading);
void read_orientation(const InpBlock& block, InpReading& reading);
void read_shell_section(const InpBlock& block, InpReading& reading);
void read_shell_general_section(const InpBlock& block, InpReading& reading);
void read_transverse_shear(const InpBlock& block, InpReading& reading);
void read_spring(const InpBlock& block, InpReading& reading);
void read_beam_section(const InpBlock& block, InpReading& reading);
void read_beam_general_section(const InpBlock& block, InpReading& reading);
void read_mass(const InpBlock& block, InpReading& reading);
void read_nodal_thickness(const InpBlock& block, InpReading& reading);
void read_instance(const InpBlock& block, InpReading& reading);
void read_end_instance(const InpBlock& block, InpReading& reading);
void read_rigid_body(const InpBlock& block, InpReading& reading);
void read_mpc(const InpBlock& block, InpReading& reading);
void read_coupling(const InpBlock& block, InpReading& reading);
void read_kinematic(const InpBlock& block, InpReading& reading);
void read_distributing(const InpBlock& block, InpReading& reading);
void read_tie(const InpBlock& block, InpReading& reading);
void read_transform(const InpBlock& block, InpReading& reading);
void read_equation(const InpBlock& block, InpReading& reading);
void read_blocks(const std::vector<InpBlock>& blocks, InpReading& reading);

/// Gives all ranks the sets that the sets contain by name; names that are no sets become faults. Collective.
void agree_members(MPI_Comm comm, InpReading& reading);

/// Elements of this rank's share that each list holds; elements that are not defined become faults. Collective.
std::vector<InpMember> members_of(MPI_Comm comm, const std::vector<InpElementList>& lists, InpReading& reading);

/// The nodes of surfaces become node sets. Collective.
void resolve_surfaces(MPI_Comm comm, InpReading& reading);

/// Gives each element of the share the section or mass of its set, and converts elements into cells; the nodes of
/// reading.deck.masses are numbers of mentions. Collective.
void assign_sections(MPI_Comm comm, InpReading& reading);

/// The node sets become places. Rank-local.
void add_places(InpReading& reading);

/// Springs by node numbers; the nodes of reading.deck.springs are numbers of mentions. Collective.
void resolve_springs(MPI_Comm comm, InpReading& reading);

/// Links by node numbers; the nodes of reading.deck.links are numbers of mentions. Collective.
void resolve_links(MPI_Comm comm, InpReading& reading);

/// Equations between nodes at one point as links; the others are reported or faults. Collective.
void resolve_equations(MPI_Comm comm, InpReading& reading);

/// Adds a link of the labels that this rank found. @param free  the rotations that it leaves free
void add_link(long long reference, const std::vector<long long>& labels, Where where, InpReading& reading,
              const RigidLink& free = {});

/// Diagonal of the box around all nodes. Collective.
double extent_of(MPI_Comm comm, const FileMesh& mesh);

/// Parts for shells whose nodes have a thickness of their own. Collective.
void assign_thicknesses(MPI_Comm comm, InpReading& reading);

/// Angles of plies with orientations of different names, about the normal. Collective.
void assign_ply_angles(MPI_Comm comm, InpReading& reading);

/// Parts for shells whose orientation is cylindrical, by its direction at their centres. Collective.
void assign_cylinders(MPI_Comm comm, InpReading& reading);

/// Positions of nodes by their labels, in the order of the labels that are defined. Collective.
std::vector<std::pair<long long, Eigen::Vector3d>> positions_of(MPI_Comm comm, const std::vector<long long>& labels,
                                                                const InpReading& reading);

/// Keeps a keyword for the notices: what it is instead, or why it does not matter; "" where that is plain.
void ignore(const InpBlock& block, const std::string& why, InpReading& reading);

/// The notices of what was ignored, one line a keyword.
void report_ignored(InpReading& reading);

/// A parameter's value; where it is missing a fault and "".
std::string required(const InpBlock& block, const std::string& key, InpReading& reading);

/// The numbers of one data line; a fault and nothing where it has others than least..most of them. Empty fields are 0.
std::optional<std::vector<double>> numbers(std::string_view line, Where where, std::size_t least, std::size_t most,
                                           const std::string& what, Faults& faults);

/// The data lines, each with its place; a fault where there are fewer than least or more than most.
std::vector<std::pair<Where, std::string_view>> data_lines(const InpBlock& block, std::size_t least, std::size_t most,
                                                           const std::string& what, Faults& faults);

}  // namespace floe::mesh
