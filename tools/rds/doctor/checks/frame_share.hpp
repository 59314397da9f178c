// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/geometry/stamp.hpp"
#include "tools/rds/doctor/checks/finding.hpp"
#include "tools/rds/doctor/checks/frame_look.hpp"

namespace rds::doctor {

/// A finding about frames of a kind of which there should be none: a hint for a few, a fault for more than a
/// tenth.
///
/// @param what  completes `3 of 20 frames …`.
/// @param is_bad  predicate of a frame.
template <class IsBad>
Finding share_of(const std::vector<FrameLook>& frames, const std::string& subject, const std::string& what,
                 IsBad is_bad) {
  constexpr double kMany = 0.1;
  const auto bad = std::ranges::count_if(frames, is_bad);
  if (bad == 0) return {Verdict::kGood, subject, fmt::format("none of {} frames", frames.size())};
  const double share = static_cast<double>(bad) / static_cast<double>(frames.size());
  const auto first = std::ranges::find_if(frames, is_bad);
  return {share > kMany ? Verdict::kFault : Verdict::kHint, subject,
          fmt::format("{} of {} frames ({:.1f} %) {}; the first at {} s", bad, frames.size(), 100 * share,
                      what, geometry::format_stamp(first->stamp_ns))};
}

}  // namespace rds::doctor
