// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <opencv2/dnn.hpp>

#include "services/detector/core/detection.hpp"
#include "services/detector/core/inference_backend.hpp"

namespace rds::detector {
namespace {

cv::dnn::Net read_onnx(std::span<const unsigned char> onnx) {
  try {
    cv::dnn::Net net = cv::dnn::readNetFromONNX(reinterpret_cast<const char*>(onnx.data()), onnx.size());
    if (net.empty()) throw DetectorError("the network is empty");
    net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    return net;
  } catch (const cv::Exception& e) {
    throw DetectorError(
        fmt::format("the network is not an ONNX graph that OpenCV {} can read: {}", CV_VERSION, e.err));
  }
}

class OpenCvBackend final : public InferenceBackend {
 public:
  explicit OpenCvBackend(std::span<const unsigned char> onnx)
      : net_(read_onnx(onnx)), names_(net_.getUnconnectedOutLayersNames()) {}

  std::vector<NamedTensor> infer(const cv::Mat& input) override {
    try {
      net_.setInput(input);
      net_.forward(values_, names_);
    } catch (const cv::Exception& e) {
      throw DetectorError(fmt::format("the network cannot be computed: {}", e.err));
    }
    std::vector<NamedTensor> outputs;
    outputs.reserve(values_.size());
    for (std::size_t i = 0; i < values_.size(); ++i) outputs.push_back({names_[i], values_[i]});
    return outputs;
  }

  [[nodiscard]] std::string library() const override { return "OpenCV " CV_VERSION; }

 private:
  cv::dnn::Net net_;
  std::vector<std::string> names_;
  std::vector<cv::Mat> values_;
};

}  // namespace

std::unique_ptr<InferenceBackend> make_opencv_backend(std::span<const unsigned char> onnx) {
  return std::make_unique<OpenCvBackend>(onnx);
}

}  // namespace rds::detector
