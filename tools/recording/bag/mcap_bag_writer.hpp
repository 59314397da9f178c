// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map_file/descriptor.hpp"
#include "common/mcap/writer.hpp"
#include "tools/recording/bag/bag_writer.hpp"

namespace rds::recording {

/// An MCAP file as rosbag2 writes it: profile ros2, offered_qos_profiles and topic_type_hash with each
/// channel.
class McapBagWriter final : public BagWriter {
 public:
  static tl::expected<std::unique_ptr<BagWriter>, std::string> make(const std::filesystem::path& file,
                                                                    mcap::Compression compression);

  tl::expected<std::size_t, std::string> add_topic(const BagTopic& topic) override;
  Result write(std::size_t topic, const BagMessage& message) override;
  Result flush() override;
  Result finish() override;

 private:
  McapBagWriter(std::filesystem::path file, map_file::Descriptor descriptor, mcap::Compression compression);
  Result append(mcap::View bytes);

  std::filesystem::path file_;
  map_file::Descriptor descriptor_;
  mcap::Writer writer_;
};

}  // namespace rds::recording
