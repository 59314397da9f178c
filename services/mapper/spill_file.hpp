// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "common/store/store.hpp"
#include "services/mapper/core/keyframe/keyframe_store.hpp"

namespace rds::mapper {

/// A temporary file without a name: it goes with the process, however that ends, and uses again what was
/// erased. Made at the first put().
class SpillFile : public SpillStorage {
 public:
  /// @param folder  empty: the system's folder for temporary files.
  explicit SpillFile(std::filesystem::path folder) : folder_(std::move(folder)) {}

  bool put(std::uint64_t id, std::span<const std::uint8_t> bytes) override;
  std::optional<map_file::Bytes> get(std::uint64_t id) override;
  void erase(std::uint64_t id) override;
  void clear() override { file_.reset(); }

 private:
  std::filesystem::path folder_;
  std::optional<store::Store> file_;
};

}  // namespace rds::mapper
