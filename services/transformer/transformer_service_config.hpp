// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/config_reader.hpp"
#include "common/topics/topics.hpp"
#include "services/transformer/core/transformer_config.hpp"

namespace rds::transformer {

struct TransformerServiceConfig {
  int nice = 10;  // the tracker has the processor first
  std::string camera_info_topic = topics::kCameraInfo.name;
  TransformerConfig transformer;

  bool operator==(const TransformerServiceConfig&) const = default;
};

void read(config::ConfigReader& reader, TransformerServiceConfig& config);

}  // namespace rds::transformer
