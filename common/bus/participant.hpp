// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/names/topic_names.hpp"
#include "common/bus/qos.hpp"
#include "common/bus/security.hpp"
#include "common/bus/type_ops.hpp"

namespace rds::bus {

/// The bus could not be joined, or an endpoint not be made; the text names what and why.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class Vendor { kFastDds, kCycloneDds };

/// In whose form nodes are announced: ROS 2 up to Humble names endpoints by 24 bytes, since Iron by 16.
enum class RosDistro { kHumble, kJazzy };

/// "fastdds" or "cyclonedds"; @throws std::invalid_argument otherwise, naming both.
Vendor vendor_from_name(const std::string& name);
std::string name_of(Vendor vendor);

/// "foxy", "galactic" and "humble" are kHumble; any other name is one of today or later.
RosDistro ros_distro_from_name(const std::string& name);

struct ParticipantOptions {
  Vendor vendor = Vendor::kFastDds;
  int domain = 0;
  std::string node_name;                        // as `ros2 node list` shows it, without the leading slash
  bool loopback_only = false;                   // this machine only: no multicast, nobody else is disturbed
  std::vector<std::string> peers = {};          // IPv4 addresses of other machines, found without multicast
  std::optional<Credentials> credentials = {};  // of a secured domain; without them the bus is open
  std::string node_namespace = "/";             // of the node, and of topics
  std::vector<Remapping> remappings = {};       // of topics; the first that fits holds
  RosDistro ros_distro = RosDistro::kJazzy;     // that nodes are announced to
};

/// Which participant wrote a message: the same for all that one process writes, on every topic; nobody else
/// can write with it by accident, and on a secured bus not on purpose.
using ParticipantId = std::array<std::uint8_t, 12>;

/// Traffic of one endpoint since its creation.
struct EndpointStatistics {
  std::string topic;  // as it was asked for, without a leading slash
  bool publisher = false;
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::uint64_t dropped = 0;  // lost by the bus, refused by the writer, undecodable, or of another version
  int matched = 0;            // endpoints at the other side
  std::uint64_t another_version = 0;  // among the dropped: never decoded, as its writer's type hash differs
};

/// An endpoint somebody announced on the bus.
struct DiscoveredEndpoint {
  std::string topic;  // full name, without "rt/"
  std::string type;   // DDS type name, e.g. "nav_msgs::msg::dds_::Odometry_"
  bool publisher = false;
  std::string type_hash =
      {};                 // "RIHS01_…"; empty if not announced, as by plain DDS programs and ROS 2 Humble
  std::string guid = {};  // as `ros2 topic info --verbose` writes it
  bool reliable = true;   // what a publisher offers, or a subscriber asks for
  bool transient_local = false;
};

/// An endpoint of somebody on a topic of ours whose type has the name of ours, but is defined otherwise: his
/// messages are dropped, and what he makes of ours is unknown.
struct Mismatch {
  DiscoveredEndpoint theirs;
  std::string own_type_hash;
};

namespace detail {
class PublisherEndpoint {
 public:
  virtual ~PublisherEndpoint() = default;
  virtual bool write(const void* message) = 0;
  [[nodiscard]] virtual int matched() const = 0;
};
class SubscriptionEndpoint {
 public:
  virtual ~SubscriptionEndpoint() = default;
  [[nodiscard]] virtual int matched() const = 0;
};
}  // namespace detail

/// Writes messages of one type to one topic. Movable; the endpoint leaves the bus with it.
template <class T>
class Publisher {
 public:
  Publisher() = default;
  explicit Publisher(std::unique_ptr<detail::PublisherEndpoint> endpoint) : endpoint_(std::move(endpoint)) {}

  /// Never waits for readers. @return false if the message was dropped (counted in the statistics).
  bool write(const T& message) { return endpoint_->write(&message); }
  [[nodiscard]] int matched() const { return endpoint_->matched(); }

 private:
  std::unique_ptr<detail::PublisherEndpoint> endpoint_;
};

/// Keeps a callback subscribed; after its destructor returns the callback is not running and never runs
/// again.
class Subscription {
 public:
  Subscription() = default;
  explicit Subscription(std::unique_ptr<detail::SubscriptionEndpoint> endpoint)
      : endpoint_(std::move(endpoint)) {}
  [[nodiscard]] int matched() const { return endpoint_->matched(); }

 private:
  std::unique_ptr<detail::SubscriptionEndpoint> endpoint_;
};

/// This process on the bus. Callbacks run on threads of the participant, one message of a topic after the
/// other: they convert and push, never compute. All members are safe to call from any thread.
class Participant {
 public:
  /// @throws BusError
  static std::unique_ptr<Participant> create(const ParticipantOptions& options);
  virtual ~Participant() = default;

  /// @param topic  see full_name(). @throws BusError
  template <class T>
  Publisher<T> advertise(const std::string& topic, const Qos& qos) {
    return Publisher<T>(make_publisher(topic, type_ops<T>(), qos));
  }

  /// @param topic  see full_name(). @throws BusError
  template <class T>
  Subscription subscribe(const std::string& topic, const Qos& qos,
                         std::function<void(std::shared_ptr<const T>)> callback) {
    return subscribe<T>(topic, qos, [callback](std::shared_ptr<const T> message, const ParticipantId&) {
      callback(std::move(message));
    });
  }
  /// For readers that ask who wrote a message.
  template <class T>
  Subscription subscribe(const std::string& topic, const Qos& qos,
                         std::function<void(std::shared_ptr<const T>, const ParticipantId&)> callback) {
    return Subscription(make_subscription(
        topic, type_ops<T>(), qos, [callback](std::shared_ptr<const void> m, const ParticipantId& writer) {
          callback(std::static_pointer_cast<const T>(std::move(m)), writer);
        }));
  }

  /// For tools that learn the type at run time: as subscribe(), and the size on the wire [bytes].
  virtual std::unique_ptr<detail::SubscriptionEndpoint> make_subscription(
      const std::string& topic, const TypeOps& type, const Qos& qos,
      std::function<void(std::shared_ptr<const void>, const ParticipantId&)> callback) = 0;
  virtual std::unique_ptr<detail::PublisherEndpoint> make_publisher(const std::string& topic,
                                                                    const TypeOps& type, const Qos& qos) = 0;

  /// As readers see it that ask who wrote a message.
  [[nodiscard]] virtual ParticipantId id() const = 0;

  /// A topic's name on the bus; see TopicNames::full_name().
  [[nodiscard]] virtual std::string full_name(const std::string& topic) const = 0;

  [[nodiscard]] virtual std::vector<EndpointStatistics> statistics() const = 0;
  [[nodiscard]] virtual std::vector<DiscoveredEndpoint> discovered() const = 0;
  /// Those who are there now, one entry for each endpoint.
  [[nodiscard]] virtual std::vector<Mismatch> mismatches() const = 0;
};

}  // namespace rds::bus
