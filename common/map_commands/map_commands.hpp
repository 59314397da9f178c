// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include <tl/expected.hpp>

#include "common/concurrency/mailbox.hpp"
#include "common/map_file/folder.hpp"
#include "common/map_file/joint_save.hpp"
#include "common/service/service.hpp"
#include "common/store/maps_folder.hpp"

namespace rds::map_commands {

/// Of files of saved maps, as configured.
inline map_file::FileLimits limits_of(const store::MapsConfig& config) {
  return {.max_bytes = config.max_map_mb * 1'000'000};
}

/// The commands `save` and `load` of a service that has a part of the map.
///
/// A thread of its own touches the disk, so that the worker goes on meanwhile; it does one command at a time,
/// others are answered "busy". A command that is not done after `limit` is answered then, and what comes of
/// it later is thrown away.
class MapCommands {
 public:
  /// Puts what was read in place of the map, on the worker. @return the answer to `load`.
  using Completion = std::function<service::CommandOutcome()>;
  /// Reads and parses a map, on the thread. @return or one sentence.
  using Read = std::function<tl::expected<Completion, std::string>(const map_file::Folder&,
                                                                   const map_file::FileLimits&)>;

  static constexpr std::chrono::seconds kLimit{60};

  /// @param worker  the mailbox that the service's worker waits on. @param own_part  one of map_file::kParts.
  MapCommands(concurrency::Mailbox& worker, const store::MapsConfig& config, std::string own_part,
              std::chrono::milliseconds limit = kLimit);
  /// Breaks off what is under way, and answers that.
  ~MapCommands();
  MapCommands(const MapCommands&) = delete;
  MapCommands& operator=(const MapCommands&) = delete;

  /// On the worker. @param make  makes the part, at once; @param what  says what is in it, for the answer.
  void save(const service::PendingCommand& command, const std::function<map_file::MapPart()>& make,
            const std::string& what);
  /// On the worker. @param command  its argument is the name of a map.
  void load(const service::PendingCommand& command, Read read);

  /// Whether the worker has something to settle; for Mailbox::wait's condition only.
  [[nodiscard]] bool locked_ready() const;
  /// On the worker: completes what was read, and answers what is done or overdue.
  void settle();

 private:
  using Clock = std::chrono::steady_clock;
  using Job = std::function<Completion(const map_file::FileLimits&)>;
  struct Order {
    std::uint64_t number;
    Clock::time_point deadline;
    Job job;
  };
  struct Done {
    std::uint64_t number;
    Completion complete;
  };
  struct UnderWay {
    std::uint64_t number;
    Clock::time_point deadline;
    std::function<void(const service::CommandOutcome&)> answer;
  };

  void start(const service::PendingCommand& command, Job job);
  [[nodiscard]] Completion carry_out(const Order& order, const std::stop_token& stop) const;

  store::MapsConfig config_;
  std::string own_part_;
  std::chrono::milliseconds limit_;
  std::uint64_t started_ = 0;
  std::uint64_t settled_ = 0;          // of started_: less while the thread is at work
  std::optional<UnderWay> under_way_;  // until it is answered
  concurrency::Inbox<Done> done_;      // the worker waits on it
  concurrency::Mailbox mailbox_;       // the thread's
  concurrency::Inbox<Order> orders_;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::map_commands
