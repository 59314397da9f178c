// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/topics/topics.hpp"

namespace rds::viewer {

struct ViewerServiceConfig {
  int nice = 10;                             // the tracker has the processor first
  std::string listen = "127.0.0.1:8080";     // ADDRESS:PORT; others than of this machine need a token
  std::string token_file;                    // its first line is the token; empty: $RDS_VIEWER_TOKEN, or none
  bool allow_commands = false;               // pages may pause, save and reset
  std::vector<std::string> allowed_origins;  // other sites whose pages may connect, e.g. a Lichtblick's
  int max_clients = 32;
  double picture_hz = 5;                          // pictures a second, at most
  int picture_quality = 75;                       // of JPEG
  std::string color_topic = topics::kColor.name;  // as the tracker's camera.color
  std::string camera_info_topic = topics::kCameraInfo.name;

  bool operator==(const ViewerServiceConfig&) const = default;
};

void read(config::ConfigReader& reader, ViewerServiceConfig& config);

/// The token that is asked for; empty: none.
/// @throws config::ConfigError for a file without one, characters that no address takes, and where one is
/// needed.
std::string access_token(const ViewerServiceConfig& config);

}  // namespace rds::viewer
