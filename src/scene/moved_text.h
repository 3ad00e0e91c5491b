#pragma once
#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace floe::scene {

/// The motion of a copied group, x -> R x + p, applied to what the scene writes: numbers and formulas stay texts.
struct GroupMotion {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< its rotation vector
  int dimension = 2;

  /// R f (+ p) of a list of as many texts as dimensions; any other node is returned as it is.
  YAML::Node moved(const YAML::Node& list, bool with_position) const;
  /// Component i of R' (x - p) where `x` are texts (without p where `with_position` is false): what a sensor of the
  /// original measured, from those of the copy.
  std::string moved_back(int i, const std::vector<std::string>& x, bool with_position) const;
};

/// Nodes with the line and column of `at`, for messages.
YAML::Node text_at(const YAML::Node& at, const std::string& text);
YAML::Node empty_list_at(const YAML::Node& at);
YAML::Node empty_map_at(const YAML::Node& at);
/// A list of numbers.
YAML::Node numbers_at(const YAML::Node& at, const Eigen::VectorXd& numbers);

}  // namespace floe::scene
