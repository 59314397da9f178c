// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include <tl/expected.hpp>

#include "common/concurrency/helper_thread.hpp"
#include "common/map_commands/map_commands.hpp"
#include "common/service/peers.hpp"
#include "common/service/service.hpp"
#include "common/time/stamp_watch.hpp"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "services/tracker/core/prediction/movable_objects.hpp"
#include "services/tracker/core/tracker.hpp"
#include "services/tracker/delayed_values.hpp"
#include "services/tracker/frame_input.hpp"
#include "services/tracker/lasting_tracker.hpp"
#include "services/tracker/mapping_worker.hpp"
#include "services/tracker/resume_watch.hpp"
#include "services/tracker/tracker_outputs.hpp"
#include "services/tracker/tracker_service_config.hpp"
#include "vision_msgs/msg/Detection3DArray.h"

namespace rds::tracker {

/// The tracking process: owns the map on its worker thread, runs local mapping on a second one.
class TrackerService : public service::Service {
 public:
  TrackerService(service::ServiceContext& context, const TrackerServiceConfig& config);
  void run(const std::stop_token& stop) override;
  /// Hands over what is to last.
  void close() override { save_checkpoint(); }

 protected:
  bool begin(const service::PendingCommand& command) override;
  service::CommandOutcome execute(const std::string& verb, const std::string& argument) override;
  void idle() override;

 private:
  using BoxesMessage = std::shared_ptr<const vision_msgs::msg::Detection3DArray>;
  using PosesMessage = std::shared_ptr<const rds_msgs::msg::KeyFramePoses>;

  /// What late boxes of a keyframe need.
  struct KeyframeAwaitingBoxes {
    std::uint64_t id;
    geometry::Pose
        camera_from_map;  // when the keyframe was made: with this pose its boxes were lifted into the map
    geometry::CameraModel camera;
  };

  void take(const image::RgbdFrame& frame);
  void drop(const image::RgbdFrame& frame);
  void acknowledge(const image::RgbdFrame& frame);
  void begin_after_break();
  void process(const image::RgbdFrame& frame);
  void sort_in_arrivals();
  void await_answers();
  void apply_answers();
  void apply(const BoxesMessage& boxes);
  void apply(const PosesMessage& poses);
  void apply(const LocalMappingResult& result);
  void ask_for_answers(const KeyframeData& keyframe, const geometry::CameraModel& camera);
  void start_mapping();
  void publish_poses();
  void reset();
  void start_map();
  void go_on_from_checkpoint();
  void save_checkpoint();
  void give_up_where_lost(const image::RgbdFrame& frame, const FrameResult& result);
  [[nodiscard]] map_file::MapPart map_part() const;
  void load(const service::PendingCommand& command);
  service::CommandOutcome finish();

  TrackerServiceConfig config_;
  std::stop_token stop_;
  std::uint64_t map_epoch_;
  service::FollowedWriter loop_closer_;
  concurrency::HelperThread helper_;  // of the worker
  Tracker tracker_;
  std::optional<SavedMap> start_;     // the saved map that every map epoch begins with
  std::uint64_t start_checksum_ = 0;  // of the one that the settings name
  LastingTracker lasting_;
  ResumeWatch resume_;
  MovableObjects objects_;
  TrackerOutputs outputs_;
  FrameInput input_;
  time::StampWatch stamps_;  // of frames
  concurrency::Inbox<BoxesMessage> boxes_inbox_;
  concurrency::Inbox<PosesMessage> poses_inbox_;
  concurrency::Inbox<LocalMappingResult> mapping_inbox_;
  DelayedValues<BoxesMessage> boxes_;                                       // by keyframe stamp
  std::map<std::int64_t, KeyframeAwaitingBoxes> keyframes_with_boxes_due_;  // by stamp
  DelayedValues<PosesMessage> loop_answers_;                                // by keyframe id
  DelayedValues<LocalMappingResult> mappings_;                              // by keyframe id; at most one
  std::uint64_t frame_index_ = 0;
  std::uint64_t box_sets_used_ = 0;
  LoopState loops_;
  bool paused_ = false;
  map_commands::MapCommands map_commands_;
  MappingWorker mapping_worker_;
  bus::Subscription boxes_subscription_;
  bus::Subscription poses_subscription_;
};

}  // namespace rds::tracker
