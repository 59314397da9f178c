// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "common/bus/backend.hpp"
#include "common/bus/dds/node_announcer.hpp"

namespace rds::bus::detail {
namespace {

const std::string kRosPrefix = "rt/";

class AnnouncedWriter final : public BackendWriter {
 public:
  AnnouncedWriter(std::unique_ptr<BackendWriter> writer, NodeAnnouncer& announcer)
      : writer_(std::move(writer)), announcer_(announcer) {
    announcer_.add_writer(guid());
  }
  ~AnnouncedWriter() override { announcer_.remove(guid()); }
  AnnouncedWriter(const AnnouncedWriter&) = delete;
  AnnouncedWriter& operator=(const AnnouncedWriter&) = delete;

  bool write(const void* message) override { return writer_->write(message); }
  [[nodiscard]] int matched() const override { return writer_->matched(); }
  [[nodiscard]] Guid guid() const override { return writer_->guid(); }

 private:
  std::unique_ptr<BackendWriter> writer_;
  NodeAnnouncer& announcer_;
};

class AnnouncedReader final : public BackendReader {
 public:
  AnnouncedReader(std::unique_ptr<BackendReader> reader, NodeAnnouncer& announcer)
      : reader_(std::move(reader)), announcer_(announcer) {
    announcer_.add_reader(guid());
  }
  ~AnnouncedReader() override { announcer_.remove(guid()); }
  AnnouncedReader(const AnnouncedReader&) = delete;
  AnnouncedReader& operator=(const AnnouncedReader&) = delete;

  void wait() override { reader_->wait(); }
  bool wait_for(std::chrono::seconds limit) override { return reader_->wait_for(limit); }
  void wake() override { reader_->wake(); }
  bool take(Sample& sample) override { return reader_->take(sample); }
  [[nodiscard]] std::uint64_t lost() const override { return reader_->lost(); }
  [[nodiscard]] int matched() const override { return reader_->matched(); }
  [[nodiscard]] Guid guid() const override { return reader_->guid(); }

 private:
  std::unique_ptr<BackendReader> reader_;
  NodeAnnouncer& announcer_;
};

class AnnouncedService final : public BackendService {
 public:
  AnnouncedService(std::unique_ptr<BackendService> service, NodeAnnouncer& announcer)
      : service_(std::move(service)), announcer_(announcer) {
    announcer_.add_reader(request_reader());
    announcer_.add_writer(reply_writer());
  }
  ~AnnouncedService() override {
    announcer_.remove(request_reader());
    announcer_.remove(reply_writer());
  }
  AnnouncedService(const AnnouncedService&) = delete;
  AnnouncedService& operator=(const AnnouncedService&) = delete;

  void wait() override { service_->wait(); }
  void wake() override { service_->wake(); }
  bool take(Sample& sample, Caller& caller) override { return service_->take(sample, caller); }
  bool reply(const Caller& caller, const void* response) override {
    return service_->reply(caller, response);
  }
  [[nodiscard]] std::uint64_t lost() const override { return service_->lost(); }
  [[nodiscard]] Guid request_reader() const override { return service_->request_reader(); }
  [[nodiscard]] Guid reply_writer() const override { return service_->reply_writer(); }

 private:
  std::unique_ptr<BackendService> service_;
  NodeAnnouncer& announcer_;
};

class DdsNode final : public Backend {
 public:
  DdsNode(std::unique_ptr<Backend> participant, const ParticipantOptions& options)
      : participant_(std::move(participant)),
        announcer_(*participant_, {normal_namespace(options.node_namespace), options.node_name},
                   options.ros_distro) {}

  std::unique_ptr<BackendWriter> make_writer(const std::string& topic, const TypeOps& type,
                                             const Qos& qos) override {
    return std::make_unique<AnnouncedWriter>(participant_->make_writer(kRosPrefix + topic, type, qos),
                                             announcer_);
  }
  std::unique_ptr<BackendReader> make_reader(const std::string& topic, const TypeOps& type,
                                             const Qos& qos) override {
    return std::make_unique<AnnouncedReader>(participant_->make_reader(kRosPrefix + topic, type, qos),
                                             announcer_);
  }
  std::unique_ptr<BackendService> make_service(const std::string& name, const ServiceType& type) override {
    return std::make_unique<AnnouncedService>(participant_->make_service(name, type), announcer_);
  }
  [[nodiscard]] Guid guid() const override { return participant_->guid(); }

  /// The ROS topics alone.
  [[nodiscard]] std::vector<DiscoveredEndpoint> discovered() const override {
    std::vector<DiscoveredEndpoint> result;
    for (DiscoveredEndpoint& endpoint : participant_->discovered()) {
      if (!endpoint.topic.starts_with(kRosPrefix)) continue;
      endpoint.topic.erase(0, kRosPrefix.size());
      result.push_back(std::move(endpoint));
    }
    return result;
  }

 private:
  std::unique_ptr<Backend> participant_;
  NodeAnnouncer announcer_;
};

}  // namespace

std::unique_ptr<Backend> as_ros_node(std::unique_ptr<Backend> participant,
                                     const ParticipantOptions& options) {
  return std::make_unique<DdsNode>(std::move(participant), options);
}

}  // namespace rds::bus::detail
