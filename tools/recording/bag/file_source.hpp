// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "common/map_file/descriptor.hpp"
#include "common/mcap/reader.hpp"

namespace rds::recording {

/// A regular file as it was when it was opened; what is appended later does not belong to it.
class FileSource final : public mcap::Source {
 public:
  /// @return or one sentence that names the file: not there, or no regular file.
  static tl::expected<FileSource, std::string> open(const std::filesystem::path& file);

  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] bool read(std::uint64_t at, std::span<std::uint8_t> into) const override;

 private:
  FileSource(map_file::Descriptor file, std::uint64_t size) : file_(std::move(file)), size_(size) {}

  map_file::Descriptor file_;
  std::uint64_t size_;
};

}  // namespace rds::recording
