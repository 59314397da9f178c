// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "common/geometry/box.hpp"

namespace rds::detector {

/// One object found in a picture.
struct Detection {
  std::string label;   // VOC spelling, see canonical_label()
  float score = 0;     // 0 … 1
  geometry::Box2 box;  // [px] of the picture, clipped to it
  float depth_m = 0;   // of the object's surface; 0 = unknown
};

/// What makes detection impossible (network missing, altered or of another shape; picture unusable), in one
/// sentence.
class DetectorError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace rds::detector
