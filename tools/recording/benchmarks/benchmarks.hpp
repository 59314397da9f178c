// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "tools/recording/benchmarks/numbered_recording.hpp"

/// Folders of known benchmarks, which say neither stamps nor, but for ScanNet, the camera.
namespace rds::recording {

using OpenedBenchmark = tl::expected<std::unique_ptr<NumberedRecording>, std::string>;

/// A folder by its layout. @return nothing where it has none of these.
std::optional<OpenedBenchmark> open_benchmark(const std::filesystem::path& folder);

/// A sequence of Microsoft 7-Scenes: frame-NNNNNN.color.png, .depth.png (mm, 65535: none), .pose.txt.
std::optional<OpenedBenchmark> open_seven_scenes(const std::filesystem::path& folder);

/// A sequence of ICL-NUIM in its TUM-compatible form: associations.txt (`number depth number colour`),
/// depth in 1/5000 m, poses in a file *.gt.freiburg.
///
/// Its camera looks along z with y up (f_y = −480). Pictures have y down, so with f_y = 480 the world is
/// mirrored in y, and so are the poses that are read: t_y → −t_y, q_x → −q_x, q_z → −q_z.
std::optional<OpenedBenchmark> open_icl_nuim(const std::filesystem::path& folder);

/// A room of Replica as it was rendered for NICE-SLAM: results/frameNNNNNN.jpg, depthNNNNNN.png (1/6553.5 m),
/// traj.txt, a matrix a line.
std::optional<OpenedBenchmark> open_replica(const std::filesystem::path& folder);

/// A scene of ScanNet as its SensReader exports it: color/N.jpg, depth/N.png (mm), pose/N.txt,
/// intrinsic/intrinsic_color.txt and intrinsic_depth.txt. The picture becomes that of the depth camera.
std::optional<OpenedBenchmark> open_scan_net(const std::filesystem::path& folder);

}  // namespace rds::recording
