// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/bag/db3_bag.hpp"

#include <fmt/format.h>

namespace rds::recording {
namespace {

using store::Connection;

/// Whether a table, not a view of it, has this column.
bool has_column(const Connection& connection, std::string_view table, std::string_view column) {
  auto statement = connection.prepare(
      "SELECT count(*) FROM sqlite_master m JOIN pragma_table_info(m.name) c "
      "WHERE m.type = 'table' AND m.name = ?1 AND c.name = ?2");
  const auto row = statement.bind(1, table).bind(2, column).step();
  return row && *row && statement.number(0) > 0;
}

}  // namespace

std::string Db3Bag::sentence(const store::SqliteError& error) const {
  return fmt::format("{}: cannot be read as SQLite: {}", file_.string(), error.words);
}

tl::expected<std::unique_ptr<Bag>, std::string> Db3Bag::open(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    return tl::unexpected(fmt::format("{}: no such file", file.string()));
  auto connection = Connection::open_to_read(file.string());
  if (!connection)
    return tl::unexpected(fmt::format("{}: cannot be read: {}", file.string(), connection.error().words));
  std::unique_ptr<Db3Bag> bag(new Db3Bag(file, std::move(*connection)));
  if (const auto read = bag->read_topics(); !read) return tl::unexpected(read.error());
  bag->read_definitions();
  return bag;
}

tl::expected<void, std::string> Db3Bag::read_topics() {
  if (const auto schema = connection_.number("SELECT count(*) FROM sqlite_master"); !schema)
    return tl::unexpected(sentence(schema.error()));
  if (!has_column(connection_, "topics", "serialization_format") ||
      !has_column(connection_, "messages", "data"))
    return tl::unexpected(
        fmt::format("{}: no recording of rosbag2, expected its tables topics and messages", file_.string()));
  const auto column = [&](const char* name) {
    return has_column(connection_, "topics", name) ? name : "''";  // of younger versions
  };
  auto rows =
      connection_.prepare(fmt::format("SELECT id, name, type, serialization_format, {}, {} FROM topics",
                                      column("offered_qos_profiles"), column("type_description_hash")));
  auto row = rows.step();
  for (; row && *row; row = rows.step())
    topics_[rows.number(0)] = {.name = std::string(rows.text(1)),
                               .type = std::string(rows.text(2)),
                               .encoding = std::string(rows.text(3)),
                               .qos = std::string(rows.text(4)),
                               .type_hash = std::string(rows.text(5))};
  if (!row) return tl::unexpected(sentence(row.error()));
  return {};
}

/// Younger versions have them; without them a type is known by its name.
void Db3Bag::read_definitions() {
  if (!has_column(connection_, "message_definitions", "encoded_message_definition")) return;
  auto rows =
      connection_.prepare("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions");
  for (auto row = rows.step(); row && *row; row = rows.step())
    for (auto& [id, topic] : topics_)
      if (topic.type == rows.text(0)) {
        topic.definition_encoding = std::string(rows.text(1));
        topic.definition = std::string(rows.text(2));
      }
}

tl::expected<BagScan, std::string> Db3Bag::scan(const Visit& visit) {
  BagScan scan;
  auto rows =
      connection_.prepare("SELECT id, topic_id, timestamp, data FROM messages ORDER BY timestamp, id");
  auto row = rows.step();
  for (; row && *row; row = rows.step()) {
    const auto topic = topics_.find(rows.number(1));
    if (topic == topics_.end()) {
      scan.fault = fmt::format("{}: has messages of a topic that it does not describe", file_.string());
      continue;
    }
    ++scan.messages;
    const auto stamp = static_cast<std::int64_t>(rows.number(2));
    visit(topic->second, {stamp, stamp, rows.blob(3)}, {.record = rows.number(0)});
  }
  if (!row) scan.fault = sentence(row.error());
  return scan;
}

tl::expected<Bytes, std::string> Db3Bag::data_at(const BagPlace& place) const {
  auto statement = connection_.prepare("SELECT data FROM messages WHERE id = ?1");
  const auto row = statement.bind(1, place.record).step();
  if (!row) return tl::unexpected(sentence(row.error()));
  const auto data = *row ? statement.blob(0) : std::span<const std::uint8_t>();
  return Bytes(data.begin(), data.end());
}

}  // namespace rds::recording
