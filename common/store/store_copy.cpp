// SPDX-License-Identifier: Apache-2.0
// A copy of a store, made with SQLite's backup.
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include "common/store/store.hpp"

namespace rds::store {
namespace fs = std::filesystem;
namespace {

constexpr int kPagesPerStep = 1024;

/// Copies in steps. @return SQLITE_DONE, or an error; SQLITE_ABORT if it was given up.
int copy_pages(sqlite3* from, sqlite3* to, const std::function<bool()>& go_on) {
  sqlite3_backup* backup = sqlite3_backup_init(to, "main", from, "main");
  if (backup == nullptr) return sqlite3_errcode(to);
  int code = SQLITE_OK;
  while (code == SQLITE_OK) code = go_on() ? sqlite3_backup_step(backup, kPagesPerStep) : SQLITE_ABORT;
  sqlite3_backup_finish(backup);
  return code;
}

/// Waits until the disk has a file, or a folder's names.
bool flush(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  const bool flushed = file >= 0 && ::fsync(file) == 0;
  if (file >= 0) ::close(file);
  return flushed;
}

}  // namespace

tl::expected<void, std::string> Store::copy_to(const fs::path& file,
                                               const std::function<bool()>& go_on) const {
  std::error_code error;
  std::error_code ignored;
  const fs::path folder = fs::canonical(file.parent_path(), error);
  if (error) return tl::unexpected(fmt::format("{}: cannot be written: {}", file.string(), error.message()));
  const fs::path partial = folder / (file.filename().string() + ".partial");
  const auto refuse = [&](const std::string& why) {
    fs::remove(partial, ignored);
    return tl::unexpected(fmt::format("{}: cannot be written: {}", file.string(), why));
  };
  fs::remove(partial, ignored);
  // The file is then not older than the copy, whatever becomes of its journal.
  if (const auto settled = connection_.run("PRAGMA wal_checkpoint(TRUNCATE);"); !settled)
    return refuse(settled.error().words);
  {
    const auto copy = Connection::open(partial.string());
    if (!copy) return refuse(copy.error().words);
    (void)copy->run("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;");
    const int code = copy_pages(connection_.get(), copy->get(), go_on);
    if (code != SQLITE_DONE) return refuse(sqlite3_errstr(code));
  }
  if (!flush(partial) || ::rename(partial.c_str(), (folder / file.filename()).c_str()) != 0)
    return refuse(std::strerror(errno));
  (void)flush(folder);
  return {};
}

}  // namespace rds::store
