// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <stop_token>
#include <utility>
#include <vector>

#include "common/map_commands/map_commands.hpp"
#include "common/map_commands/saved_map_services.hpp"
#include "common/service/service.hpp"
#include "services/tracker/core/prediction/movable_objects.hpp"
#include "services/tracker/core/tracker.hpp"
#include "services/tracker/frame_input.hpp"
#include "services/tracker/keyframe_answers.hpp"
#include "services/tracker/background/keyframe_pictures.hpp"
#include "services/tracker/map_epoch.hpp"
#include "services/tracker/robot/robot_inputs.hpp"
#include "services/tracker/tracker_outputs.hpp"
#include "services/tracker/tracker_service_config.hpp"

namespace rds::tracker {

/// The tracking process: owns the map on its worker thread, runs local mapping on a second one.
class TrackerService : public service::Service {
 public:
  TrackerService(service::ServiceContext& context, const TrackerServiceConfig& config);
  void run(const std::stop_token& stop) override;
  static constexpr std::array kLiveSettings{"frames.publish_tf", "keyframe.movable_interval_s",
                                            "keyframe.static_interval_s"};
  /// Takes over what may change while it runs, on its worker.
  void reconfigure(const TrackerServiceConfig& config);
  /// Hands over what is to last.
  void close() override { epoch_.save(); }

 protected:
  bool begin(const service::PendingCommand& command) override;
  service::CommandOutcome execute(const std::string& verb, const std::string& argument) override;
  void idle() override;

 private:
  using BoxesMessage = KeyframeAnswers::Boxes;
  using PosesMessage = KeyframeAnswers::Poses;

  TrackerPorts ports();
  void take(const image::RgbdFrame& frame);
  void begin_after_break();
  void process(const image::RgbdFrame& frame);
  void seek();
  void acknowledge(const image::RgbdFrame& frame);
  void apply_answers();
  void apply(const BoxesMessage& boxes);
  void apply(const PosesMessage& poses);
  void apply(const LocalMappingResult& result);
  void apply_adjustment(const LocalMappingResult& result);
  void move_map(const geometry::Pose& last_before);
  void change_submap(const FrameResult& result);
  void join_submaps(const FrameReport& report);
  void ask_for_answers(const KeyframeData& keyframe, const geometry::CameraModel& camera);
  void start_mapping();
  void move_pictures(KeyframeId newest);
  /// Of frames in the transforms that others publish.
  RobotInputs::LookUp look_up();
  void publish_poses();
  service::CommandOutcome reset();
  service::CommandOutcome begin_epoch();
  service::CommandOutcome finish();

  TrackerServiceConfig config_;
  std::stop_token stop_;
  Tracker tracker_;
  MapEpoch epoch_;
  MovableObjects objects_;
  TrackerOutputs outputs_;
  FrameInput input_;
  RobotInputs robot_;
  KeyframeAnswers answers_;
  KeyframePictures pictures_;
  std::uint64_t frame_index_ = 0;
  std::uint64_t place_ = 0;  // counts the map and submaps that the camera was in, one after the other
  std::pair<std::uint64_t, std::uint64_t> refused_loop_;  // instance and revision of the newest one
  bool paused_ = false;
  map_commands::MapCommands map_commands_;
  map_commands::SavedMapServices saved_map_services_;  // of all services
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks use the members above
};

}  // namespace rds::tracker
