// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/bag/db3_bag_writer.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace rds::recording {
namespace {

constexpr int kMetadataVersion = 8;  // policies as numbers
constexpr const char* kTables =
    "PRAGMA journal_mode = MEMORY;"
    "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
    "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT "
    "NULL);"
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
    " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT "
    "NULL);"
    "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT "
    "NULL,"
    " encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,"
    " data BLOB NOT NULL);"
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
    "INSERT INTO schema VALUES (4, 'rds-slam');"
    "BEGIN";

}  // namespace

tl::expected<std::unique_ptr<BagWriter>, std::string> Db3BagWriter::make(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  auto connection = store::Connection::open(file.string());
  if (!connection)
    return tl::unexpected(fmt::format("{}: cannot be written: {}", file.string(), connection.error().words));
  if (const auto made = connection->run(kTables); !made)
    return tl::unexpected(fmt::format("{}: cannot be written: {}", file.string(), made.error().words));
  return std::unique_ptr<BagWriter>(new Db3BagWriter(file, std::move(*connection)));
}

Db3BagWriter::Db3BagWriter(std::filesystem::path file, store::Connection connection)
    : file_(std::move(file)),
      connection_(std::move(connection)),
      insert_(connection_.prepare("INSERT INTO messages(topic_id, timestamp, data) VALUES (?1, ?2, ?3)")) {}

BagWriter::Result Db3BagWriter::in_words(store::SqliteResult<void> result) const {
  if (result) return {};
  return tl::unexpected(fmt::format("{}: cannot be written: {}", file_.string(), result.error().words));
}

tl::expected<std::size_t, std::string> Db3BagWriter::add_topic(const BagTopic& topic) {
  auto insert = connection_.prepare("INSERT INTO topics VALUES (?1, ?2, ?3, ?4, ?5, ?6)");
  insert.bind(1, std::uint64_t{topics_.size() + 1}).bind(2, std::string_view(topic.name));
  insert.bind(3, std::string_view(topic.type)).bind(4, std::string_view(topic.encoding));
  insert.bind(5, std::string_view(topic.qos)).bind(6, std::string_view(topic.type_hash));
  if (const auto done = in_words(insert.run()); !done) return tl::unexpected(done.error());
  if (const auto done = write_definition(topic); !done) return tl::unexpected(done.error());
  topics_.push_back({topic});
  return topics_.size() - 1;
}

BagWriter::Result Db3BagWriter::write_definition(const BagTopic& topic) {
  if (topic.definition.empty() || !defined_.insert(topic.type).second) return {};
  auto insert = connection_.prepare(
      "INSERT INTO message_definitions(topic_type, encoding, encoded_message_definition, "
      "type_description_hash)"
      " VALUES (?1, ?2, ?3, ?4)");
  insert.bind(1, std::string_view(topic.type)).bind(2, std::string_view(topic.definition_encoding));
  insert.bind(3, std::string_view(topic.definition)).bind(4, std::string_view(topic.type_hash));
  return in_words(insert.run());
}

BagWriter::Result Db3BagWriter::write(std::size_t topic, const BagMessage& message) {
  ++topics_.at(topic).messages;
  first_ns_ = messages_ == 0 ? message.log_time_ns : std::min(first_ns_, message.log_time_ns);
  last_ns_ = messages_ == 0 ? message.log_time_ns : std::max(last_ns_, message.log_time_ns);
  ++messages_;
  insert_.bind(1, std::uint64_t{topic + 1}).bind(2, static_cast<std::uint64_t>(message.log_time_ns));
  return in_words(insert_.bind(3, message.data).run());
}

BagWriter::Result Db3BagWriter::flush() {
  return in_words(connection_.run("COMMIT; BEGIN"));
}

/// rosbag2's metadata.yaml of this file.
std::string Db3BagWriter::metadata() const {
  YAML::Emitter yaml;
  const auto time = [&](const char* key, const char* unit, std::int64_t value) {
    yaml << YAML::Key << key << YAML::Value << YAML::BeginMap << YAML::Key << unit << YAML::Value << value
         << YAML::EndMap;
  };
  const auto entry = [&](const char* key, const auto& value) {
    yaml << YAML::Key << key << YAML::Value << value;
  };
  const std::string name = file_.filename().string();
  yaml << YAML::BeginMap;
  entry("version", kMetadataVersion);
  entry("storage_identifier", "sqlite3");
  time("duration", "nanoseconds", last_ns_ - first_ns_);
  time("starting_time", "nanoseconds_since_epoch", first_ns_);
  entry("message_count", messages_);
  yaml << YAML::Key << "topics_with_message_count" << YAML::Value << YAML::BeginSeq;
  for (const auto& [topic, messages] : topics_) {
    yaml << YAML::BeginMap << YAML::Key << "topic_metadata" << YAML::Value << YAML::BeginMap;
    entry("name", topic.name);
    entry("type", topic.type);
    entry("serialization_format", topic.encoding);
    entry("offered_qos_profiles", topic.qos);
    entry("type_description_hash", topic.type_hash);
    yaml << YAML::EndMap;
    entry("message_count", messages);
    yaml << YAML::EndMap;
  }
  yaml << YAML::EndSeq;
  entry("compression_format", "");
  entry("compression_mode", "");
  yaml << YAML::Key << "relative_file_paths" << YAML::Value << YAML::BeginSeq << name << YAML::EndSeq;
  yaml << YAML::Key << "files" << YAML::Value << YAML::BeginSeq << YAML::BeginMap;
  entry("path", name);
  time("starting_time", "nanoseconds_since_epoch", first_ns_);
  time("duration", "nanoseconds", last_ns_ - first_ns_);
  entry("message_count", messages_);
  yaml << YAML::EndMap << YAML::EndSeq;
  entry("ros_distro", "rds-slam");
  yaml << YAML::EndMap;
  return yaml.c_str();
}

BagWriter::Result Db3BagWriter::finish() {
  auto insert = connection_.prepare("INSERT INTO metadata(metadata_version, metadata) VALUES (?1, ?2)");
  const std::string text = metadata();
  insert.bind(1, std::uint64_t{kMetadataVersion}).bind(2, std::string_view(text));
  if (const auto done = in_words(insert.run()); !done) return done;
  return in_words(connection_.run("COMMIT"));
}

}  // namespace rds::recording
