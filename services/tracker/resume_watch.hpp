// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace rds::tracker {

/// Decides when a tracker that goes on in the map of an earlier process gives that map up: after so much time
/// in usable pictures in which it did not find itself.
class ResumeWatch {
 public:
  /// @param patience_s  0: never.
  explicit ResumeWatch(double patience_s) : patience_s_(patience_s) {}

  /// The camera looks for itself from now on.
  void begin() {
    end();
    is_looking_ = true;
  }
  void end() {
    is_looking_ = false;
    searched_s_ = 0;
    last_ns_.reset();
  }
  [[nodiscard]] bool is_looking() const { return is_looking_; }
  [[nodiscard]] double patience_s() const { return patience_s_; }

  /// The next frame. @param is_usable  shows enough to be found by. @return true if the map is to be given
  /// up.
  bool take(std::int64_t stamp_ns, bool has_pose, bool is_usable) {
    if (has_pose) end();
    if (!is_looking_) return false;
    if (is_usable && last_ns_)
      searched_s_ += std::clamp(static_cast<double>(stamp_ns - *last_ns_) * 1e-9, 0.0, kLongest_s);
    last_ns_ = stamp_ns;
    return patience_s_ > 0 && searched_s_ > patience_s_;
  }

 private:
  static constexpr double kLongest_s = 0.5;  // between two frames; what is beyond nobody has searched
  double patience_s_;
  bool is_looking_ = false;
  double searched_s_ = 0;
  std::optional<std::int64_t> last_ns_;
};

}  // namespace rds::tracker
