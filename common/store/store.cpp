// SPDX-License-Identifier: Apache-2.0
#include "common/store/store.hpp"

#include <array>
#include <bit>
#include <cstdlib>

#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include "common/map_file/checksum.hpp"

namespace rds::store {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kApplication = 0x52445331;  // "RDS1"
constexpr std::uint64_t kPageBytes = 4096;
// With row ids: WITHOUT ROWID (older files) a search reads whole rows to compare their keys.
constexpr const char* kTables =
    "CREATE TABLE rows (kind TEXT NOT NULL, id INTEGER NOT NULL, checksum INTEGER NOT NULL, bytes BLOB NOT "
    "NULL,"
    " PRIMARY KEY (kind, id));"
    "CREATE TABLE manifest (one INTEGER PRIMARY KEY, rows INTEGER, digest INTEGER, checksum INTEGER);";

std::array<std::uint8_t, 8> raw(std::uint64_t number) {
  return std::bit_cast<std::array<std::uint8_t, 8>>(number);
}

/// Of a row: kind, id and bytes.
std::uint64_t checksum_of(std::string_view kind, std::uint64_t id, std::span<const std::uint8_t> bytes) {
  const auto* letters = reinterpret_cast<const std::uint8_t*>(kind.data());
  const std::uint64_t of_kind = map_file::checksum_of({letters, kind.size()});
  return map_file::checksum_of(bytes, map_file::checksum_of(raw(id), of_kind));
}

std::uint64_t checksum_of_manifest(std::uint64_t rows, std::uint64_t digest) {
  return checksum_of("manifest", rows, raw(digest));
}

Fault::Kind kind_of(const SqliteError& error) {
  if (error.code == SQLITE_NOTADB) return Fault::Kind::kForeign;
  const bool damaged = error.code == SQLITE_CORRUPT || error.code == SQLITE_FORMAT ||
                       error.code == SQLITE_ERROR || error.code == SQLITE_READONLY;
  return damaged ? Fault::Kind::kDamaged : Fault::Kind::kUnavailable;
}

/// With its folder's links followed: SQLite allows none.
tl::expected<fs::path, Fault> without_links(const fs::path& file) {
  std::error_code error;
  const fs::path folder = fs::canonical(file.has_parent_path() ? file.parent_path() : ".", error);
  if (error)
    return tl::unexpected(
        Fault{Fault::Kind::kUnavailable, fmt::format("{}: {}", file.string(), error.message())});
  const auto type = fs::symlink_status(folder / file.filename(), error).type();
  if (type != fs::file_type::regular && type != fs::file_type::not_found)
    return tl::unexpected(
        Fault{Fault::Kind::kForeign,
              fmt::format("{}: is no regular file, expected a store of maps", file.string())});
  return folder / file.filename();
}

}  // namespace

std::string Store::say(const std::string& what) const {
  return fmt::format("{}: {}", file_.string(), what);
}

tl::expected<Store, Fault> Store::open(const fs::path& file, std::uint64_t max_bytes) {
  const auto place = without_links(file);
  if (!place) return tl::unexpected(place.error());
  auto connection = Connection::open(place->string());
  const auto refuse = [&](const SqliteError& error) {
    return tl::unexpected(Fault{kind_of(error), fmt::format("{}: {}", file.string(), error.words)});
  };
  if (!connection) return refuse(connection.error());
  Store store(std::move(*connection), file);
  if (const auto fault = store.identify()) return tl::unexpected(*fault);
  if (const auto done = store.set_up(max_bytes); !done) return refuse(done.error());
  if (const auto damage = store.verify())
    return tl::unexpected(Fault{Fault::Kind::kDamaged, store.say("is damaged: " + *damage)});
  return store;
}

/// Looks at nothing but whose file it is.
std::optional<Fault> Store::identify() const {
  if (const auto locked = connection_.run("PRAGMA locking_mode = EXCLUSIVE;"); !locked)
    return Fault{kind_of(locked.error()), say(locked.error().words)};
  const auto application = connection_.number("PRAGMA application_id");
  const auto version = connection_.number("PRAGMA user_version");
  const auto tables = connection_.number("SELECT count(*) FROM sqlite_schema");
  for (const auto* read : {&application, &version, &tables})
    if (!*read) return Fault{kind_of(read->error()), say(read->error().words)};
  if (*tables == 0 && *application == 0) return std::nullopt;  // a new one
  if (*application != kApplication)
    return Fault{Fault::Kind::kForeign, say("is the database of another program, expected a store of maps")};
  if (*version > kStoreVersion)
    return Fault{Fault::Kind::kNewer,
                 say(fmt::format("has format version {}, expected at most {}", *version, kStoreVersion))};
  return std::nullopt;
}

Store::Result Store::set_up(std::uint64_t max_bytes) const {
  const std::string limit =
      max_bytes == 0 ? "" : fmt::format("PRAGMA max_page_count = {};", max_bytes / kPageBytes);
  // The journal must not stay as large as the largest batch was.
  if (auto done = connection_.run("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;"
                                  "PRAGMA journal_size_limit = 16000000;" +
                                  limit);
      !done)
    return done;
  const auto tables = connection_.number("SELECT count(*) FROM sqlite_schema");
  if (!tables) return tl::unexpected(tables.error());
  if (*tables == 0) return make_tables();
  return connection_.run("BEGIN IMMEDIATE; ROLLBACK;");  // fails where it cannot be written to
}

Store::Result Store::make_tables() const {
  if (auto made =
          connection_.run(fmt::format("BEGIN; PRAGMA application_id = {}; PRAGMA user_version = {}; {}",
                                      kApplication, kStoreVersion, kTables));
      !made)
    return made;
  if (auto written = write_manifest({}); !written) return written;
  return connection_.run("COMMIT;");
}

tl::expected<Store, Fault> Store::nameless(const fs::path& folder) {
  std::error_code error;
  const fs::path place = fs::canonical(folder.empty() ? fs::temp_directory_path(error) : folder, error);
  std::string name = (place / "rds-store-XXXXXX").string();
  const int made = error ? -1 : ::mkostemp(name.data(), O_CLOEXEC);
  if (made < 0)
    return tl::unexpected(Fault{Fault::Kind::kUnavailable,
                                fmt::format("{}: no temporary file can be made there", folder.string())});
  ::close(made);
  auto connection = Connection::open(name);
  ::unlink(name.c_str());
  if (!connection)
    return tl::unexpected(Fault{Fault::Kind::kUnavailable, name + ": " + connection.error().words});
  Store store(std::move(*connection), "the temporary file in " + place.string());
  auto done = store.connection_.run(
      "PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = MEMORY;"
      "PRAGMA synchronous = OFF;");
  if (done) done = store.make_tables();
  if (!done) return tl::unexpected(Fault{Fault::Kind::kUnavailable, store.say(done.error().words)});
  return store;
}

/// Reads everything. @return what is wrong.
std::optional<std::string> Store::verify() {
  auto check = connection_.prepare("PRAGMA integrity_check(1)");
  const auto checked = check.step();
  if (!checked) return checked.error().words;
  if (check.text(0) != "ok") return std::string(check.text(0));
  auto manifest = connection_.prepare("SELECT rows, digest, checksum FROM manifest WHERE one = 1");
  const auto there = manifest.step();
  if (!there) return there.error().words;
  if (!*there) return "it has no manifest";
  manifest_ = {manifest.number(0), manifest.number(1)};
  if (checksum_of_manifest(manifest_.rows, manifest_.digest) != manifest.number(2))
    return "its manifest has another checksum";
  Manifest found;
  auto rows = connection_.prepare(
      "SELECT kind, id, checksum, bytes, typeof(kind) = 'text' AND typeof(id) = 'integer' FROM rows");
  auto more = rows.step();
  for (; more && *more; more = rows.step()) {
    const std::uint64_t checksum = checksum_of(rows.text(0), rows.number(1), rows.blob(3));
    if (checksum != rows.number(2) || rows.number(4) == 0)
      return fmt::format("row {} of '{}' has another checksum", rows.number(1), rows.text(0));
    ++found.rows;
    found.digest += checksum;
  }
  if (!more) return more.error().words;
  if (found.rows != manifest_.rows) return fmt::format("it has {} rows of {}", found.rows, manifest_.rows);
  if (found.digest != manifest_.digest) return "rows are of different moments";
  return std::nullopt;
}

Store::Result Store::write_manifest(const Manifest& manifest) const {
  return connection_.prepare("INSERT OR REPLACE INTO manifest VALUES (1, ?1, ?2, ?3)")
      .bind(1, manifest.rows)
      .bind(2, manifest.digest)
      .bind(3, checksum_of_manifest(manifest.rows, manifest.digest))
      .run();
}

tl::expected<void, std::string> Store::apply(const Batch& batch) {
  const Manifest before = manifest_;
  Result done = connection_.run("BEGIN IMMEDIATE;");
  if (done) done = change(batch);
  if (done) done = connection_.run("COMMIT;");
  if (done) return {};
  manifest_ = before;
  (void)connection_.run("ROLLBACK;");  // SQLite may have done so itself
  return tl::unexpected(say(done.error().words));
}

/// Inside a transaction.
Store::Result Store::change(const Batch& batch) {
  if (batch.clears()) {
    if (auto done = connection_.run("DELETE FROM rows;"); !done) return done;
    manifest_ = {};
  }
  bool changed = batch.clears();
  auto look = connection_.prepare("SELECT checksum FROM rows WHERE kind = ?1 AND id = ?2");
  auto put = connection_.prepare("INSERT OR REPLACE INTO rows VALUES (?1, ?2, ?3, ?4)");
  auto erase = connection_.prepare("DELETE FROM rows WHERE kind = ?1 AND id = ?2");
  for (const auto& [key, bytes] : batch.rows()) {
    const auto there = look.bind(1, key.kind).bind(2, key.id).step();
    if (!there) return tl::unexpected(there.error());
    const std::uint64_t old = *there ? look.number(0) : 0;
    if (auto done = look.run(); !done) return done;
    const std::uint64_t checksum = bytes ? checksum_of(key.kind, key.id, *bytes) : 0;
    if (bytes ? *there && old == checksum : !*there) continue;
    Result done = bytes ? put.bind(1, key.kind).bind(2, key.id).bind(3, checksum).bind(4, *bytes).run()
                        : erase.bind(1, key.kind).bind(2, key.id).run();
    if (!done) return done;
    manifest_.rows = manifest_.rows + (bytes ? 1 : 0) - (*there ? 1 : 0);
    manifest_.digest += checksum - old;
    changed = true;
  }
  return changed ? write_manifest(manifest_) : Result();
}

tl::expected<std::optional<Bytes>, std::string> Store::get(std::string_view kind, std::uint64_t id) const {
  auto row = connection_.prepare("SELECT checksum, bytes FROM rows WHERE kind = ?1 AND id = ?2");
  const auto there = row.bind(1, kind).bind(2, id).step();
  if (!there) return tl::unexpected(say(there.error().words));
  if (!*there) return std::nullopt;
  const auto bytes = row.blob(1);
  if (checksum_of(kind, id, bytes) != row.number(0))
    return tl::unexpected(say(fmt::format("row {} of '{}' has another checksum", id, kind)));
  return Bytes(bytes.begin(), bytes.end());
}

tl::expected<void, std::string> Store::for_each(std::string_view kind, const Visit& visit) const {
  auto rows = connection_.prepare("SELECT id, checksum, bytes FROM rows WHERE kind = ?1 ORDER BY id");
  rows.bind(1, kind);
  auto more = rows.step();
  for (; more && *more; more = rows.step()) {
    if (checksum_of(kind, rows.number(0), rows.blob(2)) != rows.number(1))
      return tl::unexpected(say(fmt::format("row {} of '{}' has another checksum", rows.number(0), kind)));
    visit(rows.number(0), rows.blob(2));
  }
  if (!more) return tl::unexpected(say(more.error().words));
  return {};
}

}  // namespace rds::store
