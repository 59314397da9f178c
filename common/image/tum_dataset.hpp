// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/image/camera_yaml.hpp"
#include "common/image/recording.hpp"
#include "common/image/tum_list.hpp"

namespace rds::image {

struct TumDatasetOptions {
  std::int64_t pairing_tolerance_ns = kPairingToleranceNs;
};

/// A folder in TUM RGB-D form: rgb.txt, depth.txt, optional groundtruth.txt, optional camera.yaml; of our
/// own, odometry.txt, a trajectory of the camera, and imu.txt (read_imu()).
class TumDataset final : public Recording {
 public:
  /// Reads lists, ground truth, camera and sensors, and pairs colour with depth; opens no picture. A colour
  /// picture without a partner is a frame without depth.
  ///
  /// @return or one sentence that names the file, the line and what was expected: missing folder or list,
  /// malformed line, stamps that go backwards, colour and depth that never pair, bad camera.yaml, unknown
  /// camera.
  static tl::expected<TumDataset, std::string> open(const std::filesystem::path& folder,
                                                    const TumDatasetOptions& options = {});

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const TumList& color_list() const { return color_; }
  [[nodiscard]] const TumList& depth_list() const { return depth_; }

  [[nodiscard]] std::vector<std::filesystem::path> missing() const override;
  [[nodiscard]] tl::expected<ColorImage, std::string> load_color(std::size_t index) const override;
  /// 16 bit, with 1/depth_scale metres per unit.
  [[nodiscard]] tl::expected<DepthImage, std::string> load_depth(std::size_t index) const override;

 private:
  TumDataset() = default;
  tl::expected<void, std::string> read_camera();
  tl::expected<void, std::string> read_sensors();
  tl::expected<void, std::string> pair_lists(const TumDatasetOptions& options);

  std::filesystem::path folder_;
  TumList color_;
  TumList depth_;
};

}  // namespace rds::image
