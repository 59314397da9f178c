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
  std::unique_ptr<InferenceBackend> (*make)(Onnx onnx, int threads);
};

constexpr std::array kBuiltIn{
#ifdef RDS_HAS_OPENVINO
    Backend{"openvino", make_openvino_backend},
#endif
    Backend{"opencv", [](Onnx onnx, int /*threads*/) { return make_opencv_backend(onnx); }},
};

}  // namespace

std::vector<std::string> backends() {
  std::vector<std::string> names;
  for (const Backend& backend : kBuiltIn) names.emplace_back(backend.name);
  return names;
}

std::unique_ptr<InferenceBackend> make_backend(const std::string& name, Onnx onnx, int threads) {
  if (name.empty()) return kBuiltIn.front().make(onnx, threads);
  const auto* backend = std::ranges::find(kBuiltIn, name, &Backend::name);
  if (backend == kBuiltIn.end())
    throw DetectorError(fmt::format("backend '{}' is not built into this program, expected one of: {}", name,
                                    fmt::join(backends(), ", ")));
  return backend->make(onnx, threads);
}

}  // namespace rds::detector
