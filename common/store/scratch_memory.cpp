// SPDX-License-Identifier: Apache-2.0
#include "common/store/scratch_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace rds::store {
namespace {

constexpr std::size_t kPage = 4096;
constexpr std::size_t kSegment = std::size_t{16} << 20U;  // by which the file grows

std::size_t whole_pages(std::size_t bytes) {
  return (std::max(bytes, std::size_t{1}) + kPage - 1) / kPage * kPage;
}

/// @return -1 if none can be made.
int open_nameless(const std::filesystem::path& folder) {
  std::error_code error;
  const auto place = folder.empty() ? std::filesystem::temp_directory_path(error) : folder;
  std::string name = (place / "rds-memory-XXXXXX").string();
  const int file = error ? -1 : ::mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) ::unlink(name.c_str());
  return file;
}

}  // namespace

class ScratchMemory::File {
 public:
  explicit File(const std::filesystem::path& folder) : file_(open_nameless(folder)) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    for (const auto& segment : segments_) ::munmap(segment.begin, segment.size);
    if (file_ >= 0) ::close(file_);
  }

  /// @param size  whole pages.
  std::uint8_t* take(std::size_t size) {
    const std::lock_guard lock(mutex_);
    if (const auto freed = free_.find(size); freed != free_.end() && !freed->second.empty()) {
      std::uint8_t* const begin = freed->second.back();
      freed->second.pop_back();
      return begin;
    }
    if ((segments_.empty() || segments_.back().size - used_ < size) && !grow(size)) return nullptr;
    return segments_.back().begin + std::exchange(used_, used_ + size);
  }

  void give_back(std::uint8_t* begin, std::size_t size) {
    const std::lock_guard lock(mutex_);
    free_[size].push_back(begin);
  }

  void rest() const {
    const std::lock_guard lock(mutex_);
    for (const auto& segment : segments_) ::madvise(segment.begin, segment.size, MADV_DONTNEED);
  }

  std::size_t bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
  }

 private:
  struct Segment {
    std::uint8_t* begin;
    std::size_t size;
  };

  /// Blocks of the disk are reserved: who writes to a page that the disk has no room for is killed.
  bool grow(std::size_t least) {
    const std::size_t size = std::max(least, kSegment);
    if (file_ < 0 || ::posix_fallocate(file_, static_cast<off_t>(bytes_), static_cast<off_t>(size)) != 0)
      return false;
    void* const begin =
        ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file_, static_cast<off_t>(bytes_));
    if (begin == MAP_FAILED) return false;
    segments_.push_back({static_cast<std::uint8_t*>(begin), size});
    bytes_ += size;
    used_ = 0;
    return true;
  }

  int file_;
  mutable std::mutex mutex_;
  std::vector<Segment> segments_;
  std::size_t used_ = 0;   // of the last segment
  std::size_t bytes_ = 0;  // of all
  std::map<std::size_t, std::vector<std::uint8_t*>> free_;  // by size
};

ScratchMemory::ScratchMemory(const std::filesystem::path& folder) : file_(std::make_shared<File>(folder)) {}

std::shared_ptr<std::uint8_t[]> ScratchMemory::allocate(std::size_t bytes) {
  const std::size_t size = whole_pages(bytes);
  std::uint8_t* const begin = file_->take(size);
  if (begin == nullptr) return nullptr;
  return {begin, [file = file_, size](std::uint8_t* p) { file->give_back(p, size); }};
}

void ScratchMemory::rest() {
  file_->rest();
}

std::size_t ScratchMemory::bytes() const {
  return file_->bytes();
}

}  // namespace rds::store
