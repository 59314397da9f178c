// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/recording/bag/bag.hpp"
#include "tools/recording/bag/file_source.hpp"

namespace rds::recording {

/// An MCAP file.
class McapBag final : public Bag {
 public:
  static tl::expected<std::unique_ptr<Bag>, std::string> open(const std::filesystem::path& file);

  tl::expected<BagScan, std::string> scan(const Visit& visit) override;
  [[nodiscard]] tl::expected<Bytes, std::string> data_at(const BagPlace& place) const override;

 private:
  McapBag(std::filesystem::path file, FileSource source)
      : file_(std::move(file)), source_(std::move(source)), reader_(source_) {}

  std::filesystem::path file_;
  FileSource source_;
  mcap::Reader reader_;
};

}  // namespace rds::recording
