// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace rds::run {

/// Where a run writes: a folder beside the wanted one, which takes its name only when everything is written.
///
/// So a run that was broken off leaves nothing that looks like a result.
class OutputFolder {
 public:
  /// @param force  an earlier run at `wanted` (a folder with summary.json) is replaced.
  /// @throws std::runtime_error with one sentence if it exists and is not empty, or cannot be written.
  OutputFolder(const std::filesystem::path& wanted, bool force);
  /// Removes what was written unless it was published.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return partial_; }

  /// Gives the folder its final name. An earlier run is there until then, and removed afterwards.
  /// @throws std::runtime_error with one sentence; the earlier run is then left as it was.
  void publish();

 private:
  std::filesystem::path wanted_;
  std::filesystem::path partial_;
  bool published_ = false;
};

}  // namespace rds::run
