// SPDX-License-Identifier: Apache-2.0
#include "common/bus/participant.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include <malloc.h>

#include "common/bus/backend.hpp"
#include "common/bus/message_pool.hpp"
#include "common/bus/node_announcer.hpp"
#include "common/bus/type_version.hpp"

namespace rds::bus {
namespace {

using detail::Backend;
using detail::BackendReader;
using detail::BackendWriter;

constexpr int kHighestDomain = 232;  // RTPS port numbers end there
const std::string kRosPrefix = "rt/";

class Endpoint {
 public:
  virtual ~Endpoint() = default;
  [[nodiscard]] virtual EndpointStatistics endpoint_statistics() const = 0;
  [[nodiscard]] virtual DiscoveredEndpoint description() const = 0;
};

/// What a participant and its endpoints share; whoever of them lives longest closes it.
struct Shared {
  explicit Shared(const ParticipantOptions& options)
      : backend(options.vendor == Vendor::kFastDds ? detail::make_fastdds_backend(options)
                                                   : detail::make_cyclonedds_backend(options)),
        identity(options.credentials ? options.credentials->identity : ""),
        announcer(*backend, options.node_name) {}

  /// A participant carries one type per topic: both vendors would refuse a second one, each in its own way.
  void check_type(const std::string& topic, const TypeOps& type) {
    const std::lock_guard lock(mutex);
    const auto [known, added] = types.emplace(topic, type.dds_name);
    if (known->second == type.dds_name) return;
    throw BusError("topic " + topic + " already carries " + known->second + ", not " + type.dds_name);
  }
  void add(const Endpoint* endpoint) {
    const std::lock_guard lock(mutex);
    endpoints.insert(endpoint);
  }
  void remove(const Endpoint* endpoint) {
    const std::lock_guard lock(mutex);
    endpoints.erase(endpoint);
  }
  std::vector<DiscoveredEndpoint> own() {
    const std::lock_guard lock(mutex);
    std::vector<DiscoveredEndpoint> result;
    for (const Endpoint* endpoint : endpoints) result.push_back(endpoint->description());
    return result;
  }
  /// The ROS topics of other participants.
  [[nodiscard]] std::vector<DiscoveredEndpoint> others() const {
    std::vector<DiscoveredEndpoint> result;
    for (DiscoveredEndpoint& endpoint : backend->discovered()) {
      if (!endpoint.topic.starts_with(kRosPrefix)) continue;
      endpoint.topic.erase(0, kRosPrefix.size());
      result.push_back(std::move(endpoint));
    }
    return result;
  }

  /// Makes an endpoint. A vendor does not say that it was permissions that forbade it.
  template <class Make>
  auto explain_refusal(Make make) const {
    try {
      return make();
    } catch (const BusError& e) {
      if (identity.empty()) throw;
      throw BusError(std::string(e.what()) + ", which the permissions of '" + identity + "' must allow");
    }
  }

  std::unique_ptr<Backend> backend;
  std::string identity;  // empty on an open bus
  detail::NodeAnnouncer announcer;
  std::mutex mutex;
  std::set<const Endpoint*> endpoints;
  std::map<std::string, std::string> types;
};

class WriterEndpoint final : public detail::PublisherEndpoint, public Endpoint {
 public:
  WriterEndpoint(std::shared_ptr<Shared> shared, std::string topic, const TypeOps& type, const Qos& qos)
      : shared_(std::move(shared)),
        topic_(std::move(topic)),
        type_(type),
        writer_(shared_->backend->make_writer(kRosPrefix + topic_, type, qos)) {
    shared_->announcer.add_writer(writer_->guid());
    shared_->add(this);
  }
  ~WriterEndpoint() override {
    shared_->remove(this);
    shared_->announcer.remove(writer_->guid());
  }
  WriterEndpoint(const WriterEndpoint&) = delete;
  WriterEndpoint& operator=(const WriterEndpoint&) = delete;

  bool write(const void* message) override {
    const bool written = writer_->write(message);
    if (written) {
      ++messages_;
      bytes_ += type_.encoded_size(message);
    } else {
      ++refused_;
    }
    return written;
  }
  [[nodiscard]] int matched() const override { return writer_->matched(); }
  [[nodiscard]] EndpointStatistics endpoint_statistics() const override {
    return {topic_, true, messages_, bytes_, refused_, matched(), 0};
  }
  [[nodiscard]] DiscoveredEndpoint description() const override {
    return {topic_, type_.dds_name, true, type_.type_hash, detail::text_of(writer_->guid())};
  }

 private:
  std::shared_ptr<Shared> shared_;
  std::string topic_;
  const TypeOps& type_;
  std::unique_ptr<BackendWriter> writer_;
  std::atomic<std::uint64_t> messages_ = 0;
  std::atomic<std::uint64_t> bytes_ = 0;
  std::atomic<std::uint64_t> refused_ = 0;
};

class ReaderEndpoint final : public detail::SubscriptionEndpoint, public Endpoint {
 public:
  using Callback = std::function<void(std::shared_ptr<const void>, const ParticipantId&)>;

  ReaderEndpoint(std::shared_ptr<Shared> shared, std::string topic, const TypeOps& type, const Qos& qos,
                 Callback callback)
      : shared_(std::move(shared)),
        topic_(std::move(topic)),
        type_(type),
        callback_(std::move(callback)),
        pool_(type),
        reader_(shared_->backend->make_reader(kRosPrefix + topic_, type, qos)),
        thread_([this](const std::stop_token& stop) { run(stop); }) {
    shared_->announcer.add_reader(reader_->guid());
    shared_->add(this);
  }
  ~ReaderEndpoint() override {
    shared_->remove(this);
    thread_.request_stop();
    reader_->wake();
    thread_.join();
    shared_->announcer.remove(reader_->guid());
  }
  ReaderEndpoint(const ReaderEndpoint&) = delete;
  ReaderEndpoint& operator=(const ReaderEndpoint&) = delete;

  [[nodiscard]] int matched() const override { return reader_->matched(); }
  [[nodiscard]] EndpointStatistics endpoint_statistics() const override {
    const std::uint64_t others = another_version_;
    const std::uint64_t dropped = undecodable_ + failed_ + others + reader_->lost();
    return {topic_, false, messages_, bytes_, dropped, matched(), others};
  }
  [[nodiscard]] DiscoveredEndpoint description() const override {
    return {topic_, type_.dds_name, false, type_.type_hash, detail::text_of(reader_->guid())};
  }

 private:
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      reader_->wait();
      while (!stop.stop_requested() && take_one()) {
      }
    }
  }

  bool take_one() {
    const std::shared_ptr<void> message = pool_.get();
    detail::Sample sample{.type = &type_, .message = message.get()};
    if (!reader_->take(sample)) return false;
    if (sample.decoded) {
      ++messages_;
      bytes_ += sample.bytes;
      call_back(message, sample.writer);
    } else {
      ++(sample.another_version ? another_version_ : undecodable_);
    }
    return true;
  }

  /// An exception must not end the process: the message counts as dropped.
  void call_back(const std::shared_ptr<void>& message, const ParticipantId& writer) {
    try {
      callback_(message, writer);
    } catch (const std::exception&) {
      ++failed_;
    }
  }

  std::shared_ptr<Shared> shared_;
  std::string topic_;
  const TypeOps& type_;
  Callback callback_;
  detail::MessagePool pool_;
  std::unique_ptr<BackendReader> reader_;
  std::atomic<std::uint64_t> messages_ = 0;
  std::atomic<std::uint64_t> bytes_ = 0;
  std::atomic<std::uint64_t> undecodable_ = 0;
  std::atomic<std::uint64_t> failed_ = 0;
  std::atomic<std::uint64_t> another_version_ = 0;
  std::jthread thread_;  // last: it uses the others
};

class DdsParticipant final : public Participant {
 public:
  explicit DdsParticipant(const ParticipantOptions& options) : shared_(std::make_shared<Shared>(options)) {}

  std::unique_ptr<detail::PublisherEndpoint> make_publisher(const std::string& topic, const TypeOps& type,
                                                            const Qos& qos) override {
    shared_->check_type(topic, type);
    return shared_->explain_refusal(
        [&] { return std::make_unique<WriterEndpoint>(shared_, topic, type, qos); });
  }

  std::unique_ptr<detail::SubscriptionEndpoint> make_subscription(
      const std::string& topic, const TypeOps& type, const Qos& qos,
      std::function<void(std::shared_ptr<const void>, const ParticipantId&)> callback) override {
    shared_->check_type(topic, type);
    return shared_->explain_refusal(
        [&] { return std::make_unique<ReaderEndpoint>(shared_, topic, type, qos, std::move(callback)); });
  }

  [[nodiscard]] std::vector<EndpointStatistics> statistics() const override {
    std::vector<EndpointStatistics> result;
    const std::lock_guard lock(shared_->mutex);
    for (const Endpoint* endpoint : shared_->endpoints) result.push_back(endpoint->endpoint_statistics());
    std::ranges::sort(result, {},
                      [](const EndpointStatistics& s) { return std::pair(s.topic, s.publisher); });
    return result;
  }

  [[nodiscard]] std::vector<DiscoveredEndpoint> discovered() const override {
    std::vector<DiscoveredEndpoint> result = shared_->others();
    std::ranges::move(shared_->own(), std::back_inserter(result));
    std::ranges::sort(result, {},
                      [](const DiscoveredEndpoint& e) { return std::tuple(e.topic, e.publisher, e.type); });
    return result;
  }

  [[nodiscard]] std::vector<Mismatch> mismatches() const override {
    std::map<std::string, DiscoveredEndpoint> own;  // any of a topic's endpoints: they carry one type
    for (DiscoveredEndpoint& endpoint : shared_->own()) own.emplace(endpoint.topic, std::move(endpoint));
    std::vector<Mismatch> result;
    for (DiscoveredEndpoint& endpoint : shared_->others()) {
      const auto ours = own.find(endpoint.topic);
      if (ours == own.end() || !detail::is_another_version(ours->second, endpoint)) continue;
      result.push_back({std::move(endpoint), ours->second.type_hash});
    }
    return result;
  }

 private:
  std::shared_ptr<Shared> shared_;
};

}  // namespace

Vendor vendor_from_name(const std::string& name) {
  if (name == "fastdds") return Vendor::kFastDds;
  if (name == "cyclonedds") return Vendor::kCycloneDds;
  throw std::invalid_argument("bus '" + name + "', expected fastdds or cyclonedds");
}

std::string name_of(Vendor vendor) {
  return vendor == Vendor::kFastDds ? "fastdds" : "cyclonedds";
}

namespace {

/// Lets freed memory stay with the process. By itself the C library adapts to large messages only by chance:
/// in some runs it gives every picture's memory back to the kernel, which has to clear it for the next one,
/// and a picture's way takes more than twice as long.
void keep_freed_memory() {
  constexpr int kMiB = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMiB);
  mallopt(M_TRIM_THRESHOLD, 64 * kMiB);
}

}  // namespace

std::unique_ptr<Participant> Participant::create(const ParticipantOptions& options) {
  if (options.domain < 0 || options.domain > kHighestDomain) {
    throw BusError("DDS domain " + std::to_string(options.domain) + ", expected 0 to " +
                   std::to_string(kHighestDomain));
  }
  if (options.credentials && options.domain > kHighestSecuredDomain)
    throw BusError("DDS domain " + std::to_string(options.domain) + ", expected 0 to " +
                   std::to_string(kHighestSecuredDomain) + " for a secured one");
  keep_freed_memory();
  return std::make_unique<DdsParticipant>(options);
}

}  // namespace rds::bus
