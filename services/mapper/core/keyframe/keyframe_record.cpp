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

/// @tparam Value  of the depth picture.
template <class Value>
void sample_depths(const image::DepthImage& depth, KeyframeRecord& record) {
  std::uint16_t* to = record.depth_tenth_mm.data();
  for (int row = 0; row < record.grid.height; ++row) {
    const Value* from = depth.values.ptr<Value>(row * record.grid.stride);
    for (int column = 0; column < record.grid.width; ++column, from += record.grid.stride) {
      const auto raw = static_cast<float>(*from);
      *to++ = std::isfinite(raw) && raw > 0 ? to_tenth_mm(raw * depth.metres_per_unit) : std::uint16_t{0};
    }
  }
}

void sample_colors(const image::ColorImage& color, KeyframeRecord& record) {
  const int first = color.order == image::ChannelOrder::kRgb ? 0 : 2;
  std::uint8_t* to = record.rgb.data();
  for (int row = 0; row < record.grid.height; ++row) {
    const std::uint8_t* from = color.pixels.ptr(row * record.grid.stride);
    for (int column = 0; column < record.grid.width; ++column, from += 3 * record.grid.stride) {
      *to++ = from[first];
      *to++ = from[1];
      *to++ = from[2 - first];
    }
  }
}

}  // namespace

std::uint16_t to_tenth_mm(float depth_m) {
  const float scaled = std::min(65535.0F, depth_m * kTenthMmPerM);
  const auto below = static_cast<std::uint16_t>(scaled);
  return static_cast<std::uint16_t>(below + (scaled - below >= 0.5F ? 1 : 0));  // std::round() is a call
}

SampledRays::SampledRays(const geometry::CameraModel& camera, const SamplingConfig& config)
    : cells_(camera, config.depth_noise, config.stride_px), surface_steps_(config.depth_noise) {
  const int stride_px = config.stride_px;
  rays_.reserve(
      static_cast<std::size_t>(sampled(camera.width, stride_px) * sampled(camera.height, stride_px)));
  for (int y = 0; y < camera.height; y += stride_px)
    for (int x = 0; x < camera.width; x += stride_px) {
      const Eigen::Vector3f& ray = rays_.emplace_back(camera.ray(Eigen::Vector2d(x, y)).cast<float>());
      if (is_used(ray))
        extent_.extend(ray.head<2>());
      else
        are_all_used_ = false;
    }
}

cv::Rect PixelGrid::inside(const geometry::Box2& box) const {
  const auto first_from = [&](double px, int count) {
    int i = 0;
    while (i < count && i * stride < px) ++i;
    return i;
  };
  const int left = first_from(box.x0, width);
  const int top = first_from(box.y0, height);
  return {left, top, std::max(0, first_from(box.x1, width) - left),
          std::max(0, first_from(box.y1, height) - top)};
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
                           std::shared_ptr<const SampledRays> rays) {
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
  (void)spread(record.movable, record.grid);  // check() has seen that the cells cover the picture
  if (input.depth.values.type() == CV_16UC1)
    sample_depths<std::uint16_t>(input.depth, record);
  else
    sample_depths<float>(input.depth, record);
  sample_colors(input.color, record);
  return record;
}

bool spread(MovableCells& movable, const PixelGrid& grid) {
  const cv::Mat1b& cells = movable.cells;
  movable.pixels.clear();
  if (movable.side_px == 0) return true;
  const auto cell = [&](int pixel) { return pixel * grid.stride / movable.side_px; };
  if (cell(grid.width - 1) >= cells.cols || cell(grid.height - 1) >= cells.rows) return false;
  if (cv::countNonZero(cells) == 0) return true;
  std::vector<int> cell_of_column;
  for (int column = 0; column < grid.width; ++column) cell_of_column.push_back(cell(column));
  movable.pixels.reserve(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  for (int row = 0; row < grid.height; ++row) {
    const std::uint8_t* row_of_cells = cells.ptr(cell(row));
    for (const int of_column : cell_of_column) movable.pixels.push_back(row_of_cells[of_column]);
  }
  return true;
}

}  // namespace rds::mapper
