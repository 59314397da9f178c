// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "common/messages/registry.hpp"

namespace rds::messages {

/// A message of another encoder: its bytes, and its values as JSON.
struct WireRecording {
  const MessageType* type;  // nullptr if no IDL file defines it
  std::string name;         // "nav_msgs__Odometry"
  std::vector<std::uint8_t> bytes;
  Json values;
};

/// $RDS_SHARED/data/wire; empty if it is not there.
inline std::vector<WireRecording> wire_recordings() {
  std::vector<WireRecording> recordings;
  const char* shared = std::getenv("RDS_SHARED");
  if (shared == nullptr) return recordings;
  const std::filesystem::path folder = std::filesystem::path(shared) / "data" / "wire";
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
    if (entry.path().extension() != ".cdr") continue;
    const std::string name = entry.path().stem().string();
    const auto separator = name.find("__");
    const std::string package = name.substr(0, separator);
    std::string type = name.substr(separator + 2);
    if (package == "rmw_dds_common") type = "Humble" + type;  // in whose form it was recorded
    const std::string dds_name = package + "::msg::dds_::" + type + "_";
    std::ifstream bytes(entry.path(), std::ios::binary);
    std::ifstream values(std::filesystem::path(entry.path()).replace_extension(".json"));
    recordings.push_back({find_message_type(dds_name), name,
                          std::vector<std::uint8_t>(std::istreambuf_iterator<char>(bytes), {}),
                          Json::parse(values)});
  }
  return recordings;
}

using MessagePtr = std::shared_ptr<void>;

inline MessagePtr make_message(const MessageType& type) {
  return {type.ops->create(), type.ops->destroy};
}

inline std::vector<std::uint8_t> encode(const MessageType& type, const void* message) {
  std::vector<std::uint8_t> bytes(type.ops->encoded_size(message), 0xAA);  // memory that was used before
  bytes.resize(type.ops->encode(message, bytes.data(), bytes.size()));
  return bytes;
}

}  // namespace rds::messages
