// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/viewer_service_config.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>

#include "common/topics/camera_presets.hpp"
#include "services/viewer/listen_address.hpp"

namespace rds::viewer {
namespace {

constexpr std::size_t kShortestToken = 16;  // characters; of 64 kinds, nobody tries them all
constexpr std::size_t kLongestToken = 256;
constexpr const char* kTokenVariable = "RDS_VIEWER_TOKEN";

std::string token_text(const ViewerServiceConfig& config) {
  if (config.token_file.empty()) {
    const char* set = std::getenv(kTokenVariable);
    return set == nullptr ? "" : set;
  }
  std::ifstream file(config.token_file);
  std::string token;
  if (!std::getline(file, token))
    throw config::ConfigError(fmt::format("token_file: {}: expected a file with a token", config.token_file));
  return token;
}

}  // namespace

void read(config::ConfigReader& reader, ViewerServiceConfig& config) {
  reader.value("nice", config.nice, 0, 19);
  reader.value("listen", config.listen);
  if (const auto listen = parse_listen_address(config.listen); !listen)
    reader.violation("listen", config.listen, "expected " + listen.error());
  reader.value("token_file", config.token_file);
  reader.value("allow_commands", config.allow_commands);
  reader.value("allowed_origins", config.allowed_origins);
  reader.value("max_clients", config.max_clients, 1, 100);
  reader.value("picture_hz", config.picture_hz, 0.1, 60.0, "Hz");
  reader.value("picture_quality", config.picture_quality, 1, 100);
  const topics::CameraPreset preset = topics::read_camera_preset(reader, "camera_preset");
  topics::read_topic(reader, "color_topic", preset.color, config.color_topic);
  topics::read_topic(reader, "camera_info_topic", preset.camera_info, config.camera_info_topic);
}

std::string access_token(const ViewerServiceConfig& config) {
  const std::string token = token_text(config);
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; };
  if (token.empty()) {
    const auto listen = parse_listen_address(config.listen);
    if (listen && !listen->is_loopback())
      throw config::ConfigError(fmt::format(
          "listen: {}: expected a token (token_file, or {}) where others than this machine are served",
          config.listen, kTokenVariable));
    return token;
  }
  if (token.size() < kShortestToken || token.size() > kLongestToken || !std::ranges::all_of(token, is_plain))
    throw config::ConfigError(fmt::format(
        "the viewer's token: expected {} to {} letters, digits, '-' and '_', e.g. of openssl rand -hex 16",
        kShortestToken, kLongestToken));
  return token;
}

}  // namespace rds::viewer
