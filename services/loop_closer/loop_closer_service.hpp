// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include <tl/expected.hpp>

#include "common/map_commands/map_commands.hpp"
#include "common/service/peers.hpp"
#include "common/service/service.hpp"
#include "rds_msgs/msg/KeyFrameFeatures.h"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "services/loop_closer/core/loop_closer.hpp"
#include "services/loop_closer/loop_closer_service_config.hpp"

namespace rds::loop_closer {

/// Recognises places among keyframes and answers each one with all keyframe poses as corrected so far.
class LoopCloserService : public service::Service {
 public:
  LoopCloserService(service::ServiceContext& context, const LoopCloserServiceConfig& config);
  void run(const std::stop_token& stop) override;

 protected:
  bool begin(const service::PendingCommand& command) override;
  service::CommandOutcome execute(const std::string& verb, const std::string& argument) override;

 private:
  using Features = std::shared_ptr<const rds_msgs::msg::KeyFrameFeatures>;
  using Poses = std::shared_ptr<const rds_msgs::msg::KeyFramePoses>;
  void take(const Features& features);
  void read_start(const LoopCloserServiceConfig& config);
  tl::expected<void, std::string> start_from(const map_file::Sections& saved,
                                             const std::filesystem::path& from);
  void answer(const Features& features, const LoopAnswer& answer);

  service::FollowedWriter tracker_;
  LoopCloser loop_closer_;
  bool paused_ = false;
  map_commands::MapCommands map_commands_;
  rds_msgs::msg::KeyFramePoses corrected_;  // of the last loop
  int repeats_ = 0;                         // answers that still carry its poses
  concurrency::Inbox<Features> features_;
  bus::Publisher<rds_msgs::msg::KeyFramePoses> poses_;
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks fill the inbox
};

}  // namespace rds::loop_closer
