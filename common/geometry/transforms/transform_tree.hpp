// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/pose.hpp"

namespace rds::geometry {

/// The transforms that others publish: of each frame its parent and, of the last seconds, where it was in it.
///
/// A transform that is not static and has not been repeated for kForgottenNs of its own stamps is forgotten:
/// who published it has gone.
class TransformTree {
 public:
  static constexpr std::int64_t kKeptNs = 2'000'000'000;
  static constexpr std::int64_t kForgottenNs = 5'000'000'000;
  static constexpr std::int64_t kSteadyNs = 100'000'000;  // between transforms of something that moves
  static constexpr std::size_t kMaxFrames = 1000;  // more are not taken in
  static constexpr std::size_t kDeepest = 64;

  void set(const std::string& parent, const std::string& child, std::int64_t stamp_ns,
           const Pose& parent_from_child);
  void set_static(const std::string& parent, const std::string& child, const Pose& parent_from_child);

  /// The frame, its parent, and so on up to the root. Where others publish a circle it ends after kDeepest.
  [[nodiscard]] std::vector<std::string> ancestry(const std::string& frame, std::int64_t stamp_ns) const;
  /// The last of the ancestry; the frame itself if it has no parent.
  [[nodiscard]] std::string root_of(const std::string& frame, std::int64_t stamp_ns) const {
    return ancestry(frame, stamp_ns).back();
  }
  /// Where `source` is in `target` at that time: interpolated; beyond the newest transform as it was last,
  /// or where they come at least every kSteadyNs, as it has moved last, for at most as long as between two.
  /// @return target_from_source; nullopt if no path joins them.
  [[nodiscard]] std::optional<Pose> lookup(const std::string& target, const std::string& source,
                                           std::int64_t stamp_ns) const;

 private:
  struct Edge {
    std::string parent;
    bool is_static = false;
    std::deque<std::pair<std::int64_t, Pose>> poses;  // parent_from_child, by stamp
  };
  [[nodiscard]] const Edge* edge_of(const std::string& frame, std::int64_t stamp_ns) const;
  Edge* edge_for(const std::string& parent, const std::string& child);
  /// Where the first of them is in the last.
  [[nodiscard]] Pose root_from(const std::vector<std::string>& ancestry, std::int64_t stamp_ns) const;

  std::map<std::string, Edge> by_child_;
};

}  // namespace rds::geometry
