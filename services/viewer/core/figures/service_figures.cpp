// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/figures/service_figures.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

namespace rds::viewer {
namespace {

using nlohmann::json;
constexpr std::string_view kP50 = " p50 [ms]";
constexpr std::string_view kP99 = " p99 [ms]";
constexpr std::string_view kDropped = "dropped ";
constexpr std::string_view kRejected = "rejected ";

std::optional<double> to_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Printable ASCII alone: neither JSON nor Prometheus takes all bytes.
std::string cut(std::string_view text) {
  std::string kept(text.substr(0, kMostTextBytes));
  std::ranges::replace_if(
      kept, [](char c) { return c < ' ' || c > '~'; }, '?');
  return kept;
}

void add_rejected(ServiceFigures& figures, std::string_view name, double value) {
  const auto colon = name.rfind(": ");
  if (colon == std::string_view::npos) return;
  figures.rejected[{cut(name.substr(0, colon)), cut(name.substr(colon + 2))}] = value;
}

void add_number(ServiceFigures& figures, std::string_view name, double value) {
  if (name == "cpu [s]")
    figures.cpu_s = value;
  else if (name == "rss [MB]")
    figures.resident_mb = value;
  else if (name == "worker silent [s]")
    figures.worker_silent_s = value;
  else if (name.ends_with(kP50))
    figures.latencies[cut(name.substr(0, name.size() - kP50.size()))].p50_ms = value;
  else if (name.ends_with(kP99))
    figures.latencies[cut(name.substr(0, name.size() - kP99.size()))].p99_ms = value;
  else if (name.starts_with(kDropped) && name.find('/') != std::string_view::npos)
    figures.dropped[cut(name.substr(kDropped.size()))] = value;
  else if (name.starts_with(kRejected))
    add_rejected(figures, name.substr(kRejected.size()), value);
  else
    figures.counts[cut(name)] = value;
}

json to_json(const ServiceFigures& figures) {
  json latencies = json::object();
  for (const auto& [stage, latency] : figures.latencies) latencies[stage] = {latency.p50_ms, latency.p99_ms};
  double dropped = 0;
  for (const auto& [topic, count] : figures.dropped) dropped += count;
  double rejected = 0;
  for (const auto& [topic, count] : figures.rejected) rejected += count;
  return {{"level", figures.level},        {"message", figures.message}, {"cpu_s", figures.cpu_s},
          {"rss_mb", figures.resident_mb}, {"latencies_ms", latencies},  {"dropped", dropped},
          {"rejected", rejected},          {"counts", figures.counts}};
}

}  // namespace

ServiceFigures figures_of(std::uint8_t level, std::string_view message, const KeyValues& values) {
  ServiceFigures figures;
  figures.level = level;
  figures.message = cut(message);
  for (std::size_t i = 0; i < values.size() && i < kMostFigures; ++i) {
    const auto& [name, text] = values[i];
    if (const auto number = name == "instance" ? std::nullopt : to_number(text))
      add_number(figures, name, *number);
    else
      figures.texts[cut(name)] = cut(text);
  }
  return figures;
}

bool ServiceTable::take(const std::string& name, ServiceFigures figures, double now_s) {
  const std::string kept = cut(name);
  if (!entries_.contains(kept) && entries_.size() >= kMostServices) return false;
  entries_[kept] = {std::move(figures), now_s};
  return true;
}

std::string ServiceTable::to_json(double now_s) const {
  json services = json::object();
  for (const auto& [name, entry] : entries_) {
    services[name] = viewer::to_json(entry.figures);
    services[name]["heard_s_ago"] = now_s - entry.heard_s;
  }
  return services.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace rds::viewer
