// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "common/mcap/compression.hpp"
#include "tools/recording/bag/bag.hpp"

namespace rds::recording {

/// Writes recorded messages of several topics into a file. Not thread-safe.
class BagWriter {
 public:
  using Result = tl::expected<void, std::string>;

  virtual ~BagWriter() = default;
  /// Announces a topic. @return by which number its messages are written, or one sentence.
  virtual tl::expected<std::size_t, std::string> add_topic(const BagTopic& topic) = 0;
  /// @return or one sentence that names the file and what failed; then the file is torn.
  virtual Result write(std::size_t topic, const BagMessage& message) = 0;
  /// Makes what was written readable for whoever opens the file now, whatever happens to this process.
  virtual Result flush() = 0;
  /// Completes the file.
  virtual Result finish() = 0;
};

/// Makes a file that ends in .mcap or .db3; an existing one is overwritten.
/// @param compression  of an MCAP file's chunks; rosbag2's SQLite files have none.
/// @return or one sentence.
tl::expected<std::unique_ptr<BagWriter>, std::string> make_bag_writer(const std::filesystem::path& file,
                                                                      mcap::Compression compression);

}  // namespace rds::recording
