// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace rds::detector {

/// The one spelling of a label that leaves the detector: VOC's where VOC and COCO name the same thing
/// differently
/// ("tv" → "tvmonitor", "couch" → "sofa", …); every other label is returned unchanged.
std::string canonical_label(std::string_view label);

}  // namespace rds::detector
