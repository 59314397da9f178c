// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include <tl/expected.hpp>

#include "common/keyframe_transfer/keyframe_source.hpp"
#include "common/map_commands/map_commands.hpp"
#include "common/messages/keyframe_pose_table.hpp"
#include "common/service/peers/epoch_confirmation.hpp"
#include "common/service/peers/peers.hpp"
#include "common/service/service.hpp"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "services/mapper/core/semantic_mapper.hpp"
#include "services/mapper/input/waiting_boxes.hpp"
#include "services/mapper/input/waiting_keyframes.hpp"
#include "services/mapper/loop_knowledge.hpp"
#include "services/mapper/map_outputs.hpp"
#include "services/mapper/mapper_checkpoints.hpp"
#include "services/mapper/mapper_service_config.hpp"

namespace rds::mapper {

/// Builds the semantic map from keyframe pictures, 3-D boxes and keyframe poses.
class MapperService : public service::Service {
 public:
  MapperService(service::ServiceContext& context, const MapperServiceConfig& config);
  void run(const std::stop_token& stop) override;
  /// Hands over what is to last.
  void close() override { checkpoints_.save(mapper_, true); }

 protected:
  bool begin(const service::PendingCommand& command) override;
  service::CommandOutcome execute(const std::string& verb, const std::string& argument) override;
  void idle() override;

 private:
  using Images = WaitingKeyframes::Images;
  using Boxes = WaitingBoxes::Boxes;
  using Poses = std::shared_ptr<const rds_msgs::msg::KeyFramePoses>;

  [[nodiscard]] bool has_messages() const;
  void take_messages();
  void take(const Images& images);
  void take(const Boxes& boxes);
  void take(const Poses& poses);
  [[nodiscard]] bool is_of_tracker(std::uint64_t instance, std::uint64_t map_epoch, const std::string& topic);
  [[nodiscard]] bool is_of_loop_closer(const Poses& poses);
  void begin_epoch(std::uint64_t map_epoch, std::int64_t stamp_ns);
  void forget_keyframes();
  std::optional<std::vector<LabelledBox>> labelled_boxes(const Boxes& boxes,
                                                         const geometry::Pose& camera_from_map,
                                                         const geometry::CameraModel& camera);
  void integrate_ready();
  [[nodiscard]] bool is_ready(const Images& images) const;
  void integrate(const Images& images);
  bool is_confirmed(const Images& images);
  bool is_over(std::uint64_t map_epoch);
  void correct();
  void report_losses();
  void publish(MapDelta delta);
  void publish_all();
  [[nodiscard]] MapProgress progress() const;
  service::CommandOutcome finish(const std::string& argument);
  void subscribe_to_keyframes();
  void read_start();
  [[nodiscard]] map_file::MapPart map_part() const;
  void load(const service::PendingCommand& command);
  service::CommandOutcome finish_load(const tl::expected<void, std::string>& started,
                                    const std::filesystem::path& from);
  void go_on_from_checkpoint();
  void wait_for_rest(std::uint64_t poses_revision, std::uint64_t keyframes);

  MapperServiceConfig config_;
  std::stop_token stop_;
  service::FollowedWriter tracker_;
  service::FollowedWriter loop_closer_;
  std::uint64_t tracker_instance_ = 0;                    // that is followed
  std::deque<std::uint64_t> earlier_epochs_;              // of that tracker
  std::chrono::steady_clock::time_point heard_of_epoch_;  // that the map is of
  service::EpochConfirmation another_epoch_;
  Images first_of_epoch_;  // waits until it is confirmed
  LoopKnowledge loops_;    // contained in poses_
  MapperCheckpoints checkpoints_;     // before mapper_, whose records it keeps
  SemanticMapper mapper_;
  MapOutputs outputs_;
  WaitingKeyframes waiting_;
  WaitingBoxes waiting_boxes_;
  std::map<std::int64_t, Integrated> integrated_by_stamp_;  // the newest of each stamp
  std::vector<Poses> early_poses_;  // of an epoch whose first keyframe has not come yet, in order
  messages::KeyframePoseTable tracker_poses_;
  std::vector<KeyframePose> poses_;
  std::uint64_t poses_revision_ = 0;  // of the newest LOCAL poses
  bool poses_changed_by_loop_ = false;
  std::uint64_t last_keyframe_id_ = 0;
  std::int64_t last_stamp_ns_ = 0;
  std::atomic<std::size_t> corrections_lost_ = 0;  // read by diagnostics
  int since_full_ = 0;
  int since_correction_ = 0;
  bool paused_ = false;
  map_commands::MapCommands map_commands_;
  concurrency::Inbox<Images> images_inbox_;
  concurrency::Inbox<Boxes> boxes_inbox_;
  concurrency::Inbox<Poses> poses_inbox_;
  std::optional<keyframe_transfer::KeyframeSource<rds_msgs::msg::KeyFrameImages>> keyframes_;
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks fill the inboxes
};

}  // namespace rds::mapper
