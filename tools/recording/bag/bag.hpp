// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace rds::recording {

using Bytes = std::vector<std::uint8_t>;

/// A topic as a bag describes it.
struct BagTopic {
  std::string name = {};                 // "/camera/color/image_raw"
  std::string type = {};                 // "sensor_msgs/msg/Image"
  std::string encoding = "cdr";          // of its messages
  std::string qos = {};                  // offered_qos_profiles, YAML as rosbag2 writes it
  std::string type_hash = {};            // "RIHS01_…"; empty if unknown
  std::string definition_encoding = {};  // of the definition: "ros2msg", "ros2idl"; empty if there is none
  std::string definition = {};
};

struct BagMessage {
  std::int64_t log_time_ns = 0;  // when it was recorded
  std::int64_t publish_time_ns = 0;
  std::span<const std::uint8_t> data = {};  // encapsulation header and CDR
};

/// Where a message lies in its bag.
struct BagPlace {
  std::size_t file = 0;      // of a bag in several files
  std::uint64_t record = 0;  // byte or row
  std::optional<std::uint64_t> in_chunk = {};
};

/// What was found when a bag was read from start to end.
struct BagScan {
  std::uint64_t messages = 0;
  std::string fault = {};  // a sentence if it is torn or in part damaged: then what could be read was visited
};

/// Recorded messages of several topics, in any of the forms that rosbag2 writes.
class Bag {
 public:
  virtual ~Bag() = default;

  using Visit = std::function<void(const BagTopic&, const BagMessage&, const BagPlace&)>;
  /// Visits all messages, in the order of the file or of time.
  /// @return or one sentence that names the file: it is no bag.
  virtual tl::expected<BagScan, std::string> scan(const Visit& visit) = 0;
  /// A message's data again; may be called by several threads. @return or one sentence that names the file.
  [[nodiscard]] virtual tl::expected<Bytes, std::string> data_at(const BagPlace& place) const = 0;
};

/// Opens an MCAP file, a SQLite file of rosbag2 (.db3), or a folder of rosbag2, whose metadata.yaml names its
/// files.
/// @return or one sentence that names the file and what was expected.
tl::expected<std::unique_ptr<Bag>, std::string> open_bag(const std::filesystem::path& path);

/// Whether a path looks like a bag: by its ending, or as a folder by its metadata.yaml.
bool is_bag(const std::filesystem::path& path);

}  // namespace rds::recording
