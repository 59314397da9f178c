// SPDX-License-Identifier: Apache-2.0
#include "common/store/sqlite.hpp"

#include <sqlite3.h>

namespace rds::store {
namespace {

SqliteError error_of(sqlite3* connection, int code) {
  // The connection's words are those of its last call, which may have been another one.
  const bool is_last = connection != nullptr && (sqlite3_errcode(connection) & 0xFF) == (code & 0xFF);
  return {code & 0xFF, is_last ? sqlite3_errmsg(connection) : sqlite3_errstr(code)};
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

Statement::Statement(sqlite3* connection, std::string_view sql) : connection_(connection) {
  sqlite3_stmt* statement = nullptr;
  fault_ = sqlite3_prepare_v2(connection, sql.data(), static_cast<int>(sql.size()), &statement, nullptr);
  statement_.reset(statement);
}

Statement& Statement::bind(int place, std::string_view text) {
  if (fault_ == SQLITE_OK)
    fault_ =
        sqlite3_bind_text64(statement_.get(), place, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
  return *this;
}

Statement& Statement::bind(int place, std::uint64_t number) {
  if (fault_ == SQLITE_OK)
    fault_ = sqlite3_bind_int64(statement_.get(), place, static_cast<sqlite3_int64>(number));
  return *this;
}

Statement& Statement::bind(int place, std::span<const std::uint8_t> bytes) {
  const void* data = bytes.empty() ? "" : static_cast<const void*>(bytes.data());  // nullptr would be NULL
  if (fault_ == SQLITE_OK)
    fault_ = sqlite3_bind_blob64(statement_.get(), place, data, bytes.size(), SQLITE_STATIC);
  return *this;
}

SqliteResult<bool> Statement::step() {
  const int code = fault_ == SQLITE_OK ? sqlite3_step(statement_.get()) : fault_;
  if (code == SQLITE_ROW || code == SQLITE_DONE) return code == SQLITE_ROW;
  return tl::unexpected(error_of(connection_, code));
}

SqliteResult<void> Statement::run() {
  auto more = step();
  while (more && *more) more = step();
  if (statement_) sqlite3_reset(statement_.get());
  if (!more) return tl::unexpected(more.error());
  return {};
}

std::string_view Statement::text(int column) const {
  const auto* start = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return start == nullptr
             ? std::string_view()
             : std::string_view(start,
                                static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)));
}

std::uint64_t Statement::number(int column) const {
  return static_cast<std::uint64_t>(sqlite3_column_int64(statement_.get(), column));
}

std::span<const std::uint8_t> Statement::blob(int column) const {
  const auto* start = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_.get(), column));
  return {start,
          start == nullptr ? 0 : static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

void Connection::Close::operator()(sqlite3* connection) const {
  sqlite3_close_v2(connection);
}

SqliteResult<Connection> Connection::open(const std::string& file) {
  return open(file,
              SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOFOLLOW | SQLITE_OPEN_FULLMUTEX);
}

SqliteResult<Connection> Connection::open_to_read(const std::string& file) {
  auto opened = open(file, SQLITE_OPEN_READONLY | SQLITE_OPEN_FULLMUTEX);
  if (!opened) return opened;
  sqlite3_db_config(opened->get(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(opened->get(), SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  return opened;
}

SqliteResult<Connection> Connection::open(const std::string& file, int flags) {
  Connection opened;
  sqlite3* connection = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &connection, flags, nullptr);
  opened.connection_.reset(connection);
  if (code != SQLITE_OK) return tl::unexpected(error_of(connection, code));
  return opened;
}

SqliteResult<void> Connection::run(const std::string& sql) const {
  const int code = sqlite3_exec(connection_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return tl::unexpected(error_of(connection_.get(), code));
  return {};
}

SqliteResult<std::uint64_t> Connection::number(std::string_view sql) const {
  Statement statement = prepare(sql);
  const auto row = statement.step();
  if (!row) return tl::unexpected(row.error());
  return *row ? statement.number(0) : 0;
}

SqliteError Connection::last_error() const {
  return error_of(connection_.get(), sqlite3_errcode(connection_.get()));
}

}  // namespace rds::store
