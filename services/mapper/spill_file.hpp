// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "services/mapper/core/keyframe_store.hpp"

namespace rds::mapper {

/// A temporary file without a name: it goes with the process, however that ends. Made at the first append().
class SpillFile : public SpillStorage {
 public:
  /// @param folder  empty: the system's folder for temporary files.
  explicit SpillFile(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ~SpillFile() override;
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  std::optional<std::uint64_t> append(std::span<const std::uint8_t> bytes) override;
  bool read(std::uint64_t offset, std::span<std::uint8_t> bytes) override;
  void clear() override;

 private:
  bool open();

  std::filesystem::path folder_;
  int file_ = -1;
  std::uint64_t end_ = 0;
};

}  // namespace rds::mapper
