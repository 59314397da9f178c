// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <opencv2/imgcodecs.hpp>

#include "services/detector/models/model_store.hpp"
#include "tests/support/shared_data.hpp"

namespace rds::detector::test {

constexpr const char* kPhotos = "models/photos";

inline bool network_is_there(const std::string& name) {
  const auto folders = model_folders();
  return find_file(find_description(name, folders), folders).has_value();
}

inline image::ColorImage load_photo(const std::string& name) {
  const auto file = rds::test::shared() / kPhotos / name;
  return {cv::imread(file.string(), cv::IMREAD_COLOR), image::ChannelOrder::kBgr, nullptr};
}

}  // namespace rds::detector::test
