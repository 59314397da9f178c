// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <tl/expected.hpp>
#include <yaml-cpp/yaml.h>

#include "rcl_interfaces/msg/ListParametersResult.h"
#include "rcl_interfaces/msg/Parameter.h"
#include "rcl_interfaces/msg/ParameterDescriptor.h"
#include "rcl_interfaces/msg/ParameterValue.h"

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

/// The settings of a service as parameters of ROS 2: "camera.color" is `color` in section `camera`.
class ParameterTable {
 public:
  /// @param shipped  YAML of every setting with its default, and its meaning in a comment.
  /// @param given  a map of what was set; wins. A value has its default's kind, where it can be read so.
  /// @param live  names of those that may change while the service runs.
  /// @throws YAML::Exception if `shipped` is none.
  ParameterTable(const std::string& shipped, const YAML::Node& given,
                 const std::vector<std::string>& live = {});

  using Names = std::vector<std::string>;

  /// @param prefixes  sections or names, empty: all. @param depth  of parts of a name below the section; 0:
  /// any.
  [[nodiscard]] rcl_interfaces::msg::ListParametersResult list(const Names& prefixes,
                                                               std::uint64_t depth) const;
  // As many as names; of an unknown one kNotSet.
  [[nodiscard]] std::vector<rcl_interfaces::msg::ParameterValue> values(const Names& names) const;
  [[nodiscard]] std::vector<std::uint8_t> kinds(const Names& names) const;
  [[nodiscard]] std::vector<rcl_interfaces::msg::ParameterDescriptor> descriptors(const Names& names) const;

  /// What somebody wants to set, as a YAML map of names and values. @return or why one of them stays what it
  /// is: no setting, read at the start, or a value of another kind (an integer may stand for a double).
  [[nodiscard]] tl::expected<std::string, std::string> changes(
      const std::vector<rcl_interfaces::msg::Parameter>& wanted) const;
  /// A live setting has another value now. @return it, as a parameter's.
  rcl_interfaces::msg::ParameterValue set(const std::string& name, const YAML::Node& value);

 private:
  struct Parameter {
    rcl_interfaces::msg::ParameterValue value;
    std::string description;
    bool is_live = false;
  };

  /// Empty: it may be set.
  [[nodiscard]] std::string why_not(const rcl_interfaces::msg::Parameter& wanted) const;

  std::map<std::string, Parameter> parameters_;
};

}  // namespace rds::service
