// SPDX-License-Identifier: Apache-2.0
#include "common/store/generations.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "common/store/maps_folder.hpp"

namespace rds::store {
namespace fs = std::filesystem;
namespace {

fs::path sibling(const fs::path& file, const std::string& ending) {
  return file.parent_path() / (file.stem().string() + ending);
}

fs::path journal_of(const fs::path& file) {
  return file.string() + "-wal";
}

/// The file with its journal, which belongs to it.
void move_aside(const fs::path& file) {
  std::error_code ignored;
  for (const fs::path& old : {damaged_of(file), journal_of(damaged_of(file))}) fs::remove_all(old, ignored);
  fs::rename(file, damaged_of(file), ignored);
  fs::rename(journal_of(file), journal_of(damaged_of(file)), ignored);
}

/// A copy of the previous store in the place of the newest. @return false if there is no good one.
bool take_previous(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(previous_of(file), ignored))) return false;
  const auto previous = Store::open(previous_of(file));
  if (!previous) return false;
  move_aside(file);
  fs::remove(journal_of(file), ignored);
  return previous->copy_to(file).has_value();
}

}  // namespace

fs::path previous_of(const fs::path& file) {
  return sibling(file, ".previous.db");
}

fs::path damaged_of(const fs::path& file) {
  return sibling(file, ".damaged.db");
}

fs::path lock_of(const fs::path& file) {
  return sibling(file, ".lock");
}

tl::expected<FileLock, std::string> FileLock::take(const fs::path& file) {
  FileLock lock(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR));
  if (lock.file_ < 0)
    return tl::unexpected(fmt::format("{}: cannot be made: {}", file.string(), std::strerror(errno)));
  if (::flock(lock.file_, LOCK_EX | LOCK_NB) == 0) return lock;
  return tl::unexpected(fmt::format("{}: another process keeps its map there", file.string()));
}

FileLock::~FileLock() {
  if (file_ >= 0) ::close(file_);
}

tl::expected<Checkpoint, std::string> open_checkpoint(const fs::path& file, std::uint64_t max_bytes) {
  if (auto made = make_private_folder(file.parent_path()); !made) return tl::unexpected(made.error());
  auto lock = FileLock::take(lock_of(file));
  if (!lock) return tl::unexpected(lock.error());
  std::vector<std::string> found;
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(file, ignored)) && take_previous(file))
    found.push_back(fmt::format("{}: is missing, the previous one is used", file.string()));
  auto store = Store::open(file, max_bytes);
  if (!store && store.error().kind == Fault::Kind::kUnavailable)
    return tl::unexpected(store.error().sentence);
  if (!store) {
    const Fault fault = store.error();
    if (take_previous(file)) {
      found.push_back(fmt::format("{}; the previous one is used", fault.sentence));
    } else if (fault.kind == Fault::Kind::kDamaged) {
      move_aside(file);
      found.push_back(fmt::format("{}; there is no previous one that is good", fault.sentence));
    } else {
      return tl::unexpected(fault.sentence);
    }
    store = Store::open(file, max_bytes);
    if (!store) return tl::unexpected(store.error().sentence);
  }
  return Checkpoint{std::move(*lock), file, std::move(*store), std::move(found)};
}

}  // namespace rds::store
