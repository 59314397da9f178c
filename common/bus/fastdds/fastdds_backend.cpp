// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <mutex>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include "common/bus/dds/service_topics.hpp"
#include "common/bus/dds/user_data.hpp"
#include "common/bus/fastdds/fastdds_reader.hpp"
#include "common/bus/fastdds/fastdds_service.hpp"
#include "common/bus/fastdds/fastdds_settings.hpp"
#include "common/bus/fastdds/fastdds_type.hpp"

namespace rds::bus::detail {
namespace {

namespace dds = eprosima::fastdds::dds;
/// The endpoints of other participants, kept up to date by Fast DDS's discovery thread.
class DiscoveryListener final : public dds::DomainParticipantListener {
 public:
  void on_subscriber_discovery(dds::DomainParticipant* self, rtps::ReaderDiscoveryInfo&& info) override {
    update(*self, info.info, info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER, false);
  }
  void on_publisher_discovery(dds::DomainParticipant* self, rtps::WriterDiscoveryInfo&& info) override {
    update(*self, info.info, info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER, true);
  }
  void on_participant_discovery(dds::DomainParticipant* /*p*/,
                                rtps::ParticipantDiscoveryInfo&& info) override {
    using Info = rtps::ParticipantDiscoveryInfo;
    if (info.status != Info::REMOVED_PARTICIPANT && info.status != Info::DROPPED_PARTICIPANT) return;
    const Guid gone = to_guid(info.info.m_guid);
    directory_.remove_if([&gone](const Guid& guid) { return same_participant(guid, gone); });
  }

  [[nodiscard]] const EndpointDirectory<Guid>& directory() const { return directory_; }

 private:
  template <class Proxy>
  void update(const dds::DomainParticipant& self, const Proxy& proxy, bool removed, bool publisher) {
    const Guid guid = to_guid(proxy.guid());
    if (same_participant(guid, to_guid(self.guid()))) return;  // Fast DDS tells of its own as well
    if (removed) {
      directory_.remove(guid);
      return;
    }
    const auto& user_data = proxy.m_qos.m_userData.data_vec();
    directory_.put(guid,
                   {proxy.topicName().to_string(), proxy.typeName().to_string(), publisher,
                    type_hash_in({reinterpret_cast<const char*>(user_data.data()), user_data.size()}),
                    text_of(guid), proxy.m_qos.m_reliability.kind == dds::RELIABLE_RELIABILITY_QOS,
                    proxy.m_qos.m_durability.kind >= dds::TRANSIENT_LOCAL_DURABILITY_QOS},
                   guid);
  }

  EndpointDirectory<Guid> directory_;
};

class FastWriter final : public BackendWriter {
 public:
  FastWriter(dds::Publisher* publisher, dds::Topic* topic, const TypeOps& type, const dds::DataWriterQos& qos)
      : publisher_(publisher),
        type_(type),
        reliable_(qos.reliability().kind == dds::RELIABLE_RELIABILITY_QOS),
        writer_(publisher->create_datawriter(topic, qos)) {
    if (writer_ == nullptr) throw BusError("Fast DDS refused a writer on " + topic->get_name());
  }
  ~FastWriter() override { publisher_->delete_datawriter(writer_); }
  FastWriter(const FastWriter&) = delete;
  FastWriter& operator=(const FastWriter&) = delete;

  bool write(const void* message) override {
    // Cyclone DDS forgets the fragments it has when the first heartbeat it hears comes between them, and Fast
    // DDS has sent its first heartbeat before Cyclone DDS knew the writer: say it again.
    if (reliable_ && type_.encoded_size(message) >= kSmallestFragmented) writer_->assert_liveliness();
    return writer_->write(const_cast<void*>(message));
  }
  [[nodiscard]] int matched() const override {
    dds::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return status.current_count;
  }
  [[nodiscard]] Guid guid() const override { return to_guid(writer_->guid()); }

 private:
  static constexpr std::size_t kSmallestFragmented = 60'000;

  dds::Publisher* publisher_;
  const TypeOps& type_;
  bool reliable_;
  dds::DataWriter* writer_;
};

class FastBackend final : public Backend {
 public:
  explicit FastBackend(const ParticipantOptions& options) {
    const dds::DomainParticipantQos qos = fastdds_participant_qos(options);
    // No status for the participant's listener: it would swallow the readers' data-available.
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
        static_cast<dds::DomainId_t>(options.domain), qos, &listener_, dds::StatusMask::none());
    if (participant_ == nullptr) {
      throw BusError("Fast DDS could not join domain " + std::to_string(options.domain) +
                     ": no free port or no usable network interface");
    }
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  }
  ~FastBackend() override {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  FastBackend(const FastBackend&) = delete;
  FastBackend& operator=(const FastBackend&) = delete;

  std::unique_ptr<BackendWriter> make_writer(const std::string& topic, const TypeOps& type,
                                             const Qos& qos) override {
    return std::make_unique<FastWriter>(publisher_, find_topic(topic, type), type,
                                        fastdds_writer_qos(type, qos));
  }
  std::unique_ptr<BackendReader> make_reader(const std::string& topic, const TypeOps& type,
                                             const Qos& qos) override {
    return make_fast_reader(topic, type, qos);
  }
  std::unique_ptr<BackendService> make_service(const std::string& name, const ServiceType& type) override {
    return make_fastdds_service(make_fast_reader(request_topic(name), type.request, kServiceQos), publisher_,
                                find_topic(reply_topic(name), type.response),
                                fastdds_writer_qos(type.response, kServiceQos));
  }
  [[nodiscard]] Guid guid() const override { return to_guid(participant_->guid()); }
  [[nodiscard]] std::vector<DiscoveredEndpoint> discovered() const override {
    return listener_.directory().endpoints();
  }

 private:
  std::unique_ptr<FastReader> make_fast_reader(const std::string& topic, const TypeOps& type,
                                               const Qos& qos) {
    return std::make_unique<FastReader>(subscriber_, find_topic(topic, type), fastdds_reader_qos(type, qos),
                                        VersionCheck<Guid>(listener_.directory(), topic, type));
  }

  /// Topics live as long as the participant: few, and shared by its endpoints.
  dds::Topic* find_topic(const std::string& name, const TypeOps& type) {
    const std::lock_guard lock(topics_mutex_);
    dds::Topic*& topic = topics_[name];
    if (topic != nullptr) return topic;
    if (participant_->find_type(type.dds_name).empty()) {
      dds::TypeSupport(new CarriedType(type)).register_type(participant_);
    }
    topic = participant_->create_topic(name, type.dds_name, dds::TOPIC_QOS_DEFAULT);
    if (topic == nullptr) throw BusError("Fast DDS refused topic " + name + " of type " + type.dds_name);
    return topic;
  }

  DiscoveryListener listener_;
  dds::DomainParticipant* participant_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  std::mutex topics_mutex_;
  std::map<std::string, dds::Topic*> topics_;
};

}  // namespace

std::unique_ptr<Backend> make_fastdds_backend(const ParticipantOptions& options) {
  return std::make_unique<FastBackend>(options);
}

}  // namespace rds::bus::detail
