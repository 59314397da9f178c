// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory_resource>
#include <mutex>
#include <vector>

namespace rds::store {

/// Memory that lies in a temporary file without a name: what is not used for long need not be in RAM, and
/// comes back by itself when it is read. The file goes with the process, however that ends, and uses again
/// what was given back. For what is large: each piece begins at a page. Where the disk has no room, or no file
/// can be made, pieces are ordinary memory.
///
/// Any thread may allocate, deallocate and rest(), while others read and write.
class ScratchMemory : public std::pmr::memory_resource {
 public:
  /// @param folder  empty: the system's folder for temporary files (TMPDIR).
  explicit ScratchMemory(const std::filesystem::path& folder = {});
  ScratchMemory(const ScratchMemory&) = delete;
  ScratchMemory& operator=(const ScratchMemory&) = delete;
  /// All pieces must have been given back.
  ~ScratchMemory() override;

  /// All of the file leaves RAM until it is used again.
  void rest();
  /// Size of the file.
  [[nodiscard]] std::size_t bytes_in_file() const;
  /// What the file has no room for.
  [[nodiscard]] std::size_t bytes_in_ram() const;

 private:
  struct Size {
    std::size_t bytes;
    std::size_t alignment;
    auto operator<=>(const Size&) const = default;
  };
  struct Segment {
    std::uint8_t* begin;
    std::size_t size;
  };

  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* piece, std::size_t bytes, std::size_t alignment) override;
  [[nodiscard]] bool do_is_equal(const memory_resource& other) const noexcept override {
    return this == &other;
  }
  static Size size_of(std::size_t bytes, std::size_t alignment);
  std::uint8_t* take(const Size& size);
  std::uint8_t* cut(const Size& size);
  bool grow(std::size_t least);
  [[nodiscard]] bool has(const void* piece) const;

  int file_;
  std::mutex growing_;        // one at a time, before mutex_
  mutable std::mutex mutex_;  // of all below
  std::map<Size, std::vector<std::uint8_t*>> free_;
  std::vector<Segment> segments_;
  std::size_t used_ = 0;  // of the last segment
  std::size_t bytes_in_file_ = 0;
  std::size_t bytes_in_ram_ = 0;
};

}  // namespace rds::store
