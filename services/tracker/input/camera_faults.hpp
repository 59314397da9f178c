// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace rds::tracker {

/// What is seen of one of the camera's topics.
struct StreamSight {
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  std::string topic;
  int publishers = 0;           // of the type that is read, in any packing that is read
  std::string other_type = {};  // that somebody publishes the topic as instead
  double silent_s = kNever;     // since the last message that could be used
  double refused_s = kNever;    // since the last one that could not, and …
  std::string refusal = {};     // … why, with what to do about it
};

struct CameraSight {
  StreamSight color;
  StreamSight info;
  StreamSight depth;
  double since_frame_s = StreamSight::kNever;  // since a colour and a depth picture made a frame
  std::optional<double> partner_ms =
      {};  // between the stamps of a colour picture and the depth nearest to it
  std::vector<std::string> other_pictures = {};  // topics of pictures that are not read
  std::vector<std::string> other_infos = {};     // topics of camera_info that are not read
};

/// What is wrong with the camera, each in one sentence that names topic, cause and remedy; by a fixed name. A
/// camera of which nothing at all is there is not wrong: it is waited for.
std::map<std::string, std::string> camera_faults(const CameraSight& sight);

/// The names that camera_faults() uses.
inline const std::vector<std::string> kCameraFaults{"camera colour", "camera info", "camera depth",
                                                    "camera pairing"};

/// Tells of faults that last: what is missing for a moment, while processes start or frames wait, is no
/// fault.
class FaultFilter {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::milliseconds kLast{500};

  /// @return those that have been there since kLast.
  std::map<std::string, std::string> lasting(const std::map<std::string, std::string>& faults, Time now);

 private:
  std::map<std::string, Time> since_;
};

}  // namespace rds::tracker
