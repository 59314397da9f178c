// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "common/keyframe_transfer/keyframe_source.hpp"
#include "common/map_commands/map_commands.hpp"
#include "common/service/service.hpp"
#include "common/store/scratch_memory.hpp"
#include "services/mapper/core/semantic_mapper.hpp"
#include "services/mapper/input/epoch_follower.hpp"
#include "services/mapper/input/keyframe_queue.hpp"
#include "services/mapper/input/known_poses.hpp"
#include "services/mapper/input/unplaced_keyframes.hpp"
#include "services/mapper/map_outputs.hpp"
#include "services/mapper/map_services.hpp"
#include "services/mapper/mapper_checkpoints.hpp"
#include "services/mapper/mapper_service_config.hpp"

namespace rds::mapper {

/// Builds the semantic map from keyframe pictures, 3-D boxes and keyframe poses.
class MapperService : public service::Service {
 public:
  MapperService(service::ServiceContext& context, const MapperServiceConfig& config);
  void run(const std::stop_token& stop) override;
  static constexpr std::array kLiveSettings{"boxes_timeout_s", "full_map_every", "grid.min_height_m",
                                            "grid.max_height_m"};
  /// Takes over what may change while it runs, on its worker.
  void reconfigure(const MapperServiceConfig& config);
  /// Hands over what is to last.
  void close() override { checkpoints_.save(mapper_, true); }

 protected:
  bool begin(const service::PendingCommand& command) override;
  service::CommandOutcome execute(const std::string& verb, const std::string& argument) override;
  void idle() override;

 private:
  using Images = KeyframeQueue::Images;
  using Boxes = KeyframeQueue::Boxes;
  using Poses = EpochFollower::Poses;

  /// Filled by callbacks of the bus.
  struct Inboxes {
    concurrency::Inbox<Images> images;
    concurrency::Inbox<Boxes> boxes;
    concurrency::Inbox<Poses> poses;
    [[nodiscard]] bool locked_empty() const {
      return images.locked_empty() && boxes.locked_empty() && poses.locked_empty();
    }
  };

  void subscribe();
  void take_messages();
  void take(const Images& images);
  void take(const Boxes& boxes);
  void take(const Poses& poses);
  [[nodiscard]] bool is_of_tracker(std::uint64_t instance, std::uint64_t map_epoch, const std::string& topic);
  void begin_epoch(std::uint64_t map_epoch, std::int64_t stamp_ns);
  void begin_map();
  void integrate_ready();
  void integrate_placed(std::size_t most);
  void integrate(const KeyframeQueue::Entry& entry);
  void correct();
  service::CommandOutcome finish(const std::string& argument);
  void wait_for_rest(std::uint64_t poses_revision, std::uint64_t keyframes);
  void go_on_from_checkpoint();

  MapperServiceConfig config_;
  std::stop_token stop_;
  EpochFollower epochs_;
  MapperCheckpoints checkpoints_;  // before mapper_, whose records it keeps
  store::ScratchMemory evidence_memory_;  // before mapper_, too
  std::size_t integrated_ = 0;            // keyframes
  SemanticMapper mapper_;
  MapOutputs outputs_;
  KeyframeQueue queue_;
  KnownPoses poses_;
  UnplacedKeyframes unplaced_;
  bool is_paused_ = false;
  map_commands::MapCommands map_commands_;
  Inboxes inboxes_;
  MapServices map_services_;
  std::optional<keyframe_transfer::KeyframeSource<rds_msgs::msg::KeyFrameImages>> keyframe_source_;
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks fill the inboxes
};

}  // namespace rds::mapper
