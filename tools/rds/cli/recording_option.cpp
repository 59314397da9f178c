// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/cli/recording_option.hpp"

#include <CLI/CLI.hpp>

namespace rds {

CLI::Option* add_recording_option(CLI::App& command, std::filesystem::path& recording) {
  return command.add_option(
      "--dataset,recording", recording,
      "recording: a folder in TUM RGB-D form or of rosbag2, a .mcap or .db3 file, a sequence of "
      "7-Scenes, ICL-NUIM, Replica or ScanNet");
}

}  // namespace rds
