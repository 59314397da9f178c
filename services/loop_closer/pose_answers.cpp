// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/pose_answers.hpp"

#include "common/messages/keyframe_conversions.hpp"
#include "common/messages/keyframe_pose_table.hpp"
#include "common/topics/endpoints.hpp"

namespace rds::loop_closer {
namespace {
constexpr int kRepeats = 32;
}  // namespace

PoseAnswers::PoseAnswers(service::ServiceContext& context)
    : instance_(context.instance),
      map_frame_(context.frame("map")),
      poses_(topics::advertise(context.bus, topics::kKeyframePoses, topics::kLoopCloser)) {}

void PoseAnswers::begin(std::uint64_t map_epoch) {
  corrected_ = {};
  corrected_.map_epoch(map_epoch);
}

void PoseAnswers::answer(const Features& features, const LoopAnswer& found) {
  if (features->map_epoch() != corrected_.map_epoch()) corrected_ = {};
  if (!found.poses.empty()) {
    corrected_ = {};
    messages::append_poses(found.poses, corrected_);
    messages::append_loops(found.loops, corrected_);
    corrected_.revision(found.revision);
    corrected_.loop_revision(found.revision);
    corrected_.loops_closed(found.loops_closed);
    repeats_ = kRepeats;
  } else if (repeats_ > 0 && --repeats_ == 0) {
    corrected_.keyframe_ids().clear();
    corrected_.stamps().clear();
    corrected_.poses().clear();
    corrected_.loops().clear();
    corrected_.loop_poses().clear();
  }
  corrected_.map_epoch(features->map_epoch());
  auto message = answer_to(features);
  message.revision(corrected_.revision());
  message.loop_revision(corrected_.loop_revision());
  message.loops_closed(corrected_.loops_closed());
  message.keyframe_ids(corrected_.keyframe_ids());
  message.stamps(corrected_.stamps());
  message.poses(corrected_.poses());
  message.loops(corrected_.loops());
  message.loop_poses(corrected_.loop_poses());
  poses_.write(message);
}

rds_msgs::msg::KeyFramePoses PoseAnswers::answer_to(const Features& features) const {
  rds_msgs::msg::KeyFramePoses message;
  message.header(features->header());
  message.header().frame_id(map_frame_);
  message.instance(instance_);
  message.loop_instance(instance_);
  message.map_epoch(features->map_epoch());
  message.source(messages::kPosesOfLoopCloser);
  message.answered_keyframe_id(features->keyframe_id());
  return message;
}

}  // namespace rds::loop_closer
