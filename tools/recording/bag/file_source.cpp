// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/bag/file_source.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace rds::recording {

tl::expected<FileSource, std::string> FileSource::open(const std::filesystem::path& file) {
  map_file::Descriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!descriptor.is_open() || fstat(descriptor.number(), &status) != 0)
    return tl::unexpected(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
  if (!S_ISREG(status.st_mode)) return tl::unexpected(fmt::format("{}: no regular file", file.string()));
  return FileSource(std::move(descriptor), static_cast<std::uint64_t>(status.st_size));
}

bool FileSource::read(std::uint64_t at, std::span<std::uint8_t> into) const {
  while (!into.empty()) {
    const ssize_t count = pread(file_.number(), into.data(), into.size(), static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += static_cast<std::uint64_t>(count);
    into = into.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace rds::recording
