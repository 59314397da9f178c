// SPDX-License-Identifier: Apache-2.0
#include "common/service/diagnostics_publisher.hpp"

#include <chrono>
#include <ctime>
#include <fstream>

#include <malloc.h>
#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include "common/messages/conversions.hpp"
#include "common/service/process/freed_memory.hpp"
#include "common/service/process/printable.hpp"
#include "common/topics/endpoints.hpp"

namespace rds::service {
namespace {

constexpr std::chrono::milliseconds kLookPeriod{250};
constexpr int kLooksPerReport = 4;
constexpr double kHangS = 5;  // a worker that is silent for longer hangs

bool hangs(const WorkerState& worker) {
  return worker.there && worker.silent_s > kHangS;
}

/// User and system time of all threads of this process.
double cpu_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double mb(std::size_t bytes) {
  return static_cast<double>(bytes) / 1e6;
}

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double total_pages = 0;
  double resident_pages = 0;
  statm >> total_pages >> resident_pages;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

diagnostic_msgs::msg::KeyValue key_value(const std::string& key, const std::string& value) {
  diagnostic_msgs::msg::KeyValue pair;
  pair.key(key);
  pair.value(value);
  return pair;
}

}  // namespace

DiagnosticsPublisher::DiagnosticsPublisher(ServiceContext& context, Presence& presence,
                                           const ServiceSlot& service)
    : context_(context),
      presence_(presence),
      service_(service),
      publisher_(topics::advertise(context.bus, topics::kDiagnostics, topics::kServices)),
      versions_(context.bus),
      thread_([this](const std::stop_token& stop) {
        concurrency::Mailbox timer;
        FreedMemory freed_memory;
        for (int looks = 0; !stop.stop_requested(); ++looks) {
          look();
          if (looks % kLooksPerReport == 0) {
            publish();
            freed_memory.look();
          }
          timer.wait_for(stop, kLookPeriod, [] { return false; });
        }
      }) {}

void DiagnosticsPublisher::look() {
  auto warnings = context_.diagnostics.warnings();
  for (const auto& [name, text] : warnings)
    if (!warnings_.contains(name)) spdlog::warn("{}", text);
  if (auto silent = others_.look(presence_.peers().known(), Peers::Clock::now()))
    warnings.emplace("", std::move(*silent));  // goes first, and is in the log
  warnings_ = std::move(warnings);
}

Health DiagnosticsPublisher::health(const WorkerState& worker, std::size_t mismatches) {
  std::uint64_t troubles = context_.diagnostics.rejected();
  for (const auto& endpoint : context_.bus.statistics()) troubles += endpoint.dropped;
  const std::uint64_t lately = troubles - troubles_before_;
  troubles_before_ = troubles;
  if (hangs(worker)) return {kError, fmt::format("the worker has been silent for {:.0f} s", worker.silent_s)};
  if (const auto rivalry = presence_.rivalry()) return {kError, *rivalry};
  if (mismatches > 0) return {kWarn, fmt::format("{} endpoints of another version", mismatches)};
  if (!warnings_.empty()) return {kWarn, warnings_.begin()->second};
  if (lately > 0) return {kWarn, fmt::format("{} messages dropped", lately)};
  return {};
}

void DiagnosticsPublisher::tell_supervisor(const WorkerState& worker, const Health& health) {
  if (!hangs(worker)) sd_notify(0, "WATCHDOG=1");
  std::string status = presence_.is_active() ? "active" : "stand-by";
  if (!health.message.empty()) status += ": " + health.message;
  if (status != told_) sd_notify(0, ("STATUS=" + printable(status)).c_str());
  told_ = std::move(status);
}

void DiagnosticsPublisher::finish() {
  thread_.request_stop();
  thread_.join();
  publish();
}

double DiagnosticsPublisher::silent_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - published_.load()).count();
}

void DiagnosticsPublisher::publish() {
  const WorkerState worker = service_.worker_state();
  const std::vector<bus::Mismatch> mismatches = versions_.look();
  const Health health_now = health(worker, mismatches.size());
  presence_.tell(health_now, worker.silent_s);
  diagnostic_msgs::msg::DiagnosticStatus status;
  status.name((context_.node_namespace == "/" ? "" : context_.node_namespace.substr(1) + "/") +
              context_.name);
  status.hardware_id("rds-slam");
  status.level(health_now.level);
  status.message(health_now.message);
  auto& values = status.values();
  values.push_back(key_value("instance", fmt::format("{:016x}", context_.instance)));
  values.push_back(key_value("role", presence_.is_active() ? "active" : "stand-by"));
  values.push_back(key_value("worker silent [s]", fmt::format("{:.1f}", worker.silent_s)));
  values.push_back(key_value("cpu [s]", fmt::format("{:.2f}", cpu_s())));
  values.push_back(key_value("rss [MB]", fmt::format("{:.1f}", resident_mb())));
  const auto heap = mallinfo2();
  values.push_back(key_value("allocated [MB]", fmt::format("{:.1f}", mb(heap.uordblks + heap.hblkhd))));
  values.push_back(key_value("freed, kept [MB]", fmt::format("{:.1f}", mb(heap.fordblks))));
  for (const auto& [name, value] : context_.diagnostics.figures()) values.push_back(key_value(name, value));
  for (const auto& endpoint : context_.bus.statistics())
    if (endpoint.dropped > 0)
      values.push_back(key_value("dropped " + endpoint.topic, fmt::format("{}", endpoint.dropped)));
  for (const auto& [name, text] : warnings_) values.push_back(key_value("warning", text));
  for (const bus::Mismatch& mismatch : mismatches)
    values.push_back(key_value("another version", describe(mismatch)));
  diagnostic_msgs::msg::DiagnosticArray report;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  report.header().stamp(messages::to_time(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count()));
  report.status().push_back(std::move(status));
  publisher_.write(report);
  published_ = std::chrono::steady_clock::now();
  tell_supervisor(worker, health_now);
}

}  // namespace rds::service
