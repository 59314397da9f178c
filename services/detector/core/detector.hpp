// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "common/image/rgbd_frame.hpp"
#include "services/detector/core/decoder.hpp"
#include "services/detector/core/detection.hpp"
#include "services/detector/core/detector_config.hpp"
#include "services/detector/core/inference_backend.hpp"

namespace rds::detector {

/// A network's description and the content of its file.
struct Network {
  NetworkDescription description;
  std::vector<unsigned char> weights;
};

/// Finds objects in single pictures. Not thread-safe.
///
/// The same picture, back end and number of threads give the same detections, bit by bit; another
/// DetectorConfig::threads may change the last digits, because sums are then divided at other places.
class Detector {
 public:
  /// Reads the network and computes it once on an empty picture.
  /// @throws DetectorError if it cannot be computed or does not have the outputs that its description
  /// promises.
  explicit Detector(const Network& network, const DetectorConfig& config = {});
  /// With another inference library.
  Detector(const NetworkDescription& description, std::unique_ptr<InferenceBackend> backend,
           const DetectorConfig& config = {});

  /// @return objects with boxes in the picture's pixels, best score first; depth_m is 0.
  /// @throws DetectorError if the picture is empty or not 8-bit with three channels.
  [[nodiscard]] std::vector<Detection> detect(const image::ColorImage& picture);

  /// detect(), and the depth of each box from the depth picture that belongs to it.
  [[nodiscard]] std::vector<Detection> detect(const image::ColorImage& picture,
                                              const image::DepthImage& depth);

  [[nodiscard]] const NetworkDescription& network() const { return description_; }
  /// From the next picture on. @param threshold  0: the network's own.
  void set_score_threshold(double threshold);
  /// The inference library and its version.
  [[nodiscard]] std::string library() const { return backend_->library(); }

 private:
  void check_outputs();
  [[nodiscard]] std::vector<Candidate> candidates_in(const cv::Mat& input);

  NetworkDescription description_;
  DetectorConfig config_;
  std::unique_ptr<InferenceBackend> backend_;
  std::unique_ptr<Decoder> decoder_;
};

}  // namespace rds::detector
