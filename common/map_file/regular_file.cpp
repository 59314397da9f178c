// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/regular_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

namespace rds::map_file {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 20;  // between looks at the clock
constexpr int kReadOnly = O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;

std::optional<FileFault> fault_of(const FileLimits& limits) {
  if (limits.stop.stop_requested()) return "broken off";
  if (std::chrono::steady_clock::now() > limits.deadline) return "not done in time";
  return std::nullopt;
}

/// @return the size [bytes] of a regular file that is not too large, or a fault.
tl::expected<std::size_t, FileFault> size_of(const Descriptor& file, const FileLimits& limits) {
  struct stat about {};
  if (!file.is_open() || fstat(file.number(), &about) != 0) return tl::unexpected(std::strerror(errno));
  if (S_ISDIR(about.st_mode)) return tl::unexpected<FileFault>("is a folder, expected a file");
  if (!S_ISREG(about.st_mode)) return tl::unexpected<FileFault>("is no regular file");
  const auto size = static_cast<std::uint64_t>(about.st_size);
  if (size <= limits.max_bytes) return static_cast<std::size_t>(size);
  return tl::unexpected(fmt::format("has {} bytes, expected at most {}", size, limits.max_bytes));
}

}  // namespace

tl::expected<std::vector<std::uint8_t>, FileFault> read_all(const Descriptor& file,
                                                            const FileLimits& limits) {
  const auto size = size_of(file, limits);
  if (!size) return tl::unexpected(size.error());
  std::vector<std::uint8_t> bytes(*size);
  std::size_t at = 0;
  while (at < bytes.size()) {
    if (auto fault = fault_of(limits)) return tl::unexpected(*fault);
    const ssize_t got = read(file.number(), bytes.data() + at, std::min(kChunk, bytes.size() - at));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return tl::unexpected(std::strerror(errno));
    if (got == 0) break;  // shorter by now
    at += static_cast<std::size_t>(got);
  }
  bytes.resize(at);
  return bytes;
}

tl::expected<void, FileFault> write_durably(const Descriptor& file, std::span<const std::uint8_t> bytes,
                                            const FileLimits& limits) {
  while (file.is_open() && !bytes.empty()) {
    if (auto fault = fault_of(limits)) return tl::unexpected(*fault);
    const ssize_t written = write(file.number(), bytes.data(), std::min(kChunk, bytes.size()));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return tl::unexpected(std::strerror(errno));
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  if (!file.is_open() || fsync(file.number()) != 0) return tl::unexpected(std::strerror(errno));
  return {};
}

std::string start_of_file(const std::filesystem::path& file, std::size_t bytes) {
  const Descriptor in(open(file.c_str(), kReadOnly));
  std::string start(bytes, '\0');
  if (!size_of(in, {})) return {};
  const ssize_t got = pread(in.number(), start.data(), bytes, 0);
  return start.substr(0, static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
}

tl::expected<std::vector<std::uint8_t>, FileFault> read_regular_file(const std::filesystem::path& file,
                                                                     const FileLimits& limits) {
  return read_all(Descriptor(open(file.c_str(), kReadOnly)), limits);
}

}  // namespace rds::map_file
