// SPDX-License-Identifier: Apache-2.0
// Seats and tables; every dimension in metres.
#include "tools/simulator/world/furniture.hpp"

#include <cmath>
#include <numbers>

#include "tools/simulator/rendering/texture_paint.hpp"

namespace rds::simulator {
namespace {

using Eigen::AngleAxisf;
using Eigen::Isometry3f;
using Eigen::Translation3f;
using Eigen::Vector3f;

/// Straight bar of square section between two points.
void bar(SceneBuilder& builder, const Vector3f& from, const Vector3f& to, float thickness,
         std::uint16_t material) {
  const Eigen::Quaternionf turn =
      Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitZ(), (to - from).normalized());
  builder.box(Isometry3f(Translation3f((from + to) / 2) * turn),
              Vector3f(thickness, thickness, (to - from).norm()), material, {.metres = 0.3F});
}

/// Box with softly bulging sides: a cushion.
void cushion(SceneBuilder& builder, const Vector3f& center, const Vector3f& size, std::uint16_t material) {
  std::vector<Ring> rings;
  for (const float t : {0.0F, 0.06F, 0.2F, 0.5F, 0.8F, 0.94F, 1.0F}) {
    const float bulge = t == 0 || t == 1 ? 0.02F : 0.86F + 0.14F * std::sin(std::numbers::pi_v<float> * t);
    rings.push_back({center + Vector3f(0, 0, (t - 0.5F) * size.z()), Vector3f(size.x() / 2 * bulge, 0, 0),
                     Vector3f(0, size.y() / 2 * bulge, 0), t, 7});
  }
  builder.loft(rings, 28, material);
}

}  // namespace

Palette make_palette(SceneBuilder& builder, Random& random) {
  Palette p;
  const auto plain = [&](const cv::Scalar& color, double grain) {
    return paint::speckled(random, {128, 128}, color, grain, grain);
  };
  p.oak = builder.material(paint::wood(random, cv::Scalar(105, 160, 200)));
  p.walnut = builder.material(paint::wood(random, cv::Scalar(52, 78, 118)));
  p.white = builder.material(plain(cv::Scalar(222, 228, 230), 3));
  p.black = builder.material(plain(cv::Scalar(38, 36, 36), 3), {.infrared = 0.42F});
  p.metal = builder.material(plain(cv::Scalar(150, 150, 152), 6), {.infrared = 0.75F});
  p.upholstery = builder.material(paint::fabric(random, paint::vivid(random, 55, 165)));
  p.cushion = builder.material(paint::patterned_fabric(random, paint::vivid(random, 80, 220)));
  p.leaves = builder.material(paint::leaves(random));
  p.pot = builder.material(paint::fabric(random, cv::Scalar(70, 95, 175), 0.7));
  p.books = builder.material(paint::book_spines(random));
  p.paper = builder.material(paint::cover(random));
  return p;
}

void add_table(SceneBuilder& builder, const Palette& palette, const Place& place, float width, float depth) {
  builder.begin("diningtable", place.x, place.y, place.z, place.yaw_rad);
  constexpr float kHeight = 0.74F;
  builder.box({0, 0, kHeight - 0.018F}, {width, depth, 0.036F}, palette.oak, {.metres = 0.9F});
  const float x = width / 2 - 0.06F;
  const float y = depth / 2 - 0.06F;
  for (const float sx : {-x, x})
    for (const float sy : {-y, y})
      builder.box({sx, sy, kHeight / 2 - 0.02F}, {0.055F, 0.055F, kHeight - 0.04F}, palette.oak);
  for (const float sy : {-y, y}) builder.box({0, sy, kHeight - 0.075F}, {2 * x, 0.022F, 0.075F}, palette.oak);
  for (const float sx : {-x, x}) builder.box({sx, 0, kHeight - 0.075F}, {0.022F, 2 * y, 0.075F}, palette.oak);
}

void add_chair(SceneBuilder& builder, const Palette& palette, const Place& place) {
  builder.begin("chair", place.x, place.y, place.z, place.yaw_rad);
  const std::uint16_t frame = palette.walnut;
  constexpr float kSeat = 0.46F;
  for (const float side : {-0.19F, 0.19F}) {
    bar(builder, {side, -0.19F, 0}, {side, -0.18F, kSeat - 0.02F}, 0.036F, frame);
    bar(builder, {side, 0.22F, 0}, {side, 0.19F, kSeat}, 0.036F, frame);
    bar(builder, {side, 0.19F, kSeat}, {side, 0.27F, 0.93F}, 0.036F, frame);
    bar(builder, {side, -0.18F, 0.22F}, {side, 0.2F, 0.22F}, 0.02F, frame);
  }
  for (const float y : {-0.18F, 0.19F}) builder.box({0, y, kSeat - 0.045F}, {0.38F, 0.025F, 0.05F}, frame);
  cushion(builder, {0, 0, kSeat}, {0.44F, 0.43F, 0.055F}, palette.upholstery);
  for (const float z : {0.62F, 0.74F, 0.88F})
    bar(builder, {-0.19F, 0.19F + (z - kSeat) * 0.17F, z}, {0.19F, 0.19F + (z - kSeat) * 0.17F, z},
        z > 0.8F ? 0.075F : 0.045F, frame);
  for (const float x : {-0.09F, 0.0F, 0.09F})
    bar(builder, {x, 0.2F, kSeat}, {x, 0.262F, 0.87F}, 0.018F, frame);
}

void add_office_chair(SceneBuilder& builder, const Palette& palette, const Place& place) {
  builder.begin("chair", place.x, place.y, place.z, place.yaw_rad);
  for (int i = 0; i < 5; ++i) {
    const float a = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / 5;
    const Vector3f end(0.29F * std::cos(a), 0.29F * std::sin(a), 0.065F);
    bar(builder, {0, 0, 0.105F}, end, 0.042F, palette.black);
    builder.ellipsoid({end.x(), end.y(), 0.03F}, {0.028F, 0.028F, 0.03F}, palette.black);
  }
  builder.lathe({0, 0, 0.08F}, {{0.03F, 0}, {0.03F, 0.2F}, {0.022F, 0.2F}, {0.022F, 0.34F}}, palette.metal,
                14);
  cushion(builder, {0, -0.01F, 0.47F}, {0.5F, 0.48F, 0.1F}, palette.upholstery);
  bar(builder, {0, 0.2F, 0.43F}, {0, 0.27F, 0.62F}, 0.05F, palette.black);
  std::vector<Ring> back;
  for (const float t : {0.0F, 0.02F, 0.2F, 0.5F, 0.8F, 0.98F, 1.0F}) {
    const float edge = t == 0 || t == 1 ? 0.05F : 0.85F + 0.15F * std::sin(std::numbers::pi_v<float> * t);
    const float lean = 0.23F + 0.09F * t - 0.05F * std::sin(std::numbers::pi_v<float> * t);
    back.push_back({Vector3f(0, lean, 0.56F + 0.5F * t), Vector3f(0.225F * edge, 0, 0),
                    Vector3f(0, 0.04F * edge, 0), t, 3.5F});
  }
  builder.loft(back, 24, palette.upholstery);
  for (const float side : {-0.26F, 0.26F}) {
    bar(builder, {side, 0.06F, 0.45F}, {side, 0.06F, 0.65F}, 0.035F, palette.black);
    builder.box({side, 0.02F, 0.665F}, {0.06F, 0.26F, 0.03F}, palette.black);
  }
}

void add_sofa(SceneBuilder& builder, const Palette& palette, const Place& place, float width) {
  builder.begin("sofa", place.x, place.y, place.z, place.yaw_rad);
  const std::uint16_t cloth = palette.upholstery;
  builder.box({0, 0, 0.22F}, {width - 0.1F, 0.8F, 0.2F}, cloth, {.metres = 0.35F});
  for (const float side : {-1.0F, 1.0F}) {
    cushion(builder, {side * (width / 2 - 0.1F), 0, 0.36F}, {0.2F, 0.84F, 0.5F}, cloth);
    cushion(builder, {side * (width / 4 - 0.05F), -0.06F, 0.4F}, {width / 2 - 0.12F, 0.7F, 0.2F}, cloth);
    const Isometry3f lean(Translation3f(side * (width / 4 - 0.05F), 0.22F, 0.64F) *
                          AngleAxisf(0.18F, Vector3f::UnitX()));
    builder.box(lean, {width / 2 - 0.14F, 0.14F, 0.4F}, cloth, {.metres = 0.35F});
    cushion(builder, {side * (width / 2 - 0.38F), 0.02F, 0.64F}, {0.38F, 0.14F, 0.36F}, palette.cushion);
  }
  builder.box({0, 0.36F, 0.5F}, {width - 0.1F, 0.14F, 0.62F}, cloth, {.metres = 0.35F});
  for (const float x : {-width / 2 + 0.12F, width / 2 - 0.12F})
    for (const float y : {-0.34F, 0.36F}) builder.box({x, y, 0.06F}, {0.05F, 0.05F, 0.12F}, palette.walnut);
}

}  // namespace rds::simulator
