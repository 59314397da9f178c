// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/spill_file.hpp"

#include <cerrno>
#include <cstdlib>

#include <fcntl.h>
#include <unistd.h>

namespace rds::mapper {
namespace {

/// Moves all bytes with pread() or pwrite(), which may do it in parts.
template <class Function, class Byte>
bool transfer(Function function, int file, std::span<Byte> bytes, std::uint64_t offset) {
  while (!bytes.empty()) {
    const auto moved = function(file, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (moved < 0 && errno == EINTR) continue;
    if (moved <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(moved));
    offset += static_cast<std::uint64_t>(moved);
  }
  return true;
}

}  // namespace

SpillFile::~SpillFile() {
  if (file_ >= 0) ::close(file_);
}

bool SpillFile::open() {
  if (file_ >= 0) return true;
  std::error_code error;
  const auto folder = folder_.empty() ? std::filesystem::temp_directory_path(error) : folder_;
  if (error) return false;
  std::string name = (folder / "rds-mapper-XXXXXX").string();
  file_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (file_ < 0) return false;
  ::unlink(name.c_str());
  return true;
}

std::optional<std::uint64_t> SpillFile::append(std::span<const std::uint8_t> bytes) {
  if (!open() || !transfer(::pwrite, file_, bytes, end_)) return std::nullopt;
  const std::uint64_t begin = end_;
  end_ += bytes.size();
  return begin;
}

bool SpillFile::read(std::uint64_t offset, std::span<std::uint8_t> bytes) {
  return file_ >= 0 && transfer(::pread, file_, bytes, offset);
}

void SpillFile::clear() {
  end_ = 0;
  if (file_ < 0) return;
  ::close(file_);
  file_ = -1;
}

}  // namespace rds::mapper
