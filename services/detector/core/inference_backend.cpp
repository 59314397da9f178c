// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/inference_backend.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "services/detector/core/detection.hpp"

namespace rds::detector {
namespace {

using Onnx = std::span<const unsigned char>;

struct Backend {
  const char* name;
  std::unique_ptr<InferenceBackend> (*make)(Onnx onnx, const DetectorConfig& config);
};

std::unique_ptr<InferenceBackend> make_opencv(Onnx onnx, const DetectorConfig& config) {
  if (config.precision != "f32")
    throw DetectorError(fmt::format("precision {}: backend 'opencv' computes in f32 only", config.precision));
  return make_opencv_backend(onnx);
}

constexpr std::array kBuiltIn{
#ifdef RDS_HAS_OPENVINO
    Backend{"openvino", make_openvino_backend},
#endif
    Backend{"opencv", make_opencv},
};

}  // namespace

std::vector<std::string> backends() {
  std::vector<std::string> names;
  names.reserve(kBuiltIn.size());
  for (const Backend& backend : kBuiltIn) names.emplace_back(backend.name);
  return names;
}

std::unique_ptr<InferenceBackend> make_backend(const DetectorConfig& config, Onnx onnx) {
  if (config.backend.empty()) return kBuiltIn.front().make(onnx, config);
  const auto* backend = std::ranges::find(kBuiltIn, config.backend, &Backend::name);
  if (backend == kBuiltIn.end())
    throw DetectorError(fmt::format("backend '{}' is not built into this program, expected one of: {}",
                                    config.backend, fmt::join(backends(), ", ")));
  return backend->make(onnx, config);
}

}  // namespace rds::detector
