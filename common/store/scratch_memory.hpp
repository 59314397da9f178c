// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

namespace rds::store {

/// Memory that lies in a temporary file without a name: what is not used for long need not be in RAM, and
/// comes back by itself when it is read. The file goes with the process, however that ends, and uses again
/// what was given back. Any thread may allocate, give back and rest(), while others read and write.
class ScratchMemory {
 public:
  /// @param folder  empty: the system's folder for temporary files (TMPDIR).
  explicit ScratchMemory(const std::filesystem::path& folder = {});

  /// Bytes that begin at a page; nullptr where the disk has no room for them, or no file can be made there.
  /// They outlast this object, and are given back when the last copy of the pointer goes.
  [[nodiscard]] std::shared_ptr<std::uint8_t[]> allocate(std::size_t bytes);
  /// All of it leaves RAM until it is used again.
  void rest();
  /// Size of the file.
  [[nodiscard]] std::size_t bytes() const;

 private:
  class File;
  std::shared_ptr<File> file_;
};

}  // namespace rds::store
