// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/building/wall_pictures.hpp"

#include <algorithm>

namespace rds::simulator {
namespace {

constexpr float kMargin = 0.08F;     // to the ends of the wall and to neighbours [m]
constexpr float kFromWall = 0.012F;  // of a picture's middle [m]
constexpr int kAttempts = 12;

}  // namespace

bool WallPictures::is_free(float from, float to) const {
  if (from < -wall_.length / 2 + kMargin || to > wall_.length / 2 - kMargin) return false;
  return std::ranges::none_of(
      taken_, [&](const Interval& other) { return from < other.to + kMargin && to > other.from - kMargin; });
}

void WallPictures::hang_in_the_middle(float z, float width, float height, std::uint16_t picture,
                                      std::uint16_t frame) {
  if (!is_free(-width / 2, width / 2)) return;
  add_framed_panel(builder_, wall_.stand(0, kFromWall, 0, z), width, height, picture, frame);
  keep_free(-width / 2, width / 2);
}

void WallPictures::hang_plate(float along, std::uint16_t picture, std::uint16_t frame) {
  constexpr float kWidth = 0.2F;
  if (along + kWidth / 2 > wall_.length / 2) return;
  add_framed_panel(builder_, wall_.stand(along, kFromWall, 0, 1.5F), kWidth, 0.15F, picture, frame);
  keep_free(along - kWidth / 2, along + kWidth / 2);
}

void WallPictures::hang_posters(int count, const FloorLooks& looks, std::uint16_t frame, Random& places,
                                Random& pictures) {
  for (int i = 0; i < count; ++i) {
    const auto width = static_cast<float>(places.uniform(0.42, 0.72));
    const float height = width * static_cast<float>(places.uniform(0.8, 1.35));
    const auto z = static_cast<float>(places.uniform(1.45, 1.7));
    const std::uint16_t picture = looks.poster(pictures);
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const auto along = static_cast<float>(places.uniform(-0.5, 0.5)) * wall_.length;
      if (!is_free(along - width / 2, along + width / 2)) continue;
      add_framed_panel(builder_, wall_.stand(along, kFromWall, 0, z), width, height, picture, frame);
      keep_free(along - width / 2, along + width / 2);
      break;
    }
  }
}

}  // namespace rds::simulator
