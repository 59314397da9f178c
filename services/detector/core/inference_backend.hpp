// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace rds::detector {

struct NamedTensor {
  std::string name;
  cv::Mat values;  // CV_32F, continuous, N-dimensional
};

/// Runs one network. The only seam to an inference library; a second library is a second implementation.
class InferenceBackend {
 public:
  InferenceBackend() = default;
  InferenceBackend(const InferenceBackend&) = delete;
  InferenceBackend& operator=(const InferenceBackend&) = delete;
  virtual ~InferenceBackend() = default;

  /// @param input  1×3×H×W, CV_32F.
  /// @return every output of the network; valid until the next call.
  /// @throws DetectorError if the network cannot be computed.
  virtual std::vector<NamedTensor> infer(const cv::Mat& input) = 0;
};

/// OpenCV's DNN module on the CPU.
///
/// @param onnx  content of the ONNX file.
/// @throws DetectorError if that is no network OpenCV can read.
std::unique_ptr<InferenceBackend> make_opencv_backend(std::span<const unsigned char> onnx);

}  // namespace rds::detector
