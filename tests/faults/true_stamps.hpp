// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "tools/rds/run/results/recording.hpp"

namespace rds::test {

/// A recording of a camera whose clock was set, with the stamps that the frames have in the data set.
/// @param true_stamps  by the stamp that was sent; others stay.
run::Recording with_true_stamps(const run::Recording& recording,
                                const std::map<std::int64_t, std::int64_t>& true_stamps);

}  // namespace rds::test
