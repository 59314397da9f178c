// SPDX-License-Identifier: Apache-2.0
// The part of Tracker that goes on in a saved map, and writes and reads checkpoints.
#include "common/map_file/byte_reader.hpp"
#include "services/tracker/core/features/feature_bytes.hpp"
#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

constexpr const char* kCamera = "camera";

/// What is known of the camera, and of its time.
struct CameraState {
  double given_fx = 0;
  ImagingBelief belief;
  std::optional<time::ContinuousTime::Mark> clock;
};

void put(ByteWriter& writer, const CameraState& state) {
  writer.put(state.given_fx);
  for (const double v : state.belief.value) writer.put(v);
  for (const double v : state.belief.information.reshaped()) writer.put(v);
  writer.put(static_cast<std::uint8_t>(state.belief.readout_is_wrong));
  writer.put(static_cast<std::uint8_t>(state.belief.focal_is_wrong));
  writer.put(state.belief.focal_bundles);
  writer.put(static_cast<std::uint8_t>(state.clock.has_value()));
  writer.put(state.clock ? state.clock->stamp_ns : 0);
  writer.put(state.clock ? state.clock->time_ns : 0);
}

CameraState get_camera_state(ByteReader& reader) {
  CameraState state;
  state.given_fx = reader.get<double>();
  for (double& v : state.belief.value) v = reader.get<double>();
  for (double& v : state.belief.information.reshaped()) v = reader.get<double>();
  state.belief.readout_is_wrong = reader.get<std::uint8_t>() != 0;
  state.belief.focal_is_wrong = reader.get<std::uint8_t>() != 0;
  state.belief.focal_bundles = reader.get<int>();
  const bool has_clock = reader.get<std::uint8_t>() != 0;
  time::ContinuousTime::Mark mark;
  mark.stamp_ns = reader.get<std::int64_t>();
  mark.time_ns = reader.get<std::int64_t>();
  if (has_clock) state.clock = mark;
  return state;
}

}  // namespace

void Tracker::start_from(SavedMap&& saved) {
  reset();
  if (saved.map.keyframes().size() == 0) return mapper_.start_from(std::move(saved.map), false);
  calibration_.begin_with(saved.camera);
  saved.map.keyframes().for_each([&](Keyframe& k) { k.time_ns = time_.go_to(k.stamp_ns).time_ns; });
  drift_.forget();
  mapper_.start_from(std::move(saved.map), false);
  localizer_.relocalizer().index_all(mapper_.map());
  state_ = State::kLost;
}

std::vector<CheckpointRow> Tracker::checkpoint() {
  std::vector<CheckpointRow> rows;
  mapper_.append_checkpoint(rows);
  ByteWriter writer;
  put_pyramid(writer, config_.extraction);
  put(writer, {calibration_.given_fx(), calibration_.belief(), time_.newest()});
  rows.push_back({kCamera, 0, writer.take()});
  return rows;
}

tl::expected<void, std::string> Tracker::resume(const ReadRows& read) {
  CameraState camera;
  std::string fault = "no camera";
  const auto done = read(kCamera, [&](std::uint64_t, std::span<const std::uint8_t> bytes) {
    ByteReader reader(bytes);
    expect_pyramid(reader, config_.extraction);
    camera = get_camera_state(reader);
    const auto whole = reader.finish();
    fault = whole ? "" : whole.error();
  });
  if (!done) return tl::unexpected(done.error());
  if (!fault.empty()) return tl::unexpected(fault);
  auto map = map_from_rows(read, localizer_.settings().pyramid);
  if (!map) return tl::unexpected(map.error());
  reset();
  drift_.forget();
  mapper_.start_from(std::move(*map), true);
  calibration_.begin_with(camera.given_fx, camera.belief);
  time_ = time::ContinuousTime(camera.clock);
  localizer_.relocalizer().index_all(mapper_.map());
  if (mapper_.map().keyframes().size() > 0) state_ = State::kLost;
  return {};
}

}  // namespace rds::tracker
