// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/core/transformer_config.hpp"

namespace rds::transformer {
namespace {
constexpr double kMaxThicknessM = 10;
}

void read(config::ConfigReader& reader, TransformerConfig& config) {
  reader.value("min_depth_m", config.min_depth_m, 0.01, 100.0, "m");
  reader.value("max_depth_m", config.max_depth_m, 0.01, 1000.0, "m");
  reader.value("default_thickness_m", config.default_thickness_m, 0.01, kMaxThicknessM, "m");
  std::map<std::string, double> by_label(config.thickness_m.begin(), config.thickness_m.end());
  reader.value("thickness_m", by_label);
  config.thickness_m.clear();
  for (const auto& [label, thickness] : by_label) {
    if (thickness > 0 && thickness <= kMaxThicknessM)
      config.thickness_m.emplace(label, thickness);
    else
      reader.violation("thickness_m." + label, fmt::format("{}", thickness),
                       fmt::format("expected more than 0, at most {} m", kMaxThicknessM));
  }
  if (config.min_depth_m >= config.max_depth_m)
    reader.violation("min_depth_m", fmt::format("{}", config.min_depth_m), "expected less than max_depth_m");
}

double thickness_m(const TransformerConfig& config, std::string_view label) {
  const auto found = config.thickness_m.find(label);
  return found == config.thickness_m.end() ? config.default_thickness_m : found->second;
}

}  // namespace rds::transformer
