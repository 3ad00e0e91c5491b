#pragma once
#include "corner_thickness.h"
#include "file_mesh.h"
#include "nas_reading.h"

namespace floe::mesh {

/// Turns the model into the mesh and the deck: parts and sections are the same on all ranks, of the rest a rank keeps
/// its share. Rank-local.
class NasBuild {
 public:
  NasBuild(const NasModel& model, const DeckRequest& request, Faults& faults, int rank, int ranks)
      : model_(model), request_(request), faults_(faults), rank_(rank), ranks_(ranks), frames_(model, faults) {}

  FileMesh mesh;
  Deck deck;
  std::vector<std::string> notices;

  void build();

 private:
  /// What makes elements of one property different parts.
  using Variant = std::array<double, 7>;

  /// A node at the end of a beam with an offset.
  struct Extra {
    long long label;
    Eigen::Vector3d x;
    Where where;
  };

  void add_grids();
  /// Rigid links by independent grid: all ranks mention it, the first rank its dependent ones.
  void link(long long reference, const std::vector<long long>& nodes, Where where);
  void add_links();
  struct Rotations;
  std::unordered_map<long long, Rotations> rotations_of_grids() const;
  void free_rotations();
  void find_rods_alone();
  RigidLink freedom(const NasLink& link, long long grid);
  void add_shells();
  void add_beams();
  void add_extra_grids();
  void refuse_distant(const NasMean& mean);
  void add_means();
  /// Labels of the grids that elements, springs, masses and links use, ascending.
  std::vector<long long> used_grids() const;
  void add_springs();
  void report_grounded();
  std::optional<NodeSpring> scalar_spring(const NasSpring& spring, const std::array<Eigen::Vector3d, 2>& x);
  std::optional<NodeSpring> bush(const NasSpring& spring, const std::array<Eigen::Vector3d, 2>& x);
  /// Diagonal of the box around all grids.
  double extent();
  std::vector<NasMassMatrix> mass_matrices();
  std::vector<NasMass> all_masses();
  void add_masses();
  std::optional<NasMass> in_basic_axes(NasMass given);
  void complete_inertia(Eigen::Matrix3d& inertia, const NasMass& of);
  void add_places();
  /// Labels of the grids of supports, each with its card, by the name of their place.
  std::map<std::string, std::vector<std::pair<long long, Where>>> supports() const;
  void report_unused();

  bool mine(std::size_t element) const;
  /// The part of elements of a property that agree in `variant`; `make` adds its section.
  template <class Make>
  int part_of(long long property, const Variant& variant, const std::string& name, Make&& make);
  /// Whether the scene gives sections to elements whose property the deck does not have.
  bool scene_has_sections() const { return request_.section || !request_.parts.empty(); }
  /// Whether the scene gives this part its section, whatever the deck says.
  bool replaced(const std::string& part) const;
  /// The part of an element without property; -1: it cannot have the scene's section.
  /// @param plain  it has no thickness, offset of its surface or free end of its own, and is no rod
  int part_without_thickness(const NasShell& shell, const NasShellProperty& property);
  int part_of_scene(CellKind kind, long long property, long long element, bool plain, Where where);
  template <class Map>
  const typename Map::mapped_type* property(const Map& all, long long id, Where where, const std::string& element);
  const NasMaterial* material(long long id, Where where, const std::string& user);
  std::string named_material(const NasMaterial& of, double extra_density, const std::string& property);
  bool has_axes(const NasShellProperty& property) const;
  Eigen::Vector3d axis_of(const NasShell& shell);
  const NasMaterial* shell_material(long long id, const NasShellProperty& property);
  static CornerThickness thickness_of(const NasShell& shell, const NasShellProperty& property);
  void add_shell_section(const NasShell& shell, const NasShellProperty& property, const CornerThickness& own,
                         const Eigen::Vector3d& axis, int part);
  long long end_of(const NasBeam& beam, const NasGrid& grid, const Eigen::Vector3d& offset, const Eigen::Vector3d& x);
  /// The grids of a beam and where they are.
  struct Ends {
    std::array<const NasGrid*, 2> grids;
    std::array<Eigen::Vector3d, 2> x;
  };
  Eigen::Vector3d offset_of(const NasBeam& beam, int end, const Ends& ends);
  std::optional<Ends> ends_of(const NasBeam& beam);
  Eigen::Vector3d orientation_of(const NasBeam& beam, const Ends& ends, const Eigen::Vector3d& axis);
  void add_beam_section(const NasBeamProperty& own, const NasBeam& beam, const Eigen::Vector3d& orientation, int part);

  void add_pieces(const NasBeamProperty& own, NasBeam beam, const std::array<long long, 4>& ends,
                  const std::array<Eigen::Vector3d, 2>& x, const Eigen::Vector3d& v, bool mine);

  const NasModel& model_;
  const DeckRequest& request_;
  Faults& faults_;
  int rank_, ranks_;
  NasFrames frames_;
  Share share_{0, 0};
  long long next_label_ = 1, next_element_ = 1;
  double extent_ = -1;
  std::map<std::pair<long long, Variant>, int> parts_;    // of beams by the negative number of the property
  std::vector<FilePlace> mean_places_;                    // the grids of each RBE3
  std::map<std::size_t, unsigned> alone_;                 // of rods, as NasBeam::alone
  std::unordered_map<long long, long long> independent_;  // of dependent grids
  std::vector<Extra> extra_, between_;                    // at the ends of beams with offsets; inside beams with taper
  std::map<std::array<double, 4>, long long> extra_of_;
  std::map<long long, std::vector<std::size_t>> extra_links_;
  std::map<long long, RigidLink> free_;       // rotations of dependent grids that are their own
  std::map<std::size_t, unsigned> released_;  // of beams at links that leave rotations free, as NasBeam::releases
  std::vector<long long> used_materials_, used_properties_;
  long long varying_shells_ = 0;                       // whose thickness varies between their corners
  long long without_thickness_ = 0;                    // shells that have the scene's section for want of one
  std::map<std::string, long long> without_property_;  // elements of parts that have the scene's section
};

}  // namespace floe::mesh
