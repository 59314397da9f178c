// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/input/camera_faults.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/topics/camera_presets.hpp"

namespace rds::tracker {
namespace {

using Fault = std::optional<std::string>;

constexpr double kSilentS = 0.8;  // two pictures at 2.5 Hz
constexpr std::size_t kTopicsNamed = 4;

bool comes(const StreamSight& stream) {
  return stream.silent_s < kSilentS;
}

/// ", but there is a, b" or nothing.
std::string but_there_is(const std::vector<std::string>& topics) {
  if (topics.empty()) return "";
  const auto end = topics.begin() + static_cast<std::ptrdiff_t>(std::min(topics.size(), kTopicsNamed));
  return fmt::format(", but there is {}", fmt::join(topics.begin(), end, ", "));
}

/// Why nothing of a topic can be used. @param setting  that names it. @param remedy  where nobody publishes
/// it.
Fault fault_of(const StreamSight& stream, const std::vector<std::string>& others, const std::string& setting,
               const std::string& remedy) {
  if (stream.refused_s < kSilentS) return fmt::format("{}: {}", stream.topic, stream.refusal);
  if (comes(stream)) return std::nullopt;
  if (stream.publishers > 0)
    return fmt::format(
        "{} has a publisher, but nothing comes: look at the driver and the network (rds doctor)",
        stream.topic);
  if (!stream.other_type.empty())
    return fmt::format("{} is published as {}, which is not read: set {} to another topic of the driver",
                       stream.topic, stream.other_type, setting);
  return fmt::format("nobody publishes {}{}: set {}, or {}", stream.topic, but_there_is(others), setting,
                     remedy);
}

/// "camera.color", and the preset of a driver whose colour pictures are there, and best its depth, too.
std::string color_setting(const std::vector<std::string>& others) {
  const auto is_there = [&](const char* topic) { return std::ranges::find(others, topic) != others.end(); };
  const topics::CameraPreset* best = nullptr;
  for (const topics::CameraPreset& preset : topics::kCameraPresets)
    if (is_there(preset.color) && (best == nullptr || (is_there(preset.depth) && !is_there(best->depth))))
      best = &preset;
  return best == nullptr ? "camera.color" : fmt::format("camera.preset to {}, or camera.color", best->name);
}

Fault fault_of_color(const CameraSight& sight) {
  const bool others_come = comes(sight.info) || comes(sight.depth);
  const bool is_there = sight.color.publishers > 0 || !sight.color.other_type.empty();
  const bool is_camera_there =
      others_come || sight.info.publishers > 0 || sight.depth.publishers > 0 || !sight.other_pictures.empty();
  if (sight.color.refused_s >= kSilentS &&
      (is_there ? !others_come && sight.color.other_type.empty() : !is_camera_there))
    return std::nullopt;  // a driver that does nothing yet, or none
  return fault_of(sight.color, sight.other_pictures, color_setting(sight.other_pictures),
                  "switch the driver's colour stream on");
}

Fault fault_of_pairing(const CameraSight& sight) {
  if (!comes(sight.color) || !comes(sight.depth) || sight.info.silent_s == StreamSight::kNever ||
      sight.since_frame_s < kSilentS || !sight.partner_ms)
    return std::nullopt;
  return fmt::format(
      "pictures of {} and {} have no partner: their stamps are {:.0f} ms apart; switch the driver's "
      "synchronisation on (enable_sync:=true), or raise camera.pairing_tolerance_s",
      sight.color.topic, sight.depth.topic, *sight.partner_ms);
}

}  // namespace

std::map<std::string, std::string> camera_faults(const CameraSight& sight) {
  std::map<std::string, std::string> faults;
  const auto note = [&faults](const std::string& name, Fault fault) {
    if (fault) faults.emplace(name, std::move(*fault));
  };
  note("camera colour", fault_of_color(sight));
  const bool is_seen = comes(sight.color);
  if (is_seen && (sight.info.silent_s == StreamSight::kNever || sight.info.refused_s < kSilentS))
    note("camera info",
         fault_of(sight.info, sight.other_infos, "camera.camera_info", "load the camera's calibration"));
  if (is_seen || sight.depth.refused_s < kSilentS)
    note("camera depth", fault_of(sight.depth, sight.other_pictures, "camera.depth",
                                  "switch the driver's depth on (align_depth.enable:=true)"));
  note("camera pairing", fault_of_pairing(sight));
  return faults;
}

std::map<std::string, std::string> FaultFilter::lasting(const std::map<std::string, std::string>& faults,
                                                        Time now) {
  std::erase_if(since_, [&](const auto& entry) { return !faults.contains(entry.first); });
  std::map<std::string, std::string> lasting;
  for (const auto& [name, text] : faults)
    if (now - since_.try_emplace(name, now).first->second >= kLast) lasting.emplace(name, text);
  return lasting;
}

}  // namespace rds::tracker
