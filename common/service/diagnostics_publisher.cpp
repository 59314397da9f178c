// SPDX-License-Identifier: Apache-2.0
#include "common/service/diagnostics_publisher.hpp"

#include <chrono>

#include "common/messages/conversions.hpp"
#include "common/service/process_usage.hpp"

namespace rds::service {
namespace {

constexpr std::chrono::milliseconds kPeriod{1000};
constexpr std::uint8_t kOk = 0;
constexpr std::uint8_t kWarn = 1;

diagnostic_msgs::msg::KeyValue key_value(const std::string& key, const std::string& value) {
  diagnostic_msgs::msg::KeyValue pair;
  pair.key(key);
  pair.value(value);
  return pair;
}

}  // namespace

DiagnosticsPublisher::DiagnosticsPublisher(ServiceContext& context)
    : context_(context),
      publisher_(context.bus.advertise<diagnostic_msgs::msg::DiagnosticArray>("diagnostics", bus::kStream)),
      thread_([this](const std::stop_token& stop) {
        concurrency::Mailbox timer;
        while (!stop.stop_requested()) {
          publish();
          timer.wait_for(stop, kPeriod, [] { return false; });
        }
      }) {}

void DiagnosticsPublisher::publish() {
  diagnostic_msgs::msg::DiagnosticStatus status;
  status.name(context_.name);
  status.hardware_id("rds-slam");
  auto& values = status.values();
  const ProcessUsage usage = process_usage();
  values.push_back(key_value("cpu [s]", fmt::format("{:.2f}", usage.cpu_s)));
  values.push_back(key_value("rss [MB]", fmt::format("{:.1f}", static_cast<double>(usage.rss_bytes) / 1e6)));
  for (const auto& [name, value] : context_.diagnostics.figures()) values.push_back(key_value(name, value));
  std::uint64_t troubles = context_.diagnostics.rejected();
  for (const auto& endpoint : context_.bus.statistics()) {
    if (endpoint.dropped > 0)
      values.push_back(key_value("dropped " + endpoint.topic, fmt::format("{}", endpoint.dropped)));
    troubles += endpoint.dropped;
  }
  status.level(troubles > troubles_before_ ? kWarn : kOk);
  status.message(troubles > troubles_before_ ? fmt::format("{} messages dropped", troubles - troubles_before_)
                                             : "");
  troubles_before_ = troubles;
  diagnostic_msgs::msg::DiagnosticArray report;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  report.header().stamp(messages::to_time(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count()));
  report.status().push_back(std::move(status));
  publisher_.write(report);
}

}  // namespace rds::service
