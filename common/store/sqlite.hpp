// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

struct sqlite3;
struct sqlite3_stmt;

namespace rds::store {

/// An error of SQLite: its code (SQLITE_FULL …) and its words.
struct SqliteError {
  int code = 0;
  std::string words;
};

template <class T>
using SqliteResult = tl::expected<T, SqliteError>;

/// One statement of SQL on its way through its rows.
class Statement {
 public:
  Statement(sqlite3* connection, std::string_view sql);

  Statement& bind(int place, std::string_view text);
  Statement& bind(int place, std::uint64_t number);
  Statement& bind(int place, std::span<const std::uint8_t> bytes);

  /// @return true on a row, false after the last one.
  SqliteResult<bool> step();
  /// Runs it to its end, and makes it ready for the next time.
  SqliteResult<void> run();
  /// Of the present row; what it holds is valid until the next step.
  [[nodiscard]] std::string_view text(int column) const;
  [[nodiscard]] std::uint64_t number(int column) const;
  [[nodiscard]] std::span<const std::uint8_t> blob(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  sqlite3* connection_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int fault_;  // of making or binding it; the next step returns it
};

/// A connection to a file.
class Connection {
 public:
  /// @param file  made if it is not there; links are not followed.
  static SqliteResult<Connection> open(const std::string& file);
  /// A file of somebody else, links followed: it is not changed, and none of its views and triggers is
  /// trusted.
  static SqliteResult<Connection> open_to_read(const std::string& file);

  [[nodiscard]] Statement prepare(std::string_view sql) const { return {connection_.get(), sql}; }
  /// Statements without results.
  [[nodiscard]] SqliteResult<void> run(const std::string& sql) const;
  /// The number that a PRAGMA or SELECT gives first.
  [[nodiscard]] SqliteResult<std::uint64_t> number(std::string_view sql) const;
  [[nodiscard]] sqlite3* get() const { return connection_.get(); }
  [[nodiscard]] SqliteError last_error() const;

 private:
  static SqliteResult<Connection> open(const std::string& file, int flags);
  struct Close {
    void operator()(sqlite3* connection) const;
  };
  std::unique_ptr<sqlite3, Close> connection_;
};

}  // namespace rds::store
