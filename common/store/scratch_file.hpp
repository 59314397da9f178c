// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "common/store/store.hpp"

namespace rds::store {

/// Rows of bytes in a temporary file without a name: it goes with the process, however that ends, and uses
/// again what was erased. Made at the first put().
class ScratchFile {
 public:
  /// @param folder  empty: the system's folder for temporary files (TMPDIR).
  explicit ScratchFile(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

  /// @return false if they could not be stored.
  bool put(const std::string& kind, std::uint64_t id, std::span<const std::uint8_t> bytes);
  /// nullopt: it is not there, or cannot be read as it was written.
  [[nodiscard]] std::optional<Bytes> get(const std::string& kind, std::uint64_t id) const;
  void erase(const std::string& kind, std::uint64_t id);
  void clear() { file_.reset(); }

 private:
  std::filesystem::path folder_;
  std::optional<Store> file_;
};

}  // namespace rds::store
