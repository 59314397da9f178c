// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/outcome.hpp"

#include <stdexcept>

#include "tests/integration/run_support.hpp"
#include "tools/evaluation/map_score.hpp"

namespace rds::test {

Figures figures_of(const RecordingPair& recording, const std::filesystem::path& out,
                   const std::filesystem::path& seen_by) {
  const auto path = score(recording.dataset, out);
  const auto map = evaluation::score_map({.dataset = recording.dataset,
                                          .background = recording.background,
                                          .out = out,
                                          .every = 5,
                                          .seen_by = seen_by});
  if (!map) throw std::runtime_error(map.error());
  return {path["ate_live"].get<double>(), path["ate_final"].get<double>(), map->static_recall};
}

}  // namespace rds::test
