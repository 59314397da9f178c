// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace rds::tracker {

/// Whether a frame has to wait for one of a robot's sensors: until it has told of the frame's time and tf says
/// where it stands. Who has waited in vain does not wait again before something is new.
class SensorWait {
 public:
  void take(std::int64_t newest_ns) { newest_ns_ = newest_ns; }

  /// @param is_joined  whether tf joins the sensor's frame with the camera's.
  [[nodiscard]] bool is_due(std::int64_t frame_ns, const std::function<bool()>& is_joined) const {
    if (reaches(frame_ns)) return waits_for_tf_ && !is_joined();
    return !in_vain_ || newest_ns_ != newest_in_vain_ns_;
  }
  /// Nothing has come for as long as a frame waits.
  void give_up(std::int64_t frame_ns) {
    if (reaches(frame_ns)) {
      waits_for_tf_ = false;
    } else {
      in_vain_ = true;
      newest_in_vain_ns_ = newest_ns_;
    }
  }

 private:
  [[nodiscard]] bool reaches(std::int64_t frame_ns) const { return newest_ns_ && *newest_ns_ >= frame_ns; }

  std::optional<std::int64_t> newest_ns_;
  bool waits_for_tf_ = true;
  bool in_vain_ = false;
  std::optional<std::int64_t> newest_in_vain_ns_;  // what was there then
};

}  // namespace rds::tracker
