#pragma once
#include <yaml-cpp/yaml.h>

#include <map>
#include <string>
#include <vector>

#include "floe/error.h"
#include "floe/scene/scene.h"

namespace floe::scene {

/// A value of the file and where it stands.
struct Value {
  YAML::Node node;
  Where where;
};

/// The file while it is read: its parameters so far and the faults found in it.
///
/// Reading goes on after a fault, with some value in place of the wrong one, so that all faults are reported at once;
/// what would only follow from an earlier fault is not checked (compare fault_count()).
class Document {
 public:
  std::string file;
  math::Names names;                ///< that formulas may use: parameters and functions so far
  int dimension = 2;                ///< of the scene: how many coordinates a point has
  std::vector<std::string> tables;  ///< files of tables so far
  /// Of entries that `copies` made, as bodies.right_arm: the entry that they were made from.
  std::map<std::string, std::string> copied;

  /// A reduced body's file, read once. @throws InputError
  std::shared_ptr<const output::ReducedBodyFile> reduced_file(const std::string& path);
  /// A path of the scene, from its folder.
  std::string beside(const std::string& path) const;

  /// Notes `FILE:LINE:COLUMN: KEY: wrong; expected EXPECTED; did you mean "NEAREST"?`, the last two where there are
  /// any.
  void fault(const Where& where, const std::string& wrong, const std::string& expected = {},
             const std::string& word = {}, const std::vector<std::string>& known = {});
  /// Notes what was thrown about the value at `where` (its text names the place already).
  void fault(const Where& where, const InputError& error);
  std::size_t fault_count() const { return faults_.size(); }
  /// @throws InputError with all faults in the order of the file, if there are any
  void throw_faults() const;

  Where place_of(const YAML::Mark& mark, const std::string& key) const;

 private:
  struct Fault {
    int line, column;
    std::string text;
    std::string said;   ///< the same of copies of one entry
    std::string entry;  ///< bodies.blade of bodies.blade.section.A
  };
  std::vector<Fault> faults_;
  std::map<std::string, std::shared_ptr<const output::ReducedBodyFile>> reduced_files_;
};

/// The file's text. @throws InputError when it is missing, a folder, unreadable, too large (16 MiB) or not text
std::string read_text(const std::string& path);
/// The one YAML document in the text. @throws InputError with the line of the first error
Value parse_yaml(const std::string& text, const std::string& file);

}  // namespace floe::scene
