// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/features/feature_bytes.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace rds::tracker {
namespace {

enum Flag : std::uint8_t { kMovable = 1, kMatchable = 2, kMovableNow = 4, kAllFlags = 7 };

}  // namespace

void put_pyramid(map_file::ByteWriter& writer, const ExtractionConfig& extraction) {
  writer.put(extraction.levels);
  writer.put(extraction.scale_factor);
}

ExtractionConfig get_pyramid(map_file::ByteReader& reader) {
  ExtractionConfig extraction;
  extraction.levels = reader.get<int>();
  extraction.scale_factor = reader.get<double>();
  const bool is_possible = extraction.levels >= 1 && extraction.levels <= ExtractionConfig::kMostLevels &&
                           extraction.scale_factor >= ExtractionConfig::kMinFactor &&
                           extraction.scale_factor <= ExtractionConfig::kMaxFactor;
  if (!is_possible)
    reader.refuse(
        fmt::format("features of {} levels with factor {}", extraction.levels, extraction.scale_factor));
  return extraction;
}

void expect_pyramid(map_file::ByteReader& reader, const ExtractionConfig& extraction) {
  const auto levels = reader.get<int>();
  const auto factor = reader.get<double>();
  if (levels != extraction.levels || factor != extraction.scale_factor)
    reader.refuse(fmt::format("features of {} levels with factor {}, expected {} with factor {}", levels,
                              factor, extraction.levels, extraction.scale_factor));
}

void put(map_file::ByteWriter& writer, const Feature& feature, bool movable_now) {
  for (const float value : {feature.px.x(), feature.px.y(), feature.image_px.x(), feature.image_px.y(),
                            feature.angle_rad, feature.depth_m})
    writer.put(value);
  writer.put(feature.level);
  writer.put(static_cast<std::uint8_t>((feature.movable ? kMovable : 0) |
                                       (feature.matchable ? kMatchable : 0) |
                                       (movable_now ? kMovableNow : 0)));
  writer.put_bytes(feature.descriptor);
}

Feature get_feature(map_file::ByteReader& reader, int levels, bool& movable_now) {
  Feature feature;
  for (float* value : {&feature.px.x(), &feature.px.y(), &feature.image_px.x(), &feature.image_px.y(),
                       &feature.angle_rad, &feature.depth_m})
    *value = reader.get<float>();
  feature.level = reader.get<std::uint8_t>();
  const auto flags = reader.get<std::uint8_t>();
  feature.movable = (flags & kMovable) != 0;
  feature.matchable = (flags & kMatchable) != 0;
  movable_now = (flags & kMovableNow) != 0;
  const auto descriptor = reader.get_bytes(sizeof(Descriptor));
  std::ranges::copy(descriptor, feature.descriptor.begin());
  if (feature.level >= levels || feature.depth_m < 0 || flags > kAllFlags)
    reader.refuse("a feature with impossible values");
  return feature;
}

}  // namespace rds::tracker
