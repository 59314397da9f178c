// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "tests/fuzz/mutation.hpp"

namespace rds::fuzz {

/// Feeds spoiled seeds to a reader, which says whether it accepted them, and fails where one takes more
/// memory at once than `bound` gives for that many bytes. Says how many were accepted.
///
/// @param share_percent  of all inputs: of a million, or of what RDS_FUZZ_INPUTS says.
void feed(std::size_t share_percent, const std::vector<Bytes>& seeds,
          const std::function<std::size_t(std::size_t)>& bound,
          const std::function<bool(const Bytes&)>& read);

}  // namespace rds::fuzz
