// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/map_file/joint_save.hpp"
#include "common/service/service.hpp"
#include "services/tracker/resume_watch.hpp"
#include "services/tracker/tracker_checkpoints.hpp"
#include "services/tracker/tracker_service_config.hpp"

namespace rds::tracker {

/// The life of the tracker's map: how it begins (empty, from a saved map, or from the checkpoint of an
/// earlier process), what of it lasts, and when it is given up. Used by one thread.
class MapEpoch {
 public:
  /// @param tracker  whose map it is; has to outlive this.
  /// @throws std::runtime_error with one sentence if the settings' map_file cannot be used.
  MapEpoch(service::ServiceContext& context, const TrackerServiceConfig& config, Tracker& tracker);

  [[nodiscard]] std::uint64_t id() const { return epoch_.map_epoch; }
  /// The loop closer's corrections that the map contains.
  [[nodiscard]] const LoopState& loops() const { return epoch_.loops; }
  /// A loop was closed in the map. A checkpoint is due at once: without it, it would not fit the mapper's.
  void set_loops(const LoopState& loops);
  void note_keyframe() { checkpoints_.schedule().note_keyframe(); }

  /// True while the camera has not found itself yet in the map of an earlier process.
  [[nodiscard]] bool is_resuming() const { return resume_.is_looking(); }
  /// True if the map is to be given up: too young to be missed, or of an earlier process and not of this
  /// place or of this camera.
  [[nodiscard]] bool is_over(const image::RgbdFrame& frame, const FrameResult& result);
  [[nodiscard]] bool is_of_another_camera(const image::RgbdFrame& frame) const;

  /// Begins another epoch: in the saved map if there is one, else in an empty map.
  void renew();
  /// The same in this saved map, which later ones begin in, too.
  void renew_in(SavedMap start);

  void save_if_due();
  void save() { checkpoints_.save(tracker_, epoch_); }
  /// The tracker's part of a saved map, and what is in it.
  [[nodiscard]] map_file::MapPart part() const;
  [[nodiscard]] std::string description() const;

 private:
  void start_map();
  void resume();

  Tracker& tracker_;
  ExtractionConfig extraction_;
  bool is_read_only_;  // what is saved is the map that the epoch began with
  TrackerCheckpoints::Epoch epoch_;
  std::optional<SavedMap> start_;  // that every epoch begins in
  TrackerCheckpoints checkpoints_;
  ResumeWatch resume_;
};

}  // namespace rds::tracker
