// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/service/service.hpp"
#include "rds_msgs/msg/KeyFrameFeatures.h"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "services/loop_closer/core/loop_types.hpp"

namespace rds::loop_closer {

/// Answers every keyframe on rds/keyframe/poses: in lockstep the tracker waits for that. A correction is
/// repeated in the answers to the next keyframes, in case one is missed; then answers carry its revision
/// alone.
class PoseAnswers {
 public:
  using Features = std::shared_ptr<const rds_msgs::msg::KeyFrameFeatures>;

  explicit PoseAnswers(service::ServiceContext& context);

  /// Of the last answer.
  [[nodiscard]] std::uint64_t map_epoch() const { return corrected_.map_epoch(); }
  /// Forgets the correction. @param map_epoch  of the next answer; 0: not known yet.
  void begin(std::uint64_t map_epoch = 0);

  /// @param found  a new correction, if it carries poses.
  void answer(const Features& features, const LoopAnswer& found);
  /// An answer without poses and revisions, to a keyframe that waits.
  void acknowledge(const Features& features) { poses_.write(answer_to(features)); }

 private:
  [[nodiscard]] rds_msgs::msg::KeyFramePoses answer_to(const Features& features) const;

  std::uint64_t instance_;
  std::string map_frame_;
  rds_msgs::msg::KeyFramePoses corrected_;  // of the last loop
  int repeats_ = 0;                         // answers that still carry its poses
  bus::Publisher<rds_msgs::msg::KeyFramePoses> poses_;
};

}  // namespace rds::loop_closer
