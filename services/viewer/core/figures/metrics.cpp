// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/figures/metrics.hpp"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

namespace rds::viewer {
namespace {

constexpr double kGoneAfterS = 5;  // five reports of a service are missing

using Entry = ServiceTable::Entry;

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\' || c == '"') safe += '\\';
    if (c == '\n')
      safe += "\\n";
    else
      safe += c;
  }
  return safe;
}

/// One metric with a sample for each service.
void of_each(MetricsText& metrics, const ServiceTable& services, std::string_view name, std::string_view type,
             std::string_view help, const std::function<double(const Entry&)>& value) {
  metrics.begin(name, type, help);
  for (const auto& [service, entry] : services.entries()) metrics.add(value(entry), {{"service", service}});
}

void write_processes(MetricsText& metrics, const ServiceTable& services, double now_s) {
  of_each(metrics, services, "rds_service_up", "gauge", "1 while the service is heard and tells no error",
          [&](const Entry& e) { return now_s - e.heard_s < kGoneAfterS && e.figures.level < 2 ? 1.0 : 0.0; });
  of_each(metrics, services, "rds_service_level", "gauge", "0 ok, 1 warn, 2 error",
          [](const Entry& e) { return e.figures.level; });
  of_each(metrics, services, "rds_service_cpu_seconds_total", "counter", "Processor time of the process",
          [](const Entry& e) { return e.figures.cpu_s; });
  of_each(metrics, services, "rds_service_resident_bytes", "gauge", "Memory of the process",
          [](const Entry& e) { return e.figures.resident_mb * 1e6; });
  of_each(metrics, services, "rds_service_worker_silent_seconds", "gauge",
          "Since the worker said that it is alive", [](const Entry& e) { return e.figures.worker_silent_s; });
}

void write_latencies(MetricsText& metrics, const ServiceTable& services) {
  metrics.begin("rds_stage_seconds", "summary", "Duration of a stage over its last 512 times");
  for (const auto& [service, entry] : services.entries())
    for (const auto& [stage, latency] : entry.figures.latencies) {
      metrics.add(latency.p50_ms / 1e3, {{"service", service}, {"stage", stage}, {"quantile", "0.5"}});
      metrics.add(latency.p99_ms / 1e3, {{"service", service}, {"stage", stage}, {"quantile", "0.99"}});
    }
}

void write_losses(MetricsText& metrics, const ServiceTable& services) {
  metrics.begin("rds_dropped_messages_total", "counter",
                "Messages lost, by the service that did not get or write them");
  for (const auto& [service, entry] : services.entries())
    for (const auto& [topic, count] : entry.figures.dropped)
      metrics.add(count, {{"service", service}, {"topic", topic}});
  metrics.begin("rds_rejected_messages_total", "counter", "Messages that a service did not use");
  for (const auto& [service, entry] : services.entries())
    for (const auto& [what, count] : entry.figures.rejected)
      metrics.add(count, {{"service", service}, {"topic", what.first}, {"reason", what.second}});
  metrics.begin("rds_figure", "gauge", "Counters and queue depths of a service, by its own name for them");
  for (const auto& [service, entry] : services.entries())
    for (const auto& [name, count] : entry.figures.counts)
      metrics.add(count, {{"service", service}, {"name", name}});
}

void write_scene(MetricsText& metrics, const SceneFigures& scene) {
  const auto one = [&](std::string_view name, std::string_view type, std::string_view help, double value) {
    metrics.begin(name, type, help);
    metrics.add(value);
  };
  one("rds_tracking_state", "gauge",
      "0 not initialized, 1 tracking, 2 weak, 3 lost, 4 relocalised, 5 in a submap", scene.tracking_state);
  one("rds_inliers", "gauge", "Map points that support the newest frame's pose", scene.inliers);
  one("rds_features", "gauge", "Features of the newest frame", scene.features);
  one("rds_dynamic_features", "gauge", "Of these, on movable objects", scene.dynamic_features);
  one("rds_frames_total", "counter", "Frames that the tracker received", scene.frames);
  one("rds_frames_dropped_total", "counter", "Frames that the tracker dropped", scene.frames_dropped);
  one("rds_keyframes", "gauge", "Keyframes of the map epoch", scene.keyframes);
  one("rds_loops_closed_total", "counter", "Loops closed in the map epoch", scene.loops_closed);
  one("rds_map_occupied_voxels", "gauge", "Voxels that are occupied", scene.map_voxels);
  one("rds_map_revision", "gauge", "Revision of the map", scene.map_revision);
  one("rds_objects", "gauge", "Objects in the map", scene.objects);
  one("rds_predicted_boxes", "gauge", "Moving objects in the newest frame", scene.predicted_boxes);
  one("rds_viewer_clients", "gauge", "WebSocket clients", scene.clients);
}

}  // namespace

void MetricsText::begin(std::string_view name, std::string_view type, std::string_view help) {
  name_ = name;
  text_ += fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n", name, help, type);
}

void MetricsText::add(double value, const Labels& labels, std::string_view suffix) {
  text_ += name_;
  text_ += suffix;
  for (std::size_t i = 0; i < labels.size(); ++i)
    text_ += fmt::format("{}{}=\"{}\"", i == 0 ? "{" : ",", labels[i].first, escaped(labels[i].second));
  text_ += fmt::format("{} {}\n", labels.empty() ? "" : "}", value);
}

void FrameTimes::add(double seconds) {
  const auto bucket = std::ranges::lower_bound(kBounds, seconds) - kBounds.begin();
  ++counts_.at(static_cast<std::size_t>(bucket));
  sum_s_ += seconds;
}

void FrameTimes::write(MetricsText& metrics) const {
  metrics.begin("rds_frame_seconds", "histogram", "The tracker's time for a frame");
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    below += counts_[i];
    const std::string bound = i < kBounds.size() ? fmt::format("{}", kBounds[i]) : "+Inf";
    metrics.add(static_cast<double>(below), {{"le", bound}}, "_bucket");
  }
  metrics.add(sum_s_, {}, "_sum");
  metrics.add(static_cast<double>(below), {}, "_count");
}

std::string metrics_text(const SceneFigures& scene, const FrameTimes& times, const ServiceTable& services,
                         double now_s) {
  MetricsText metrics;
  write_scene(metrics, scene);
  times.write(metrics);
  write_processes(metrics, services, now_s);
  write_latencies(metrics, services);
  write_losses(metrics, services);
  return metrics.text();
}

}  // namespace rds::viewer
