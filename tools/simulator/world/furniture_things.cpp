// SPDX-License-Identifier: Apache-2.0
// Things that stand on tables, shelves and the floor; every dimension in metres.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/simulator/rendering/texture_paint.hpp"
#include "tools/simulator/world/furniture.hpp"

namespace rds::simulator {
namespace {

using Eigen::AngleAxisf;
using Eigen::Isometry3f;
using Eigen::Translation3f;
using Eigen::Vector3f;

float uniform(Random& random, double low, double high) {
  return static_cast<float>(random.uniform(low, high));
}

/// One leaf as a bent blade from `root` along `direction`, visible from both sides.
void leaf(SceneBuilder& builder, const Vector3f& root, const Vector3f& direction, float length, float width,
          std::uint16_t material) {
  const Vector3f side = direction.cross(Vector3f::UnitZ()).normalized();
  std::vector<Ring> rings;
  for (int i = 0; i <= 5; ++i) {
    const float t = static_cast<float>(i) / 5;
    const float half =
        std::max(0.004F, width / 2 * std::sin(std::numbers::pi_v<float> * (0.12F + 0.88F * t)));
    const Vector3f bend(0, 0, -0.45F * length * t * t);
    rings.push_back({root + direction * (length * t) + bend, side * half,
                     Vector3f(0, 0, 0.003F) + direction * 0.001F, t, 2});
  }
  builder.loft(rings, 6, material);
}

void books(SceneBuilder& builder, const Palette& palette, const Vector3f& left, float width, float room_above,
           Random& random) {
  float x = left.x();
  while (x < left.x() + width - 0.06F) {
    const float thick = uniform(random, 0.022, 0.058);
    const float high = room_above * uniform(random, 0.66, 0.94);
    const float deep = uniform(random, 0.15, 0.21);
    const auto strip = static_cast<float>(random.integer(16)) / 16;
    builder.box({x + thick / 2, left.y() + deep / 2, left.z() + high / 2}, {thick * 0.96F, deep, high},
                palette.books, TextureMapping::fit(strip + 0.003F, 0, strip + 0.059F, 1));
    x += thick + (random.chance(0.12) ? uniform(random, 0.03, 0.1) : 0.0F);
  }
}

void mug(SceneBuilder& builder, const Vector3f& base, std::uint16_t material) {
  builder.lathe(
      base,
      {{0.001F, 0.002F}, {0.036F, 0}, {0.04F, 0.01F}, {0.041F, 0.095F}, {0.036F, 0.095F}, {0.034F, 0.02F}},
      material, 16);
}

}  // namespace

void add_monitor(SceneBuilder& builder, const Palette& palette, const Place& place, float width,
                 Random& random) {
  builder.begin("tvmonitor", place.x, place.y, place.z, place.yaw_rad);
  const std::uint16_t picture =
      builder.material(paint::screen(random), {.infrared = 0.3F, .emission = 0.75F});
  const float height = width * 0.58F;
  const float middle = 0.13F + height / 2;
  builder.box({0, 0.02F, middle}, {width, 0.035F, height}, palette.black);
  builder.panel({0, 0.0015F, middle + 0.004F}, {width - 0.035F, 0, 0}, {0, 0, height - 0.045F}, picture);
  builder.box({0, 0.05F, 0.11F}, {0.05F, 0.03F, 0.22F}, palette.black);
  builder.box({0, 0.04F, 0.008F}, {0.24F, 0.17F, 0.016F}, palette.black);
}

void add_plant(SceneBuilder& builder, const Palette& palette, const Place& place, float height,
               Random& random) {
  builder.begin("pottedplant", place.x, place.y, place.z, place.yaw_rad);
  const float pot = height * 0.27F;
  const float r = height * 0.15F;
  builder.lathe({0, 0, 0},
                {{0.001F, 0.002F},
                 {r * 0.72F, 0},
                 {r, pot},
                 {r * 1.06F, pot},
                 {r * 1.06F, pot * 1.1F},
                 {r * 0.9F, pot * 1.1F},
                 {0.001F, pot * 0.96F}},
                palette.pot, 22, 2);
  const int count = 34;
  for (int i = 0; i < count; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(count);
    const float azimuth = 2.399963F * static_cast<float>(i) + uniform(random, -0.2, 0.2);
    const float rise = 0.15F + 1.15F * t;
    const Vector3f direction(std::cos(azimuth) * std::cos(rise), std::sin(azimuth) * std::cos(rise),
                             std::sin(rise));
    const Vector3f root(0.02F * std::cos(azimuth), 0.02F * std::sin(azimuth),
                        pot + (height - pot) * (0.1F + 0.45F * t));
    leaf(builder, root, direction, height * uniform(random, 0.3, 0.4), height * uniform(random, 0.1, 0.15),
         palette.leaves);
  }
  builder.lathe({0, 0, pot * 0.9F}, {{0.016F, 0}, {0.01F, height * 0.5F}}, palette.walnut, 8);
}

void add_bottle(SceneBuilder& builder, const Place& place, Random& random) {
  builder.begin("bottle", place.x, place.y, place.z, place.yaw_rad);
  const std::array<cv::Scalar, 3> glass{cv::Scalar(40, 75, 30), cv::Scalar(35, 50, 85),
                                        cv::Scalar(125, 90, 45)};
  const std::uint16_t label = builder.material(
      paint::bottle_label(random, glass[static_cast<std::size_t>(random.integer(3))]), {.infrared = 0.55F});
  const float r = uniform(random, 0.036, 0.042);
  builder.lathe({0, 0, 0},
                {{0.001F, 0.004F},
                 {r * 0.92F, 0},
                 {r, 0.012F},
                 {r, 0.175F},
                 {r * 0.88F, 0.205F},
                 {0.017F, 0.245F},
                 {0.0145F, 0.3F},
                 {0.017F, 0.302F},
                 {0.017F, 0.315F},
                 {0.001F, 0.316F}},
                label, 22);
}

void add_shelf(SceneBuilder& builder, const Palette& palette, const Place& place, float width, float height,
               Random& random) {
  builder.begin("", place.x, place.y, place.z, place.yaw_rad);
  constexpr float kDepth = 0.3F;
  for (const float side : {-1.0F, 1.0F})
    builder.box({side * (width / 2 - 0.012F), 0, height / 2}, {0.024F, kDepth, height}, palette.walnut);
  builder.box({0, kDepth / 2 - 0.006F, height / 2}, {width - 0.05F, 0.012F, height}, palette.walnut);
  const int boards = static_cast<int>(height / 0.36F) + 1;
  const float gap = (height - 0.03F) / static_cast<float>(boards - 1);
  for (int i = 0; i < boards; ++i) {
    const float z = 0.015F + gap * static_cast<float>(i);
    builder.box({0, -0.006F, z}, {width - 0.05F, kDepth - 0.012F, 0.024F}, palette.walnut);
    if (i + 1 == boards) break;
    const float left = -width / 2 + 0.03F;
    const float filled = random.chance(0.6) ? width - 0.08F : width * uniform(random, 0.4, 0.7);
    books(builder, palette, {left, -0.11F, z + 0.012F}, filled, gap - 0.03F, random);
    if (filled < width * 0.8F) mug(builder, {width / 2 - 0.12F, -0.03F, z + 0.012F}, palette.cushion);
  }
}

void add_cardboard_box(SceneBuilder& builder, const Place& place, const Eigen::Vector3f& size,
                       Random& random) {
  builder.begin("", place.x, place.y, place.z, place.yaw_rad);
  const std::uint16_t print =
      builder.material(random.chance(0.7) ? paint::cardboard(random) : paint::cover(random));
  builder.box({0, 0, size.z() / 2}, size, print, TextureMapping::fit());
}

void add_desk_clutter(SceneBuilder& builder, const Palette& palette, const Place& place, float width,
                      Random& random) {
  builder.begin("", place.x, place.y, place.z, place.yaw_rad);
  const std::uint16_t keys = builder.material(paint::keyboard(random));
  for (const float x : {-width * 0.24F, width * 0.24F}) {
    builder.box({x, -0.2F, 0.01F}, {0.42F, 0.13F, 0.02F}, palette.black);
    builder.panel({x, -0.2F, 0.022F}, {0.4F, 0, 0}, {0, 0.115F, 0}, keys);
    builder.ellipsoid({x + 0.29F, -0.21F, 0.012F}, {0.03F, 0.05F, 0.018F}, palette.black);
  }
  mug(builder, {0.04F, -0.18F, 0}, palette.cushion);
  for (int i = 0; i < 7; ++i) {
    const Isometry3f lying(Translation3f(uniform(random, -width * 0.45, width * 0.45),
                                         uniform(random, -0.28, 0.05),
                                         0.004F + 0.003F * static_cast<float>(i)) *
                           AngleAxisf(uniform(random, -0.6, 0.6), Vector3f::UnitZ()));
    builder.box(lying, {0.2F, 0.27F, 0.003F}, i % 2 == 0 ? palette.paper : palette.white,
                TextureMapping::fit());
  }
  float z = 0;
  for (int i = 0; i < 5; ++i) {
    const float thick = uniform(random, 0.02, 0.045);
    const Isometry3f lying(Translation3f(width * 0.43F, 0.1F, z + thick / 2) *
                           AngleAxisf(uniform(random, -0.3, 0.3), Vector3f::UnitZ()));
    const auto strip = static_cast<float>(random.integer(16)) / 16;
    builder.box(lying, {0.22F, 0.16F, thick}, palette.books, TextureMapping::fit(strip, 0, strip + 0.06F, 1));
    z += thick;
  }
}

void add_framed_panel(SceneBuilder& builder, const Place& place, float width, float height,
                      std::uint16_t picture, std::uint16_t frame) {
  builder.begin("", place.x, place.y, place.z, place.yaw_rad);
  builder.box({0, 0, 0}, {width, 0.022F, height}, frame);
  builder.panel({0, -0.0125F, 0}, {width - 0.05F, 0, 0}, {0, 0, height - 0.05F}, picture);
}

void add_floor_lamp(SceneBuilder& builder, const Palette& palette, const Place& place) {
  builder.begin("", place.x, place.y, place.z, place.yaw_rad);
  builder.lathe({0, 0, 0}, {{0.001F, 0.03F}, {0.14F, 0}, {0.14F, 0.025F}, {0.014F, 0.03F}, {0.014F, 1.4F}},
                palette.metal, 18);
  builder.lathe({0, 0, 1.34F}, {{0.2F, 0}, {0.13F, 0.3F}}, palette.cushion, 22, 3);
}

}  // namespace rds::simulator
