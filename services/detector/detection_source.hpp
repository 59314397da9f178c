// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/image/rgbd_frame.hpp"
#include "services/detector/core/detector.hpp"

namespace rds::detector {

/// Where the boxes of a keyframe come from.
class DetectionSource {
 public:
  virtual ~DetectionSource() = default;
  /// @throws DetectorError for a picture that cannot be used.
  virtual std::vector<Detection> detections(const image::RgbdFrame& frame) = 0;
  /// @param threshold  of the network; 0: its own. Recorded boxes have been through theirs.
  virtual void set_score_threshold(double /*threshold*/) {}
};

/// The network.
class NetworkSource : public DetectionSource {
 public:
  NetworkSource(const Network& network, const DetectorConfig& config) : detector_(network, config) {}
  std::vector<Detection> detections(const image::RgbdFrame& frame) override {
    return detector_.detect(frame.color, frame.depth);
  }
  void set_score_threshold(double threshold) override { detector_.set_score_threshold(threshold); }
  [[nodiscard]] std::string library() const { return detector_.library(); }

 private:
  Detector detector_;
};

/// A recorded detections.jsonl, or a truth file people.json ("frames" with timestamp, people, box and
/// distance).
///
/// A keyframe gets the boxes of the record with the nearest stamp within 5 ms, or none. Boxes without a depth
/// get it from the keyframe's depth picture, where it is at most `max_depth_m`.
class RecordedSource : public DetectionSource {
 public:
  /// @throws DetectorError naming the file and line that is not understood.
  RecordedSource(const std::filesystem::path& file, double max_depth_m);
  std::vector<Detection> detections(const image::RgbdFrame& frame) override;

 private:
  std::map<std::int64_t, std::vector<Detection>> by_stamp_;
  double max_depth_m_;
};

}  // namespace rds::detector
