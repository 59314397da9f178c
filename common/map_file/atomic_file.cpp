// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/atomic_file.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/map_file/regular_file.hpp"

namespace rds::map_file {
namespace fs = std::filesystem;
namespace {

Descriptor open_file(const fs::path& path, int flags) {
  constexpr mode_t kMode = S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH;
  return Descriptor(open(path.c_str(), flags | O_CLOEXEC, kMode));
}

/// @return a fault, or nothing.
tl::expected<void, FileFault> write_and_rename(const fs::path& partial, const fs::path& file,
                                               std::span<const std::uint8_t> content) {
  (void)unlink(partial.c_str());  // what is there under this name is not written to
  const Descriptor out = open_file(partial, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW);
  if (auto written = write_durably(out, content, {}); !written) return written;
  if (std::rename(partial.c_str(), file.c_str()) != 0) return tl::unexpected(std::strerror(errno));
  return {};
}

}  // namespace

tl::expected<void, std::string> write_atomically(const fs::path& file,
                                                 std::span<const std::uint8_t> content) {
  fs::path partial = file;
  partial += fmt::format(".partial-{}", getpid());
  if (const auto written = write_and_rename(partial, file, content); !written) {
    std::error_code ignored;
    fs::remove(partial, ignored);
    return tl::unexpected(fmt::format("{}: cannot be written: {}", file.string(), written.error()));
  }
  // The new name lies in the folder; a file system that cannot sync folders keeps the old or the new name
  // anyway.
  const Descriptor folder =
      open_file(file.has_parent_path() ? file.parent_path() : ".", O_RDONLY | O_DIRECTORY);
  if (folder.is_open()) (void)fsync(folder.number());
  return {};
}

}  // namespace rds::map_file
