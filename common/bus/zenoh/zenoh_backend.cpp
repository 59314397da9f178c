// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_node.hpp"
#include "common/bus/zenoh/zenoh_reader.hpp"
#include "common/bus/zenoh/zenoh_service.hpp"
#include "common/bus/zenoh/zenoh_writer.hpp"

namespace rds::bus::detail {
namespace {

class ZenohBackend final : public Backend {
 public:
  explicit ZenohBackend(const ParticipantOptions& options)
      : access_(options.credentials ? std::make_unique<ZenohAccess>(*options.credentials) : nullptr),
        node_(options, access_.get()) {}

  std::unique_ptr<BackendWriter> make_writer(const std::string& topic, const TypeOps& type,
                                             const Qos& qos) override {
    if (access_) access_->check(topic, true);
    return std::make_unique<ZenohWriter>(node_, topic, type, qos);
  }
  std::unique_ptr<BackendReader> make_reader(const std::string& topic, const TypeOps& type,
                                             const Qos& qos) override {
    if (access_) access_->check(topic, false);
    return std::make_unique<ZenohReader>(node_, topic, type, qos);
  }
  std::unique_ptr<BackendService> make_service(const std::string& name, const ServiceType& type) override {
    if (access_) access_->check(name, true);
    const std::lock_guard lock(mutex_);
    if (!replies_) replies_ = std::make_shared<ZenohReplies>();
    return std::make_unique<ZenohService>(node_, replies_, name, type);
  }
  [[nodiscard]] Guid guid() const override { return node_.guid(); }
  [[nodiscard]] std::vector<DiscoveredEndpoint> discovered() const override {
    return node_.graph().discovered();
  }

 private:
  std::unique_ptr<ZenohAccess> access_;  // of a secured domain
  ZenohNode node_;
  std::mutex mutex_;
  std::shared_ptr<ZenohReplies> replies_;  // of all services, from the first on
};

}  // namespace

std::unique_ptr<Backend> make_zenoh_backend(const ParticipantOptions& options) {
  return std::make_unique<ZenohBackend>(options);
}

}  // namespace rds::bus::detail
