// SPDX-License-Identifier: Apache-2.0
#include "common/store/scratch_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

namespace rds::store {
namespace {

constexpr std::size_t kPage = 4096;
constexpr std::size_t kSegment = std::size_t{16} << 20U;  // by which the file grows

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

/// Whole pages.
ScratchMemory::Size ScratchMemory::size_of(std::size_t bytes, std::size_t alignment) {
  return {(std::max(bytes, std::size_t{1}) + kPage - 1) / kPage * kPage, std::max(alignment, kPage)};
}

ScratchMemory::ScratchMemory(const std::filesystem::path& folder) : file_(open_nameless(folder)) {}

ScratchMemory::~ScratchMemory() {
  for (const auto& segment : segments_) ::munmap(segment.begin, segment.size);
  if (file_ >= 0) ::close(file_);
}

void* ScratchMemory::do_allocate(std::size_t bytes, std::size_t alignment) {
  const Size size = size_of(bytes, alignment);
  if (std::uint8_t* const piece = take(size)) return piece;
  {
    const std::lock_guard growing(growing_);  // the disk may take its time: who gives back does not wait
    if (std::uint8_t* const piece = take(size)) return piece;
    if (grow(size.bytes + size.alignment))
      if (std::uint8_t* const piece = take(size)) return piece;
  }
  const std::lock_guard lock(mutex_);
  void* const piece = std::pmr::new_delete_resource()->allocate(bytes, alignment);
  bytes_in_ram_ += bytes;
  return piece;
}

void ScratchMemory::do_deallocate(void* piece, std::size_t bytes, std::size_t alignment) {
  const std::lock_guard lock(mutex_);
  if (has(piece)) return free_[size_of(bytes, alignment)].push_back(static_cast<std::uint8_t*>(piece));
  std::pmr::new_delete_resource()->deallocate(piece, bytes, alignment);
  bytes_in_ram_ -= bytes;
}

void ScratchMemory::rest() {
  std::vector<Segment> segments;
  {
    const std::lock_guard lock(mutex_);
    segments = segments_;
  }
  for (const auto& segment : segments) ::madvise(segment.begin, segment.size, MADV_DONTNEED);
}

std::size_t ScratchMemory::bytes_in_file() const {
  const std::lock_guard lock(mutex_);
  return bytes_in_file_;
}

std::size_t ScratchMemory::bytes_in_ram() const {
  const std::lock_guard lock(mutex_);
  return bytes_in_ram_;
}

/// @return nullptr where there is no room
std::uint8_t* ScratchMemory::take(const Size& size) {
  const std::lock_guard lock(mutex_);
  if (const auto freed = free_.find(size); freed != free_.end() && !freed->second.empty()) {
    std::uint8_t* const piece = freed->second.back();
    freed->second.pop_back();
    return piece;
  }
  return cut(size);
}

/// Of the last segment.
std::uint8_t* ScratchMemory::cut(const Size& size) {
  if (segments_.empty()) return nullptr;
  void* piece = segments_.back().begin + used_;
  std::size_t left = segments_.back().size - used_;
  if (std::align(size.alignment, size.bytes, piece, left) == nullptr) return nullptr;
  used_ = segments_.back().size - left + size.bytes;
  return static_cast<std::uint8_t*>(piece);
}

/// Blocks of the disk are reserved: who writes to a page that the disk has no room for is killed.
bool ScratchMemory::grow(std::size_t least) {
  const std::size_t size = std::max(least, kSegment);
  const auto end = static_cast<off_t>(bytes_in_file());
  if (file_ < 0 || ::posix_fallocate(file_, end, static_cast<off_t>(size)) != 0) return false;
  void* const begin = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file_, end);
  if (begin == MAP_FAILED) return false;
  const std::lock_guard lock(mutex_);
  segments_.push_back({static_cast<std::uint8_t*>(begin), size});
  bytes_in_file_ += size;
  used_ = 0;
  return true;
}

bool ScratchMemory::has(const void* piece) const {
  const auto* const at = static_cast<const std::uint8_t*>(piece);
  return std::ranges::any_of(segments_, [at](const Segment& segment) {
    return std::less_equal{}(segment.begin, at) && std::less{}(at, segment.begin + segment.size);
  });
}

}  // namespace rds::store
