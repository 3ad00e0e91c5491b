#include "group_copies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "copied_events.h"
#include "floe/math/rotation.h"
#include "moved_text.h"
#include "readers.h"
#include "renamed_columns.h"
#include "renamed_sensors.h"

namespace floe::scene {
namespace {

using Named = std::vector<std::pair<YAML::Node, YAML::Node>>;
using Names = std::map<std::string, std::set<std::string>>;  // by section

/// The keys and values of a mapping, as they are now.
Named entries_of(const YAML::Node& map) {
  Named all;
  if (map && map.IsMap())
    for (const auto& entry : map)
      if (entry.first.IsScalar()) all.emplace_back(entry.first, entry.second);
  return all;
}
/// Likewise of one of the scene's mappings.
Named entries_of(const YAML::Node& root, const std::string& section) { return entries_of(root[section]); }

std::vector<std::string> names_of(const Named& entries) {
  std::vector<std::string> names;
  for (const auto& entry : entries) names.push_back(entry.first.Scalar());
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The body of a place, `beam.end` or {body: beam, node: [..]}; empty where it is neither.
std::string body_of(const YAML::Node& place) {
  if (place.IsScalar()) return place.Scalar().substr(0, place.Scalar().find('.'));
  if (place.IsMap() && place["body"] && place["body"].IsScalar()) return place["body"].Scalar();
  return "";
}

/// Names of all that can be copied, as the scene is now.
Names all_names(const YAML::Node& root) {
  Names all;
  for (const char* section : {"bodies", "joints", "loads", "probes", "events"})
    for (const std::string& name : names_of(entries_of(root, section))) all[section].insert(name);
  return all;
}

std::string scalar(const YAML::Node& entry, const char* key) {
  return entry[key] && entry[key].IsScalar() ? entry[key].Scalar() : "";
}

/// Entries closer than round-off to 0, 1 or -1 are these: rotations by right angles are exact.
Eigen::Matrix3d exact(Eigen::Matrix3d R) {
  for (double& entry : R.reshaped())
    if (std::abs(entry - std::round(entry)) < 1e-15) entry = std::round(entry);
  return R;
}

/// One entry of `copies`.
class GroupCopy {
 public:
  /// @param own  names of what the scene gives itself
  GroupCopy(Document& document, const YAML::Node& root, const Entry& entry, const YAML::Node& key, const Names& own)
      : document_(document),
        root_(root),
        name_(entry.name),
        where_(entry.where),
        key_(key),
        own_(own),
        existing_(all_names(root)) {
    if (!readable_in_formulas(name_))
      document.fault(where_, "is not a valid name in formulas", "letters, digits and _, not starting with a digit");
    Reading reading(document, entry.value, "copy");
    if (const auto like = reading.value("like")) bodies_ = read_names(*like, reading.key("like"), {"bodies"});
    if (const auto without = reading.value("without"))
      without_ = read_names(*without, reading.key("without"), {"joints", "loads", "probes", "events"});
    motion_.dimension = document.dimension;
    if (reading.given("position")) motion_.p = Eigen::Vector3d(reading.point("position").data());
    if (document.dimension == 2)
      motion_.rotation[2] = reading.number("angle");
    else if (reading.given("rotation"))
      motion_.rotation = Eigen::Vector3d(reading.point("rotation").data());
    motion_.R = exact(math::rotation(motion_.rotation));
  }

  std::size_t count() const { return bodies_.size(); }

  void write_out() {
    for (const auto& [key, joint] : entries_of(root_, "joints"))
      if (joint.IsMap() && joint["between"] && joint["between"].IsSequence() && touches(joint["between"]))
        write("joints", key, joint);
    sensors_.joints = copied_["joints"];
    for (const auto& [key, probe] : entries_of(root_, "probes"))
      if (probe.IsMap() && acts_on(probe) && !replaces_a_copy("probes", key.Scalar())) {
        write("probes", key, probe);
        sensors_.probes.insert_or_assign(key.Scalar(), probe);
        if (motion_.dimension == 2 && probe["relative_to"] && bodies_.count(body_of(probe["relative_to"])))
          sensors_.seen_from_group.insert(key.Scalar());
      }
    for (const std::string& name : without_) sensors_.probes.erase(name);
    for (const auto& [key, load] : entries_of(root_, "loads"))
      if (load.IsMap() && acts_on(load)) write("loads", key, load);
    Named of_formulas;
    for (const auto& [key, probe] : entries_of(root_, "probes"))
      if (probe.IsMap() && sensors_.named_in(scalar(probe, "formula"))) of_formulas.emplace_back(key, probe);
    for (const auto& [key, probe] : of_formulas) {
      write("probes", key, probe);
      if (!without_.count(key.Scalar())) sensors_.probes.insert_or_assign(key.Scalar(), probe);
    }
    for (const auto& [key, event] : entries_of(root_, "events"))
      if (is_of_group(event, sensors_)) write("events", key, event);
    for (const auto& [key, body] : entries_of(root_, "bodies"))
      if (bodies_.count(key.Scalar())) write("bodies", key, body);
  }

 private:
  std::set<std::string> read_names(const Value& value, const Key& key, const std::vector<std::string>& sections) {
    std::vector<std::string> known;
    for (const std::string& section : sections)
      for (const std::string& name : names_of(entries_of(root_, section))) known.push_back(name);
    std::set<std::string> names;
    for (const std::string& name : read_texts(document_, value, key)) {
      if (!contains(known, name))
        document_.fault(value.where, fmt::format("has \"{}\"", name),
                        fmt::format("names of {}{}", fmt::join(sections, ", "),
                                    known.empty() ? "" : fmt::format(": {}", fmt::join(known, ", "))),
                        name, known);
      names.insert(name);
    }
    return names;
  }

  bool touches(const YAML::Node& places) const {
    return std::any_of(places.begin(), places.end(),
                       [&](const YAML::Node& place) { return bodies_.count(body_of(place)) > 0; });
  }
  /// Whether a load or probe is of a body of the group, or of a joint that is copied.
  bool acts_on(const YAML::Node& entry) const {
    return (entry["at"] && bodies_.count(body_of(entry["at"]))) || bodies_.count(scalar(entry, "body")) ||
           sensors_.joints.count(scalar(entry, "joint"));
  }

  std::string renamed(const std::string& name) const { return name_ + "_" + name; }

  /// Whether the scene gives it in place of a copy of another entry.
  bool replaces_a_copy(const std::string& section, const std::string& name) const {
    const auto own = own_.find(section);
    return own != own_.end() && name.starts_with(renamed("")) && own->second.count(name.substr(renamed("").size()));
  }

  /// The copy of an entry; one that the scene gives itself by that name replaces it, unless it is a body.
  void write(const std::string& section, const YAML::Node& key, const YAML::Node& original) {
    const std::string name = key.Scalar();
    if (section != "bodies" && (without_.count(name) || replaces_a_copy(section, name))) return;
    copied_[section].insert(name);
    if (existing_[section].count(renamed(name))) {
      if (const auto own = own_.find(section);
          section == "bodies" || own == own_.end() || !own->second.count(renamed(name)))
        document_.fault(
            where_,
            fmt::format("copies {} {} to {}, which exists",
                        section == "bodies" ? "body" : section.substr(0, section.size() - 1), name, renamed(name)),
            "another name");
      return;
    }
    document_.copied.emplace(section + "." + renamed(name), section + "." + name);
    const std::size_t before = document_.fault_count();
    const YAML::Node copy = section == "bodies"   ? moved_body(name, original)
                            : section == "events" ? copied_event(document_, name, original, name_, sensors_, motion_)
                                                  : moved_entry(section + "." + name, name, original);
    if (document_.fault_count() == before) root_[section].force_insert(text_at(key, renamed(name)), copy);
  }

  YAML::Node moved_body(const std::string& name, const YAML::Node& body) {
    if (!body.IsMap()) return body;
    std::set<std::string> labels = copied_["joints"];
    labels.insert(copied_["loads"].begin(), copied_["loads"].end());
    YAML::Node moved = empty_map_at(body);
    for (const auto& [key, value] : entries_of(body))
      if (key.Scalar() != "initial")
        moved.force_insert(key, key.Scalar() == "reduction" ? with_renamed_columns(value, labels, renamed("")) : value);
    const YAML::Node initial = body["initial"] ? body["initial"] : YAML::Node();
    moved.force_insert(text_at(key_, "initial"),
                       initial.IsDefined() && !initial.IsNull() && !initial.IsMap() ? initial : start(name, initial));
    return moved;
  }

  /// Position R x + p and rotation R A at the start, and velocities R v, R omega.
  YAML::Node start(const std::string& name, const YAML::Node& initial) {
    const bool given = initial.IsMap();
    YAML::Node moved = empty_map_at(given ? initial : key_);
    for (const char* key : {"velocity", "angular_velocity"})
      if (given && initial[key]) moved.force_insert(key, motion_.moved(initial[key], false));
    for (const char* key : {"deformation", "deformation_rate"})
      if (given && initial[key]) moved.force_insert(key, initial[key]);
    moved.force_insert("position", given && initial["position"] ? motion_.moved(initial["position"], true)
                                                                : numbers_at(key_, motion_.p.head(motion_.dimension)));
    if (motion_.dimension == 2) {
      const std::string angle = given ? scalar(initial, "angle") : "";
      const YAML::Node at = angle.empty() ? key_ : initial["angle"];
      moved.force_insert("angle",
                         text_at(at, fmt::format("({}) + ({})", angle.empty() ? "0" : angle, motion_.rotation[2])));
      return moved;
    }
    const Eigen::Quaterniond before = pose(name).first;
    const Eigen::Vector3d rotation = before.isApprox(Eigen::Quaterniond::Identity(), 0)
                                         ? motion_.rotation
                                         : math::rotation_vector(math::quaternion(motion_.rotation) * before);
    moved.force_insert("rotation", numbers_at(given && initial["rotation"] ? initial["rotation"] : key_, rotation));
    return moved;
  }

  /// Rotation and position of a body's mesh axes at the start.
  std::pair<Eigen::Quaterniond, Eigen::Vector3d> pose(const std::string& name) {
    Eigen::Vector3d rotation(0, 0, 0), position(0, 0, 0);
    const YAML::Node body = root_["bodies"][name];
    if (const YAML::Node initial = body.IsMap() ? body["initial"] : YAML::Node(); initial && initial.IsMap()) {
      const std::string path = fmt::format("bodies.{}.initial", name);
      Reading reading(document_, {initial, document_.place_of(initial.Mark(), path)}, "initial");
      if (reading.given("position")) position = Eigen::Vector3d(reading.point("position").data());
      if (reading.given("rotation")) rotation = Eigen::Vector3d(reading.point("rotation").data());
      if (reading.given("angle")) rotation[2] = reading.number("angle");
    }
    return {math::quaternion(rotation), position};
  }

  YAML::Node moved_entry(const std::string& path, const std::string& name, const YAML::Node& original) {
    YAML::Node copy = empty_map_at(original);
    const std::string axes = scalar(original, "axes");
    for (const auto& [key, value] : entries_of(original)) {
      const std::string& of = key.Scalar();
      const bool is_joint = path.starts_with("joints.");
      if (of == "between" && value.IsSequence()) {
        YAML::Node places = empty_list_at(value);
        for (const auto& place : value) places.push_back(moved_place(place, path + "." + of, name));
        copy.force_insert(key, places);
      } else if (of == "at" || of == "relative_to" || of == "toward") {
        copy.force_insert(key, moved_place(value, path + "." + of, name));
      } else if ((of == "body" || of == "joint") && value.IsScalar()) {
        const bool known = of == "body" ? bodies_.count(value.Scalar()) : sensors_.joints.count(value.Scalar());
        copy.force_insert(key, known ? text_at(value, renamed(value.Scalar())) : value);
      } else if (is_joint && (of == "axis" || of == "second_axis")) {
        copy.force_insert(key, motion_.moved(value, false));
      } else if (is_joint && scalar(original, "type") == "bushing" && of != "type") {
        copy.force_insert(key, rotated_bushing(value, of, path, name));
      } else if (of == "force" || of == "moment" || of == "formula") {
        const YAML::Node formulas = sensors_.renamed(value, name_ + "_", motion_);
        copy.force_insert(key, axes.empty() || axes == "world" ? motion_.moved(formulas, false) : formulas);
      } else if (of == "pressure") {
        copy.force_insert(key, sensors_.renamed(value, name_ + "_", motion_));
      } else {
        copy.force_insert(key, value);
      }
    }
    if (motion_.dimension == 2 && scalar(original, "type") == "prismatic" && !original["axis"])  // its default
      copy.force_insert("axis", numbers_at(key_, motion_.R.col(0).head<2>()));
    return copy;
  }

  YAML::Node moved_place(const YAML::Node& place, const std::string& path, const std::string& owner) {
    const std::string body = body_of(place);
    if (bodies_.count(body)) {
      if (place.IsScalar()) return text_at(place, renamed(place.Scalar()));
      YAML::Node copy = empty_map_at(place);
      for (const auto& [key, value] : entries_of(place))
        copy.force_insert(key, key.Scalar() == "body" ? text_at(value, renamed(body)) : value);
      return copy;
    }
    if (body == "ground" && place.IsScalar()) return place;
    const Where where = document_.place_of(place.Mark(), path);
    if (!body.empty() && body != "ground" && !existing_["bodies"].count(body)) {
      std::vector<std::string> known(existing_["bodies"].begin(), existing_["bodies"].end());
      known.push_back("ground");
      document_.fault(
          where, fmt::format("there is no body \"{}\"", body),
          fmt::format("one of {}", fmt::join(known.begin(), known.begin() + std::min<long>(known.size(), 20), ", ")),
          body, known);
      return place;
    }
    if (place.IsMap() && place["node"] && !body.empty()) return moved_point(place, body);
    document_.fault(where, fmt::format("{}, on a body that {} does not copy", shown(place), "copies." + name_),
                    fmt::format("coordinates of the place, as {{body: {}, node: [..]}}; an entry {} beside {}, which "
                                "replaces its copy; or {} in copies.{}.without",
                                body.empty() ? "BODY" : body, renamed(owner), owner, owner, name_));
    return place;
  }

  /// A point of the ground, or of a body that is not of the group, in the axes of its mesh: H^-1 (R H x + p).
  YAML::Node moved_point(const YAML::Node& place, const std::string& body) {
    YAML::Node copy = empty_map_at(place);
    const auto [H, origin] =
        body == "ground" ? std::pair(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, 0)) : pose(body);
    GroupMotion seen = motion_;
    seen.R = exact(H.conjugate() * motion_.R * H.toRotationMatrix());
    seen.p = H.conjugate() * (motion_.R * origin + motion_.p - origin);
    for (const auto& [key, value] : entries_of(place))
      copy.force_insert(key, key.Scalar() == "node" ? seen.moved(value, true) : value);
    return copy;
  }

  /// Stiffness or viscosity along the world axes: R k R', which must be diagonal.
  YAML::Node rotated_bushing(const YAML::Node& value, const std::string& key, const std::string& path,
                             const std::string& owner) {
    const Where where = document_.place_of(value.Mark(), path + "." + key);
    const Key& described = schema_section("joint").key(key);
    Eigen::Vector3d k;
    const std::size_t before = document_.fault_count();
    const auto parts = read_list(document_, {value, where}, described, 3);
    for (std::size_t i = 0; i < parts.size(); ++i)
      k[static_cast<Eigen::Index>(i)] = read_number(document_, parts[i], described);
    if (document_.fault_count() != before) return value;
    const Eigen::Matrix3d rotated = motion_.R * k.asDiagonal() * motion_.R.transpose();
    const Eigen::Matrix3d rest = rotated - Eigen::Matrix3d(rotated.diagonal().asDiagonal());
    if (rest.cwiseAbs().maxCoeff() <= 1e-12 * k.cwiseAbs().maxCoeff()) return numbers_at(value, rotated.diagonal());
    document_.fault(where, fmt::format("has axes that are not world axes after the rotation of copies.{}", name_),
                    fmt::format("equal values, a rotation by right angles, an entry {} beside {}, which replaces its "
                                "copy, or {} in copies.{}.without",
                                renamed(owner), owner, owner, name_));
    return value;
  }

  Document& document_;
  YAML::Node root_;
  std::string name_;
  Where where_;
  YAML::Node key_;
  std::set<std::string> bodies_, without_;
  GroupMotion motion_;
  const Names& own_;
  Names copied_, existing_;  // names of originals; of all before this copy
  RenamedSensors sensors_;
};

}  // namespace

namespace {

/// Copies of copies may double their number with each, and the time grows with its square.
bool too_many(const YAML::Node& root, std::size_t more) {
  constexpr std::size_t most = 1000;
  return root["bodies"] && root["bodies"].IsMap() && root["bodies"].size() + more > most;
}

}  // namespace

void write_out_groups(Document& document, YAML::Node root) {
  const YAML::Node copies = root["copies"];
  if (!copies.IsDefined()) return;
  const Key& key = schema_section("scene").key("copies");
  const Where where = document.place_of(copies.Mark(), "copies");
  const std::vector<Entry> entries = read_mapping(document, {copies, where}, describe(key));
  const Names own = all_names(root);
  for (const Entry& entry : entries) {
    YAML::Node name;
    for (const auto& candidate : copies)
      if (candidate.first.IsScalar() && candidate.first.Scalar() == entry.name) name.reset(candidate.first);
    const std::size_t before = document.fault_count();
    GroupCopy copy(document, root, entry, name, own);
    if (too_many(root, copy.count())) return document.fault(entry.where, "makes more than 1000 bodies", "fewer copies");
    if (document.fault_count() == before) copy.write_out();
  }
}

}  // namespace floe::scene
