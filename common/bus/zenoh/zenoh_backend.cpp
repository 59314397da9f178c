// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_node.hpp"
#include "common/bus/zenoh/zenoh_reader.hpp"
#include "common/bus/zenoh/zenoh_writer.hpp"

namespace rds::bus::detail {
namespace {

class ZenohBackend final : public Backend {
 public:
  explicit ZenohBackend(const ParticipantOptions& options) : node_(options) {}

  std::unique_ptr<BackendWriter> make_writer(const std::string& topic, const TypeOps& type,
                                             const Qos& qos) override {
    return std::make_unique<ZenohWriter>(node_, topic, type, qos);
  }
  std::unique_ptr<BackendReader> make_reader(const std::string& topic, const TypeOps& type,
                                             const Qos& qos) override {
    return std::make_unique<ZenohReader>(node_, topic, type, qos);
  }
  std::unique_ptr<BackendService> make_service(const std::string& name, const TypeOps& /*request*/,
                                               const TypeOps& /*response*/) override {
    throw BusError("service " + name + ": services are on fastdds and cyclonedds only");
  }
  [[nodiscard]] Guid guid() const override { return node_.guid(); }
  [[nodiscard]] std::vector<DiscoveredEndpoint> discovered() const override {
    return node_.graph().discovered();
  }

 private:
  ZenohNode node_;
};

}  // namespace

std::unique_ptr<Backend> make_zenoh_backend(const ParticipantOptions& options) {
  if (options.credentials)
    throw BusError(
        "--secure with --bus zenoh: expected fastdds or cyclonedds, Zenoh knows no secured domain yet");
  return std::make_unique<ZenohBackend>(options);
}

}  // namespace rds::bus::detail
