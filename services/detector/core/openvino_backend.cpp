// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <openvino/openvino.hpp>

#include "services/detector/core/detection.hpp"
#include "services/detector/core/inference_backend.hpp"

namespace rds::detector {
namespace {

/// The sentence at the end of OpenVINO's message; the lines before it name places in its source.
std::string reason(const std::exception& e) {
  std::string text = e.what();
  text.erase(text.find_last_not_of(" \n") + 1);
  const auto line = text.find_last_of('\n');
  return line == std::string::npos ? text : text.substr(line + 1);
}

std::string name_and_version() {
  const std::string build = ov::get_openvino_version().buildNumber;  // 2026.4.1-22982-…
  return "OpenVINO " + build.substr(0, build.find('-'));
}

/// One picture at a time, on threads that the system places. The precision is said, because OpenVINO by
/// itself takes the processor's fastest.
ov::AnyMap settings(const DetectorConfig& config) {
  return {ov::hint::performance_mode(ov::hint::PerformanceMode::LATENCY),
          ov::hint::inference_precision(config.precision == "bf16" ? ov::element::bf16 : ov::element::f32),
          ov::hint::enable_cpu_pinning(false), ov::inference_num_threads(config.threads), ov::num_streams(1)};
}

ov::CompiledModel compile(std::span<const unsigned char> onnx, const DetectorConfig& config) {
  try {
    ov::Core core;
    const std::string content(onnx.begin(), onnx.end());
    return core.compile_model(core.read_model(content, ov::Tensor()), "CPU", settings(config));
  } catch (const std::exception& e) {
    throw DetectorError(fmt::format("the network is not an ONNX graph that {} can compute: {}",
                                    name_and_version(), reason(e)));
  }
}

class OpenVinoBackend final : public InferenceBackend {
 public:
  OpenVinoBackend(std::span<const unsigned char> onnx, const DetectorConfig& config)
      : network_(compile(onnx, config)), request_(network_.create_infer_request()) {}

  std::vector<NamedTensor> infer(const cv::Mat& input) override {
    try {
      const ov::Shape shape(input.size.p, input.size.p + input.dims);
      request_.set_input_tensor(ov::Tensor(ov::element::f32, shape, input.data));
      request_.infer();
      return outputs();
    } catch (const std::exception& e) {
      throw DetectorError(fmt::format("the network cannot be computed: {}", reason(e)));
    }
  }

  [[nodiscard]] std::string library() const override { return name_and_version(); }

 private:
  /// Views of the request's own memory.
  std::vector<NamedTensor> outputs() {
    std::vector<NamedTensor> all;
    for (const auto& port : network_.outputs()) {
      ov::Tensor tensor = request_.get_tensor(port);
      const std::vector<int> shape(tensor.get_shape().begin(), tensor.get_shape().end());
      all.push_back({port.get_any_name(), cv::Mat(shape, CV_32F, tensor.data<float>())});
    }
    return all;
  }

  ov::CompiledModel network_;
  ov::InferRequest request_;
};

}  // namespace

std::unique_ptr<InferenceBackend> make_openvino_backend(std::span<const unsigned char> onnx,
                                                        const DetectorConfig& config) {
  return std::make_unique<OpenVinoBackend>(onnx, config);
}

}  // namespace rds::detector
