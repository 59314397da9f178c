// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/building/floor_looks.hpp"

#include "tools/simulator/rendering/texture_paint.hpp"

namespace rds::simulator {
namespace {

constexpr std::uint64_t kPaintStream = 13;
constexpr std::uint64_t kChoiceStream = 14;
constexpr int kPalettes = 4;
constexpr int kWalls = 6;
constexpr int kPosters = 40;
constexpr int kPlates = 30;
constexpr int kWindows = 4;
constexpr int kRugs = 2;

}  // namespace

FloorLooks::FloorLooks(SceneBuilder& builder, std::uint64_t seed) {
  Random random(seed, kPaintStream);
  for (int i = 0; i < kPalettes; ++i) palettes_.push_back(make_palette(builder, random));
  paint_walls_and_floors(builder, random);
  for (int i = 0; i < kPosters; ++i)
    posters_.push_back(builder.material(random.chance(0.4) ? paint::picture(random) : paint::poster(random)));
  for (int i = 0; i < kPlates; ++i) plates_.push_back(builder.material(paint::cover(random)));
  for (int i = 0; i < kWindows; ++i)
    windows_.push_back(builder.material(paint::window_view(random), {.emission = 0.85F}));
  for (int i = 0; i < kRugs; ++i)
    rugs_.push_back(builder.material(paint::carpet(random), {.takes_shadows = true}));
  whiteboard_ = builder.material(paint::whiteboard(random));
  door_ = builder.material(paint::wood(random, cv::Scalar(110, 150, 185), 0.6));
}

void FloorLooks::paint_walls_and_floors(SceneBuilder& builder, Random& random) {
  for (int i = 0; i < kWalls; ++i) {
    const cv::Scalar color(random.uniform(160, 210), random.uniform(180, 212), random.uniform(185, 218));
    walls_.push_back(builder.material(paint::wallpaper(random, color)));
  }
  floors_ = {builder.material(paint::parquet(random, cv::Scalar(82, 125, 165)), {.takes_shadows = true}),
             builder.material(paint::fabric(random, cv::Scalar(120, 105, 95)), {.takes_shadows = true}),
             builder.material(paint::fabric(random, cv::Scalar(80, 100, 125)), {.takes_shadows = true})};
  ceiling_ = builder.material(paint::speckled(random, {256, 256}, cv::Scalar(225, 230, 232), 4, 5));
  lamp_ = builder.material(cv::Mat(8, 8, CV_8UC3, cv::Scalar(235, 245, 250)), {.emission = 1});
  corridor_.wall = builder.material(paint::plaster(random, cv::Scalar(205, 212, 215)));
  corridor_.wall_metres = 3.6F;
  corridor_.floor =
      builder.material(paint::terrazzo(random, cv::Scalar(140, 150, 150)), {.takes_shadows = true});
  corridor_.floor_metres = 2.2F;
  corridor_.ceiling = ceiling_;
  corridor_.lamp = lamp_;
  corridor_.trim = palettes_.front().white;
}

ShellLook FloorLooks::shell(const RoomPlan& room) const {
  if (room.kind == RoomKind::kCorridor) return corridor_;
  Random random(room.style, kChoiceStream);
  ShellLook look = corridor_;
  look.wall = drawn(walls_, random);
  look.wall_metres = 1.6F;
  look.floor = drawn(floors_, random);
  look.floor_metres = 1.3F;
  return look;
}

const Palette& FloorLooks::palette(const RoomPlan& room) const {
  return palettes_[room.style % palettes_.size()];
}

}  // namespace rds::simulator
