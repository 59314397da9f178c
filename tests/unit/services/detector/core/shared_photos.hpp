// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include <opencv2/imgcodecs.hpp>

#include "services/detector/models/model_store.hpp"

namespace rds::detector::test {

/// Folder of the test photos; nullopt where RDS_SHARED does not lead to them.
inline std::optional<std::filesystem::path> photo_folder() {
  const char* shared = std::getenv("RDS_SHARED");
  if (shared == nullptr) return std::nullopt;
  const auto folder = std::filesystem::path(shared) / "models" / "photos";
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  return folder;
}

inline bool network_is_there(const std::string& name) {
  const auto folders = model_folders();
  return find_file(find_description(name, folders), folders).has_value();
}

inline image::ColorImage load_photo(const std::string& name) {
  return {cv::imread((photo_folder().value() / name).string(), cv::IMREAD_COLOR), image::ChannelOrder::kBgr,
          nullptr};
}

}  // namespace rds::detector::test
