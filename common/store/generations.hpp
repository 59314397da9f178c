// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/store/store.hpp"

namespace rds::store {

/// NAME.previous.db, NAME.damaged.db and NAME.lock beside NAME.db.
std::filesystem::path previous_of(const std::filesystem::path& file);
std::filesystem::path damaged_of(const std::filesystem::path& file);
std::filesystem::path lock_of(const std::filesystem::path& file);

/// A lock on a file that is held until the object, or the process, goes.
class FileLock {
 public:
  /// @return or one sentence naming the file: another process has it, or it cannot be made.
  static tl::expected<FileLock, std::string> take(const std::filesystem::path& file);
  FileLock(FileLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock();

 private:
  explicit FileLock(int file) : file_(file) {}
  int file_;
};

/// The checkpoint of a service: a store, the one before it, and a lock that keeps other processes out.
struct Checkpoint {
  FileLock lock;
  std::filesystem::path file;
  Store store;
  std::vector<std::string> found;  // what the log should say: which store is used, and what was wrong

  /// Replaces the previous store by a copy of this one.
  [[nodiscard]] tl::expected<void, std::string> keep_previous(const std::function<bool()>& go_on = [] {
    return true;
  }) const {
    return store.copy_to(previous_of(file), go_on);
  }
};

/// Opens the last good one of a checkpoint's stores: the newest, else the previous one. The newest is then
/// moved aside, one only. Where there is none, or none is good, a new one begins.
///
/// @return or one sentence: another process uses it, the folder cannot be made or written to; or the newest
/// is foreign or of a later version and no previous one is good: then it is left alone.
tl::expected<Checkpoint, std::string> open_checkpoint(const std::filesystem::path& file,
                                                      std::uint64_t max_bytes = 0);

}  // namespace rds::store
