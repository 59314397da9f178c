// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <vector>

#include "common/store/sqlite.hpp"
#include "tools/recording/bag/bag_writer.hpp"

namespace rds::recording {

/// A SQLite file as rosbag2 writes it since ROS 2 Iron (schema 4), with its metadata inside.
class Db3BagWriter final : public BagWriter {
 public:
  static tl::expected<std::unique_ptr<BagWriter>, std::string> make(const std::filesystem::path& file);

  tl::expected<std::size_t, std::string> add_topic(const BagTopic& topic) override;
  Result write(std::size_t topic, const BagMessage& message) override;
  Result flush() override;
  Result finish() override;

 private:
  struct Counted {
    BagTopic topic;
    std::uint64_t messages = 0;
  };
  Db3BagWriter(std::filesystem::path file, store::Connection connection);
  [[nodiscard]] Result in_words(store::SqliteResult<void> result) const;
  [[nodiscard]] std::string metadata() const;
  Result write_definition(const BagTopic& topic);

  std::filesystem::path file_;
  store::Connection connection_;
  store::Statement insert_;
  std::vector<Counted> topics_;  // topic i has the id i + 1
  std::set<std::string> defined_;
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
  std::uint64_t messages_ = 0;
};

}  // namespace rds::recording
