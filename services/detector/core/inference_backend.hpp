// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "services/detector/core/detector_config.hpp"

namespace rds::detector {

struct NamedTensor {
  std::string name;
  cv::Mat values;  // CV_32F, continuous, N-dimensional
};

/// Runs one network. The only seam to an inference library; each library is one implementation.
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

  /// The library and its version.
  [[nodiscard]] virtual std::string library() const = 0;
};

/// Names of the back ends that this program holds, the default first: openvino where it was found when this
/// was built, and opencv always.
std::vector<std::string> backends();

/// @param config  its backend (one of backends(); empty: the first), threads and precision.
/// @param onnx    content of the ONNX file.
/// @throws DetectorError if the library is not built in, does not compute in that precision, or cannot read
/// the network.
std::unique_ptr<InferenceBackend> make_backend(const DetectorConfig& config,
                                               std::span<const unsigned char> onnx);

/// OpenCV's DNN module on the CPU. It computes on as many threads as cv::setNumThreads() says at the time.
///
/// @throws DetectorError if `onnx` is no network OpenCV can read.
std::unique_ptr<InferenceBackend> make_opencv_backend(std::span<const unsigned char> onnx);

/// OpenVINO on the CPU. Only where it is built in.
///
/// @param config  its threads, and its precision: "f32", so that it finds what OpenCV finds, or "bf16", which
/// is
///                faster where the processor has it.
/// @throws DetectorError if `onnx` is no network OpenVINO can read.
std::unique_ptr<InferenceBackend> make_openvino_backend(std::span<const unsigned char> onnx,
                                                        const DetectorConfig& config);

}  // namespace rds::detector
