// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/store/scratch_file.hpp"
#include "services/mapper/core/keyframe/keyframe_store.hpp"

namespace rds::mapper {

/// Packed keyframes in a scratch file.
class SpillFile : public SpillStorage {
 public:
  /// @param folder  empty: the system's folder for temporary files.
  explicit SpillFile(std::filesystem::path folder) : file_(std::move(folder)) {}

  bool put(std::uint64_t id, std::span<const std::uint8_t> bytes) override;
  std::optional<map_file::Bytes> get(std::uint64_t id) override;
  void erase(std::uint64_t id) override;
  void clear() override { file_.clear(); }

 private:
  store::ScratchFile file_;
};

}  // namespace rds::mapper
