// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace rds::record {

/// Which topics a recording is to have.
class TopicChoice {
 public:
  /// The camera's, odometry and IMU, and tf_static.
  static TopicChoice camera();
  /// What the services say to others: not what they only tell each other.
  static TopicChoice outputs();
  /// Both.
  static TopicChoice camera_and_outputs();
  static TopicChoice all();
  /// @param topics  names; without a leading slash they are below the namespace, if there is one.
  static TopicChoice named(const std::vector<std::string>& topics);

  /// The same topics by their full names. @param full_name  bus::Participant::full_name()
  [[nodiscard]] TopicChoice by_full_names(
      const std::function<std::string(const std::string&)>& full_name) const;

  /// @param topic  without a leading slash.
  [[nodiscard]] bool contains(const std::string& topic) const;

 private:
  bool all_ = false;
  std::set<std::string> topics_;
};

}  // namespace rds::record
