// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "rcl_interfaces/msg/ListParametersResult.h"
#include "rcl_interfaces/msg/ParameterDescriptor.h"
#include "rcl_interfaces/msg/ParameterValue.h"
#include "rcl_interfaces/msg/SetParametersResult.h"

namespace rds::service {

/// What a parameter's value is: rcl_interfaces/msg/ParameterType.
enum class ParameterKind : std::uint8_t {
  kNotSet,
  kBool,
  kInteger,
  kDouble,
  kString,
  kByteArray,
  kBoolArray,
  kIntegerArray,
  kDoubleArray,
  kStringArray,
};

/// The settings of a service as parameters of ROS 2: "camera.color" is `color` in section `camera`. Constant,
/// as settings are, so any thread may ask.
class ParameterTable {
 public:
  /// @param shipped  YAML of every setting with its default, and its meaning in a comment.
  /// @param given  a map of what was set; wins. A value has its default's kind, where it can be read so.
  /// @throws YAML::Exception if `shipped` is none.
  ParameterTable(const std::string& shipped, const YAML::Node& given);

  using Names = std::vector<std::string>;

  /// @param prefixes  sections or names, empty: all. @param depth  of parts of a name below the section; 0:
  /// any.
  [[nodiscard]] rcl_interfaces::msg::ListParametersResult list(const Names& prefixes,
                                                               std::uint64_t depth) const;
  // As many as names; of an unknown one kNotSet.
  [[nodiscard]] std::vector<rcl_interfaces::msg::ParameterValue> values(const Names& names) const;
  [[nodiscard]] std::vector<std::uint8_t> kinds(const Names& names) const;
  [[nodiscard]] std::vector<rcl_interfaces::msg::ParameterDescriptor> descriptors(const Names& names) const;

  /// Why a parameter stays what it is: settings are read at the start.
  [[nodiscard]] rcl_interfaces::msg::SetParametersResult refuse(const std::string& name) const;

 private:
  struct Parameter {
    rcl_interfaces::msg::ParameterValue value;
    std::string description;
  };
  std::map<std::string, Parameter> parameters_;
};

}  // namespace rds::service
