// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/picture/map_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "services/mapper/core/octree/label_table.hpp"
#include "tools/rds/picture/map_picture_canvas.hpp"
#include "tools/rds/picture/map_picture_legend.hpp"
#include "tools/rds/picture/map_picture_voxels.hpp"

namespace rds::tools {
namespace {

constexpr int kSupersampling = 2;
constexpr int kHeaderPx = 56;
constexpr int kFooterPx = 64;
constexpr int kMarginPx = 18;
constexpr double kElevation = 0.62;      // of the angled view [rad]
constexpr double kSideways = 0.40;       // the eye stands beside the camera's place, turned by this [rad]
const cv::Vec3f kPathColor(58, 30, 24);  // no label has a dark colour
const cv::Scalar kStartColor(80, 175, 60);
const cv::Scalar kEndColor(60, 50, 215);

cv::Vec3b color_of(const std::string& label) {
  const auto rgb = mapper::label_color(label);
  return {rgb[2], rgb[1], rgb[0]};
}

Eigen::Matrix3d level_from_map(const Eigen::Vector3d& up) {
  const Eigen::Vector3d z = up.normalized();
  const Eigen::Vector3d side = std::abs(z.x()) > 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d x = (side - z * z.dot(side)).normalized();
  Eigen::Matrix3d level;
  level << x.transpose(), z.cross(x).transpose(), z.transpose();
  return level;
}

/// One of the two views while it is drawn, at kSupersampling times its size.
struct Panel {
  View view;
  Canvas canvas;
  const Eigen::Matrix3d& level;
  std::vector<cv::Rect> labels{};  // already drawn

  [[nodiscard]] ScreenPoint project(const Eigen::Vector3d& point_in_map) const {
    return view.project(level * point_in_map);
  }
};

void draw_floor_grid(const VoxelModel& model, Panel& panel) {
  const auto& b = model.bounds();
  const auto line = [&](double x0, double y0, double x1, double y1) {
    panel.canvas.line(panel.view.project({x0, y0, model.floor()}),
                      panel.view.project({x1, y1, model.floor()}), cv::Vec3f(196, 188, 182), kSupersampling,
                      0.9F, 0.0F);
  };
  const double x0 = std::floor(b.min().x()) - 1;
  const double x1 = std::ceil(b.max().x()) + 1;
  const double y0 = std::floor(b.min().y()) - 1;
  const double y1 = std::ceil(b.max().y()) + 1;
  for (double x = x0; x <= x1; ++x) line(x, y0, x, y1);
  for (double y = y0; y <= y1; ++y) line(x0, y, x1, y);
}

void draw_trajectory(const std::vector<Eigen::Vector3d>& trajectory, Panel& panel) {
  const std::array<std::pair<cv::Vec3f, int>, 2> strokes{
      {{cv::Vec3f(255, 255, 255), 5 * kSupersampling},
       {kPathColor, 2 * kSupersampling + 1}}};  // a light rim around the path
  for (const auto& [color, thickness] : strokes)
    for (std::size_t i = 1; i < trajectory.size(); ++i)
      panel.canvas.line(panel.project(trajectory[i - 1]), panel.project(trajectory[i]), color, thickness,
                        1.0F, 0.5F);
  if (trajectory.empty()) return;
  for (const auto& [point, color] :
       {std::pair(trajectory.front(), kStartColor), std::pair(trajectory.back(), kEndColor)}) {
    const auto p = panel.project(point);
    if (!(p.head<2>().cwiseAbs().maxCoeff() < 1e5F)) continue;
    const cv::Point center(static_cast<int>(p.x()), static_cast<int>(p.y()));
    cv::circle(panel.canvas.pixels(), center, 7 * kSupersampling, cv::Scalar(255, 255, 255), -1, cv::LINE_AA);
    cv::circle(panel.canvas.pixels(), center, 5 * kSupersampling, color, -1, cv::LINE_AA);
  }
}

/// Above a point; higher where another label is already, not at all where there is no room.
void draw_label(const std::string& label, cv::Point bottom_center, Panel& panel) {
  constexpr int kLevels = 4;
  const double scale = 0.5 * kSupersampling;
  int baseline = 0;
  const cv::Size size = cv::getTextSize(label, cv::FONT_HERSHEY_DUPLEX, scale, 1, &baseline);
  cv::Rect place({bottom_center.x - size.width / 2, bottom_center.y - size.height}, size);
  for (int level = 0; level < kLevels; ++level, place.y -= size.height + baseline) {
    if (std::ranges::any_of(panel.labels, [&](const cv::Rect& other) { return (other & place).area() > 0; }))
      continue;
    panel.labels.push_back(place);
    const cv::Point at(place.x, place.br().y);
    put_text(panel.canvas.pixels(), label, at, scale, cv::Scalar(255, 255, 255), 6);
    put_text(panel.canvas.pixels(), label, at, scale, kInk, 2);
    return;
  }
}

void draw_box(const SceneObject& object, Panel& panel) {
  const auto corners = object.box.corners();
  const auto corner = [&](unsigned i) { return panel.project(corners[i]); };
  const cv::Vec3f color = color_of(object.label);
  ScreenPoint top = corner(0);
  for (unsigned i = 0; i < 8; ++i) {
    if (corner(i).y() < top.y()) top = corner(i);
    for (const unsigned bit : {1U, 2U, 4U})
      if ((i & bit) == 0)
        panel.canvas.line(corner(i), corner(i | bit), color * 0.8F, 2 * kSupersampling, 0.95F, 0.25F);
  }
  const auto center = panel.project(object.box.center());
  if (!(std::abs(center.x()) < 1e5F && std::abs(top.y()) < 1e5F)) return;
  draw_label(object.label, {static_cast<int>(center.x()), static_cast<int>(top.y()) - 8}, panel);
}

cv::Mat finish(const MapScene& scene, const VoxelModel& model, Panel& panel) {
  model.draw(panel.view, panel.canvas);
  panel.canvas.outline(0.35F);
  draw_floor_grid(model, panel);
  draw_trajectory(scene.trajectory, panel);
  for (const auto& object : scene.objects) draw_box(object, panel);
  cv::Mat small;
  cv::resize(panel.canvas.pixels(), small, {}, 1.0 / kSupersampling, 1.0 / kSupersampling, cv::INTER_AREA);
  return small;
}

/// Seen from where the cameras were, but higher and from a distance that shows everything.
View angled_view(const VoxelModel& model, const std::vector<Eigen::Vector3d>& trajectory,
                 const Eigen::Matrix3d& level, cv::Size size) {
  const Eigen::Vector3d target = (model.bounds().center() + model.median()) / 2;
  Eigen::Vector3d cameras = target + Eigen::Vector3d(1, -1, 0);
  if (!trajectory.empty()) {
    cameras.setZero();
    for (const auto& p : trajectory) cameras += level * p / static_cast<double>(trajectory.size());
    if (!(cameras.cwiseAbs().maxCoeff() < 1e6)) cameras = target + Eigen::Vector3d(1, -1, 0);
  }
  const double azimuth = std::atan2(cameras.y() - target.y(), cameras.x() - target.x()) + kSideways;
  const Eigen::Vector3d direction(std::cos(azimuth) * std::cos(kElevation),
                                  std::sin(azimuth) * std::cos(kElevation), std::sin(kElevation));
  const double distance = 1.9 * model.bounds().diagonal().norm() / 2 + 1.5;
  View view = look_at(target + direction * distance, target, 1.0, {0, 0});
  Eigen::Vector2f low(1e9F, 1e9F);
  Eigen::Vector2f high = -low;
  for (int i = 0; i < 8; ++i) {
    const auto p = view.project(model.bounds().corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  view.focal_px =
      0.94 * std::min(size.width / double{high.x() - low.x()}, size.height / double{high.y() - low.y()});
  view.center_px = {size.width / 2.0 - view.focal_px * double{high.x() + low.x()} / 2,
                    size.height / 2.0 - view.focal_px * double{high.y() + low.y()} / 2};
  return view;
}

double top_scale(const VoxelModel& model, cv::Size size) {
  const Eigen::Vector3d extent = model.bounds().sizes() + Eigen::Vector3d::Constant(0.3);
  return std::min(size.width / extent.x(), size.height / extent.y());
}

void draw_scale_bar(cv::Mat& image, double pixels_per_m, cv::Point at) {
  const int length = static_cast<int>(pixels_per_m);
  cv::line(image, at, at + cv::Point(length, 0), kInk, 2, cv::LINE_AA);
  for (const int x : {0, length})
    cv::line(image, at + cv::Point(x, -5), at + cv::Point(x, 5), kInk, 2, cv::LINE_AA);
  put_text(image, "1 m", at + cv::Point(length / 2 - 14, -9), 0.45, kInk);
}

void draw_legend(const MapScene& scene, const VoxelModel& model, cv::Mat& picture) {
  const std::string others = "other surfaces in their own colour";
  PictureLegend legend(picture, kMarginPx, kFooterPx);
  if (!scene.trajectory.empty()) {
    legend.line("camera path", kPathColor);
    legend.dot("start", kStartColor);
    legend.dot("end", kEndColor);
  }
  for (const auto& label : scene.labels)
    if (!label.empty() && model.count(color_of(label)) > 0 && legend.has_room(label, others))
      legend.square(label, color_of(label));
  legend.square(others, cv::Scalar(150, 158, 165));
}

void draw_captions(cv::Mat& picture, const cv::Rect& angled, const cv::Rect& top) {
  put_text(picture, "at an angle", angled.tl() + cv::Point(12, 24), 0.5, kInk);
  put_text(picture, "from above, lines every metre", top.tl() + cv::Point(12, 24), 0.5, kInk);
}

std::string title_of(const VoxelModel& model, double resolution_m, double max_height_m) {
  std::string title =
      fmt::format("Semantic octree map: {} occupied voxels of {:.0f} cm", model.total(), resolution_m * 100);
  if (model.total() > model.size())
    title += fmt::format(", shown up to {:.1f} m above the floor", max_height_m);
  return title;
}

}  // namespace

cv::Mat render_map(const MapScene& scene, const PictureOptions& options) {
  const cv::Size all(std::max(640, options.width), std::max(360, options.height));
  cv::Mat picture(all, CV_8UC3, cv::Scalar(255, 255, 255));
  const Eigen::Matrix3d level = level_from_map(options.up);
  const VoxelModel model(scene.tree, level, options.max_height_m);
  if (model.empty()) {
    put_text(picture, "The map has no occupied voxel.", {kMarginPx, all.height / 2}, 0.9, kInk);
    return picture;
  }
  const int inner_height = all.height - kHeaderPx - kFooterPx;
  const int top_width = (all.width - 3 * kMarginPx) * 2 / 5;
  const cv::Rect angled_rect(kMarginPx, kHeaderPx, all.width - 3 * kMarginPx - top_width, inner_height);
  const cv::Rect top_rect(angled_rect.br().x + kMarginPx, kHeaderPx, top_width, inner_height);

  const cv::Size angled_size = angled_rect.size() * kSupersampling;
  Panel angled{angled_view(model, scene.trajectory, level, angled_size), Canvas(angled_size), level};
  finish(scene, model, angled).copyTo(picture(angled_rect));

  const cv::Size top_size = top_rect.size() * kSupersampling;
  const double pixels_per_m = top_scale(model, top_size);
  Panel top{look_down(model.bounds().center(), pixels_per_m, {top_size.width / 2.0, top_size.height / 2.0}),
            Canvas(top_size), level};
  finish(scene, model, top).copyTo(picture(top_rect));
  draw_scale_bar(picture, pixels_per_m / kSupersampling, top_rect.br() - cv::Point(top_width - 20, 20));

  const std::string title = options.title.empty()
                                ? title_of(model, scene.tree.getResolution(), options.max_height_m)
                                : options.title;
  put_text(picture, title, {kMarginPx, kHeaderPx - 20}, 0.75, kInk);
  draw_captions(picture, angled_rect, top_rect);
  draw_legend(scene, model, picture);
  return picture;
}

}  // namespace rds::tools
