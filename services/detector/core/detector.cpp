// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/detector.hpp"

#include <array>

#include <fmt/format.h>

#include "services/detector/core/box_depth.hpp"
#include "services/detector/core/input_transform.hpp"
#include "services/detector/core/non_maximum_suppression.hpp"

namespace rds::detector {
namespace {

/// OpenCV's number of threads is a property of the process: it is set for one scope and put back.
class ThreadScope {
 public:
  explicit ThreadScope(int threads) : before_(cv::getNumThreads()) {
    if (threads != before_) cv::setNumThreads(threads);
  }
  ~ThreadScope() {
    if (cv::getNumThreads() != before_) cv::setNumThreads(before_);
  }
  ThreadScope(const ThreadScope&) = delete;
  ThreadScope& operator=(const ThreadScope&) = delete;

 private:
  int before_;
};

std::unique_ptr<InferenceBackend> open_backend(const Network& network, const DetectorConfig& config) {
  try {
    return make_backend(config, network.weights);
  } catch (const DetectorError& e) {
    throw DetectorError(
        fmt::format("{} ({}): {}", network.description.name, network.description.file, e.what()));
  }
}

SuppressionConfig suppression(const NetworkDescription& network, const DetectorConfig& config) {
  SuppressionConfig suppression;
  suppression.same_label_iou = network.nms_iou;
  suppression.other_label_iou = config.other_label_iou;
  return suppression;
}

}  // namespace

Detector::Detector(const Network& network, const DetectorConfig& config)
    : Detector(network.description, open_backend(network, config), config) {}

Detector::Detector(const NetworkDescription& description, std::unique_ptr<InferenceBackend> backend,
                   const DetectorConfig& config)
    : description_(description),
      config_(config),
      backend_(std::move(backend)),
      decoder_(make_decoder(description)) {
  for (std::string& label : description_.labels) label = config_.labels.name_of(label);
  set_score_threshold(config_.score_threshold);
  check_outputs();
}

void Detector::set_score_threshold(double threshold) {
  config_.score_threshold = threshold > 0 ? threshold : description_.score_threshold;
}

void Detector::check_outputs() {
  const std::array<int, 4> shape{1, 3, description_.input.height, description_.input.width};
  const ThreadScope threads(config_.threads);
  try {
    static_cast<void>(candidates_in(cv::Mat(4, shape.data(), CV_32F, cv::Scalar(0))));
  } catch (const DetectorError& e) {
    throw DetectorError(fmt::format("{} ({}): {}", description_.name, description_.file, e.what()));
  }
}

std::vector<Candidate> Detector::candidates_in(const cv::Mat& input) {
  return decoder_->decode(backend_->infer(input), static_cast<float>(config_.score_threshold));
}

std::vector<Detection> Detector::detect(const image::ColorImage& picture) {
  const cv::Mat& pixels = picture.pixels;
  if (pixels.empty() || pixels.dims != 2 || pixels.type() != CV_8UC3)
    throw DetectorError(fmt::format("picture of {} × {} pixels, type {}: expected an 8-bit colour picture",
                                    pixels.cols, pixels.rows, cv::typeToString(pixels.type())));
  const ThreadScope threads(config_.threads);
  const InputTransform place = place_picture(description_.input, pixels.cols, pixels.rows);
  auto found = candidates_in(make_input(description_.input, place, picture));
  std::vector<Detection> detections;
  for (const Candidate& c : suppress_non_maxima(std::move(found), suppression(description_, config_))) {
    const geometry::Box2 box = place.to_picture(c.box).clipped(pixels.cols, pixels.rows);
    if (box.area() > 0)
      detections.push_back({description_.labels[static_cast<std::size_t>(c.label)], c.score, box, 0});
  }
  return detections;
}

std::vector<Detection> Detector::detect(const image::ColorImage& picture, const image::DepthImage& depth) {
  auto detections = detect(picture);
  for (Detection& detection : detections) detection.depth_m = box_depth(depth, detection.box, config_.max_depth_m);
  return detections;
}

}  // namespace rds::detector
