// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/atomic_file.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace rds::map_file {
namespace fs = std::filesystem;
namespace {

/// A file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : number_(open(path.c_str(), flags | O_CLOEXEC, 0644)) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  /// Writes all bytes and waits until the disk has them. @return false and errno on failure.
  [[nodiscard]] bool write_durably(std::span<const std::uint8_t> bytes) const {
    while (number_ >= 0 && !bytes.empty()) {
      const ssize_t written = write(number_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return sync();
  }
  [[nodiscard]] bool sync() const { return number_ >= 0 && fsync(number_) == 0; }

 private:
  int number_;
};

}  // namespace

tl::expected<void, std::string> write_atomically(const fs::path& file,
                                                 std::span<const std::uint8_t> content) {
  fs::path partial = file;
  partial += fmt::format(".partial-{}", getpid());
  const bool written = Descriptor(partial, O_WRONLY | O_CREAT | O_TRUNC).write_durably(content) &&
                       std::rename(partial.c_str(), file.c_str()) == 0;
  if (!written) {
    const std::string reason = std::strerror(errno);
    std::error_code ignored;
    fs::remove(partial, ignored);
    return tl::unexpected(fmt::format("{}: cannot be written: {}", file.string(), reason));
  }
  // The new name lies in the folder; a file system that cannot sync folders keeps the old or the new name
  // anyway.
  (void)Descriptor(file.has_parent_path() ? file.parent_path() : ".", O_RDONLY | O_DIRECTORY).sync();
  return {};
}

}  // namespace rds::map_file
