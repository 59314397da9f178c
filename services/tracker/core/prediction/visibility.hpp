// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "services/tracker/core/prediction/tracked_object.hpp"

namespace rds::tracker::prediction {

/// Whether a detector that finds its objects should have found one here: at least half of the box lies in the
/// picture, and no detected object stands nearer in front of at least half of that.
bool should_be_detected(const geometry::OrientedBox& box, std::span<const ObjectObservation> detected,
                        const KeyframeView& view);

/// True for a box of nearly the whole picture with a low score: networks find such where there is nothing,
/// and with it all features would be dropped.
bool is_implausible(const ObjectObservation& observation, const KeyframeView& view);

}  // namespace rds::tracker::prediction
