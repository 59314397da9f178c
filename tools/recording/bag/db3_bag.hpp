// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "common/store/sqlite.hpp"
#include "tools/recording/bag/bag.hpp"

namespace rds::recording {

/// A SQLite file of rosbag2, of any version.
class Db3Bag final : public Bag {
 public:
  static tl::expected<std::unique_ptr<Bag>, std::string> open(const std::filesystem::path& file);

  tl::expected<BagScan, std::string> scan(const Visit& visit) override;
  [[nodiscard]] tl::expected<Bytes, std::string> data_at(const BagPlace& place) const override;

 private:
  Db3Bag(std::filesystem::path file, store::Connection connection)
      : file_(std::move(file)), connection_(std::move(connection)) {}
  tl::expected<void, std::string> read_topics();
  void read_definitions();
  [[nodiscard]] std::string sentence(const store::SqliteError& error) const;

  std::filesystem::path file_;
  store::Connection connection_;
  std::map<std::uint64_t, BagTopic> topics_;  // by id
};

}  // namespace rds::recording
