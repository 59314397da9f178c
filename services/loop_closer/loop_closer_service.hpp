// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <tl/expected.hpp>

#include "common/keyframe_transfer/keyframe_source.hpp"
#include "common/map_commands/map_commands.hpp"
#include "common/service/peers/epoch_confirmation.hpp"
#include "common/service/peers/peers.hpp"
#include "common/service/service.hpp"
#include "services/loop_closer/core/loop_closer.hpp"
#include "services/loop_closer/loop_closer_checkpoints.hpp"
#include "services/loop_closer/loop_closer_service_config.hpp"
#include "services/loop_closer/pose_answers.hpp"

namespace rds::loop_closer {

/// Recognises places among keyframes and answers each one with all keyframe poses as corrected so far.
class LoopCloserService : public service::Service {
 public:
  LoopCloserService(service::ServiceContext& context, const LoopCloserServiceConfig& config);
  void run(const std::stop_token& stop) override;
  /// Hands over what is to last.
  void close() override { checkpoints_.save(true); }

 protected:
  bool begin(const service::PendingCommand& command) override;
  void idle() override { checkpoints_.save(); }
  service::CommandOutcome execute(const std::string& verb, const std::string& argument) override;

 private:
  using Features = PoseAnswers::Features;
  void go_on_from_checkpoint();
  [[nodiscard]] bool is_known(const Features& features) const;
  void forget();
  void take(const Features& features);
  void read_start(const LoopCloserServiceConfig& config);
  tl::expected<void, std::string> start_from(const map_file::Sections& saved,
                                             const std::filesystem::path& from);
  bool is_confirmed(const Features& features);

  service::FollowedWriter tracker_;
  LoopCloser loop_closer_;
  service::EpochConfirmation another_epoch_;
  Features first_of_epoch_;  // waits until it is confirmed
  LoopCloserCheckpoints checkpoints_;
  std::atomic<std::size_t> keyframes_ = 0;  // read by diagnostics
  bool paused_ = false;
  map_commands::MapCommands map_commands_;
  PoseAnswers answers_;
  bool is_read_only_;  // what is saved is what it started from
  concurrency::Inbox<Features> features_;
  std::optional<keyframe_transfer::KeyframeSource<rds_msgs::msg::KeyFrameFeatures>>
      keyframe_source_;  // last: fills the inbox
};

}  // namespace rds::loop_closer
