// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/guid.hpp"
#include "common/bus/participant.hpp"
#include "common/bus/service_type.hpp"

/// What a bus has to provide. Everything else (threads, statistics) is written once, in participant_*.hpp.
namespace rds::bus::detail {

/// Where a back end puts a received message: it hands the bytes to decode() while it holds them, unless the
/// writer is of another version.
struct Sample {
  const TypeOps* type = nullptr;
  void* message = nullptr;
  std::size_t bytes = 0;
  bool decoded = false;
  bool another_version = false;  // not decoded
  ParticipantId writer{};

  void decode(const std::uint8_t* data, std::size_t size) {
    bytes = size;
    decoded = type->decode(data, size, message);
  }
};

class BackendWriter {
 public:
  virtual ~BackendWriter() = default;
  virtual bool write(const void* message) = 0;
  /// Messages that were taken by write() and went nowhere.
  [[nodiscard]] virtual std::uint64_t lost() const { return 0; }
  [[nodiscard]] virtual int matched() const = 0;
  [[nodiscard]] virtual Guid guid() const = 0;
};

class BackendReader {
 public:
  virtual ~BackendReader() = default;
  /// Blocks until take() may find something or wake() was called, once and for all.
  virtual void wait() = 0;
  /// As wait(), but no longer than this. @return false if nothing of that has happened.
  virtual bool wait_for(std::chrono::seconds limit) = 0;
  virtual void wake() = 0;
  /// Takes the next message into `sample`. @return false if there is none.
  virtual bool take(Sample& sample) = 0;
  /// Messages the bus knows that it did not deliver.
  [[nodiscard]] virtual std::uint64_t lost() const = 0;
  [[nodiscard]] virtual int matched() const = 0;
  [[nodiscard]] virtual Guid guid() const = 0;
};

/// Where the answer to a request goes.
struct Caller {
  Guid client{};                // as replies name it: by the bus's own convention
  std::int64_t request = 0;     // his number of it
  ParticipantId participant{};  // that he belongs to
};

/// The serving side of a service: a reader of requests and a writer of replies.
class BackendService {
 public:
  virtual ~BackendService() = default;
  /// As those of a BackendReader.
  virtual void wait() = 0;
  virtual void wake() = 0;
  /// Takes the next request into `sample`. @return false if there is none.
  virtual bool take(Sample& sample, Caller& caller) = 0;
  /// Any thread; waits for a moment until the caller's reader is known. @return false if it is not there.
  virtual bool reply(const Caller& caller, const void* response) = 0;
  /// Requests the bus knows that it did not deliver.
  [[nodiscard]] virtual std::uint64_t lost() const = 0;
  [[nodiscard]] virtual Guid request_reader() const = 0;
  [[nodiscard]] virtual Guid reply_writer() const = 0;
};

/// One participant on a bus; outlives its readers and writers. Every creation throws BusError.
class Backend {
 public:
  virtual ~Backend() = default;
  virtual std::unique_ptr<BackendWriter> make_writer(const std::string& topic, const TypeOps& type,
                                                     const Qos& qos) = 0;
  virtual std::unique_ptr<BackendReader> make_reader(const std::string& topic, const TypeOps& type,
                                                     const Qos& qos) = 0;
  /// @param name  of ROS, in full, without a leading slash.
  virtual std::unique_ptr<BackendService> make_service(const std::string& name, const ServiceType& type) = 0;
  [[nodiscard]] virtual Guid guid() const = 0;
  /// Endpoints of all other participants.
  [[nodiscard]] virtual std::vector<DiscoveredEndpoint> discovered() const = 0;
};

// Plain DDS: topic names are DDS names ("rt/rds/odometry").
std::unique_ptr<Backend> make_fastdds_backend(const ParticipantOptions& options);
std::unique_ptr<Backend> make_cyclonedds_backend(const ParticipantOptions& options);

/// A participant of DDS as a node of ROS 2: topics of ROS, and the node and its endpoints announced.
std::unique_ptr<Backend> as_ros_node(std::unique_ptr<Backend> participant, const ParticipantOptions& options);

std::unique_ptr<Backend> make_zenoh_backend(const ParticipantOptions& options);

/// History that all keep: "all" is the last `max_samples`, so that no writer ever waits for a reader.
inline int history_depth(const Qos& qos) {
  return qos.depth > 0 ? qos.depth : qos.max_samples;
}

}  // namespace rds::bus::detail
