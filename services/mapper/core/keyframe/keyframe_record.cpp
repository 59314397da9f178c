// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/keyframe/keyframe_record.hpp"

#include <algorithm>
#include <cmath>

#include "common/image/cell_mask.hpp"

namespace rds::mapper {
namespace {

constexpr int kMaxSide = 8192;

int sampled(int pixels, int stride) {
  return (pixels + stride - 1) / stride;
}

void sample_pixels(const KeyframeInput& input, KeyframeRecord& record) {
  const int first = input.color.order == image::ChannelOrder::kRgb ? 0 : 2;
  for (int row = 0, i = 0; row < record.grid.height; ++row)
    for (int column = 0; column < record.grid.width; ++column, ++i) {
      const int x = column * record.grid.stride;
      const int y = row * record.grid.stride;
      const auto index = static_cast<std::size_t>(i);
      record.depth_tenth_mm[index] = to_tenth_mm(input.depth.at(x, y));
      const auto& pixel = input.color.pixels.at<cv::Vec3b>(y, x);
      record.rgb[3 * index] = pixel[first];
      record.rgb[3 * index + 1] = pixel[1];
      record.rgb[3 * index + 2] = pixel[2 - first];
    }
}

}  // namespace

std::uint16_t to_tenth_mm(float depth_m) {
  return static_cast<std::uint16_t>(std::min(65535.0F, std::round(depth_m * kTenthMmPerM)));
}

std::shared_ptr<const std::vector<Eigen::Vector3f>> sample_rays(const geometry::CameraModel& camera,
                                                                int stride_px) {
  auto rays = std::make_shared<std::vector<Eigen::Vector3f>>();
  rays->reserve(
      static_cast<std::size_t>(sampled(camera.width, stride_px) * sampled(camera.height, stride_px)));
  for (int y = 0; y < camera.height; y += stride_px)
    for (int x = 0; x < camera.width; x += stride_px)
      rays->push_back(camera.ray(Eigen::Vector2d(x, y)).cast<float>());
  return rays;
}

std::optional<std::string> check(const KeyframeInput& input) {
  const auto& camera = input.camera;
  if (!camera.is_valid() || camera.width > kMaxSide || camera.height > kMaxSide)
    return fmt::format("keyframe {}: the camera model is not valid", input.id);
  if (!geometry::is_finite(input.map_from_camera))
    return fmt::format("keyframe {}: the pose is not finite", input.id);
  const cv::Size size(camera.width, camera.height);
  if (input.color.pixels.size() != size || input.color.pixels.type() != CV_8UC3)
    return fmt::format("keyframe {}: expected a colour picture of {}×{} with 3 × 8 bit", input.id, size.width,
                       size.height);
  const int depth_type = input.depth.values.type();
  if (input.depth.values.size() != size || (depth_type != CV_16UC1 && depth_type != CV_32FC1))
    return fmt::format("keyframe {}: expected a depth picture of {}×{} with 16 bit or float", input.id,
                       size.width, size.height);
  if (!(input.depth.metres_per_unit > 0) || !std::isfinite(input.depth.metres_per_unit))
    return fmt::format("keyframe {}: the depth unit is not positive", input.id);
  if (!input.movable_cells.empty() && image::cell_side_px(size, input.movable_cells.size()) == 0)
    return fmt::format("keyframe {}: expected cells that cover a picture of {}×{}", input.id, size.width,
                       size.height);
  return std::nullopt;
}

KeyframeRecord make_record(const KeyframeInput& input, const SamplingConfig& config,
                           std::shared_ptr<const std::vector<Eigen::Vector3f>> rays) {
  KeyframeRecord record;
  record.id = input.id;
  record.stamp_ns = record.time_ns = input.stamp_ns;
  record.map_from_camera = input.map_from_camera;
  record.grid.camera = input.camera;
  record.grid.stride = config.stride_px;
  record.grid.width = sampled(input.camera.width, config.stride_px);
  record.grid.height = sampled(input.camera.height, config.stride_px);
  record.grid.rays = std::move(rays);
  record.movable.cells = input.movable_cells.clone();
  record.movable.side_px =
      image::cell_side_px({input.camera.width, input.camera.height}, input.movable_cells.size());
  const auto count =
      static_cast<std::size_t>(record.grid.width) * static_cast<std::size_t>(record.grid.height);
  record.depth_tenth_mm.resize(count);
  record.rgb.resize(3 * count);
  record.classes.resize(count);
  sample_pixels(input, record);
  return record;
}

bool is_in_movable_cell(const KeyframeRecord& record, std::size_t pixel) {
  if (record.movable.side_px == 0) return false;
  const int row = record.grid.row(pixel) * record.grid.stride / record.movable.side_px;
  const int column = record.grid.column(pixel) * record.grid.stride / record.movable.side_px;
  return record.movable.cells(row, column) != 0;
}

}  // namespace rds::mapper
