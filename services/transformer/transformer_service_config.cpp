// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/transformer_service_config.hpp"

namespace rds::transformer {

void read(config::ConfigReader& reader, TransformerServiceConfig& config) {
  reader.value("nice", config.nice, 0, 19);
  reader.value("camera_info_topic", config.camera_info_topic);
  read(reader, config.transformer);
}

}  // namespace rds::transformer
