// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/building/shell.hpp"

#include <algorithm>

namespace rds::simulator {
namespace {

using Eigen::Vector3f;

constexpr float kTrimWidth = 0.07F;  // of a door's frame [m]
constexpr float kTrimDepth = 0.016F;
constexpr float kSkirting = 0.09F;
constexpr float kTouch = 0.02F;  // an opening this near to a wall is one of it [m]

/// One piece of wall from `from` to `to`, with the texture going on from its neighbours.
void add_wall_panel(SceneBuilder& builder, const Wall& wall, float from, float to, float bottom, float top,
                    const ShellLook& look) {
  if (to - from < 1e-3F || top - bottom < 1e-3F) return;
  builder.begin_building();
  builder.panel(wall.middle + wall.right * ((from + to) / 2) + Vector3f(0, 0, (bottom + top) / 2),
                wall.right * (to - from), {0, 0, top - bottom}, look.wall,
                {.metres = look.wall_metres, .u0 = from / look.wall_metres, .v0 = -top / look.wall_metres});
}

/// A board on the wall: a thing of its own, so that it has its own bounds.
void add_board(SceneBuilder& builder, const Wall& wall, float from, float to, float bottom, float top,
               std::uint16_t material) {
  const Place p = wall.stand((from + to) / 2, kTrimDepth / 2);
  builder.begin("", p.x, p.y, 0, p.yaw_rad);
  builder.box({0, 0, (bottom + top) / 2}, {to - from, kTrimDepth, top - bottom}, material);
}

void add_door_frame(SceneBuilder& builder, const Wall& wall, const Gap& gap, std::uint16_t material) {
  add_board(builder, wall, gap.from - kTrimWidth, gap.from, 0, gap.height + kTrimWidth, material);
  add_board(builder, wall, gap.to, gap.to + kTrimWidth, 0, gap.height + kTrimWidth, material);
  add_board(builder, wall, gap.from, gap.to, gap.height, gap.height + kTrimWidth, material);
}

void add_wall(SceneBuilder& builder, const Wall& wall, float height, const std::vector<Gap>& gaps,
              const ShellLook& look) {
  float from = -wall.length / 2;
  const auto close = [&](float to) {
    add_wall_panel(builder, wall, from, to, 0, height, look);
    if (to - from > 2 * kTrimWidth) add_board(builder, wall, from, to, 0, kSkirting, look.trim);
  };
  for (const Gap& gap : gaps) {
    close(gap.from);
    add_wall_panel(builder, wall, gap.from, gap.to, gap.height, height, look);
    if (gap.height < height - 0.01F) add_door_frame(builder, wall, gap, look.trim);
    from = gap.to;
  }
  close(wall.length / 2);
}

}  // namespace

std::vector<Gap> gaps_of(const Scene& scene, std::size_t room, const Wall& wall) {
  std::vector<Gap> gaps;
  for (const Opening& opening : scene.openings) {
    if (std::ranges::find(opening.rooms, room) == opening.rooms.end()) continue;
    const Vector3f low = opening.box.min.cast<float>() - wall.middle;
    const Vector3f high = opening.box.max.cast<float>() - wall.middle;
    const Vector3f inward = wall.inward();
    if (std::max(low.dot(inward), high.dot(inward)) < -kTouch) continue;
    if (std::min(std::abs(low.dot(inward)), std::abs(high.dot(inward))) > kTouch) continue;
    const auto [from, to] = std::minmax({low.dot(wall.right), high.dot(wall.right)});
    gaps.push_back({from, to, high.z()});
  }
  std::ranges::sort(gaps, {}, &Gap::from);
  return gaps;
}

void add_shell(SceneBuilder& builder, const Scene& scene, const ShellLook& look) {
  const std::size_t index = scene.rooms.size() - 1;
  const geometry::Box3 box = scene.rooms[index].box;
  const std::vector<Lamp> lamps = scene.rooms[index].lamps;
  const Vector3f low = box.min.cast<float>();
  const Vector3f size = box.size().cast<float>();
  const Vector3f foot(low.x() + size.x() / 2, low.y() + size.y() / 2, 0);
  const Vector3f top = foot + Vector3f(0, 0, size.z());
  builder.begin_building();
  builder.panel(foot, {size.x(), 0, 0}, {0, size.y(), 0}, look.floor, {.metres = look.floor_metres});
  builder.panel(top, {size.x(), 0, 0}, {0, -size.y(), 0}, look.ceiling, {.metres = 1.1F});
  for (const Lamp& lamp : lamps)
    if (lamp.extent_b.z() == 0)
      builder.panel({lamp.position.x(), lamp.position.y(), size.z() - 0.01F}, 2 * lamp.extent_a,
                    -2 * lamp.extent_b, look.lamp);
  for (const Wall& wall : walls_of(box)) add_wall(builder, wall, size.z(), gaps_of(scene, index, wall), look);
}

void add_reveal(SceneBuilder& builder, const geometry::Box3& opening, std::uint16_t material) {
  builder.begin_building();
  const Vector3f size = opening.size().cast<float>();
  const Vector3f middle = opening.center().cast<float>();
  const bool along_x = size.x() > size.y();
  const Vector3f across = along_x ? Vector3f(0, size.y(), 0) : Vector3f(size.x(), 0, 0);
  const Vector3f side = along_x ? Vector3f(size.x() / 2, 0, 0) : Vector3f(0, size.y() / 2, 0);
  const Vector3f up(0, 0, size.z());
  // A panel faces right × up: the sides face each other.
  const float turn = across.cross(up).dot(side) < 0 ? 1.0F : -1.0F;
  builder.panel(middle + side, turn * across, up, material);
  builder.panel(middle - side, -turn * across, up, material);
  builder.panel(middle + up / 2, {size.x(), 0, 0}, {0, -size.y(), 0}, material);
  builder.panel(middle - up / 2, {size.x(), 0, 0}, {0, size.y(), 0}, material);
}

void add_open_door(SceneBuilder& builder, const Wall& wall, const Gap& gap, std::uint16_t material,
                   std::uint16_t handle) {
  const float width = gap.to - gap.from - 0.02F;
  const Place hinge = wall.stand(gap.to + 0.03F, width / 2 + 0.02F);
  builder.begin("", hinge.x, hinge.y, 0, hinge.yaw_rad);
  builder.box({0, 0, gap.height / 2}, {0.04F, width, gap.height - 0.02F}, material, {.metres = 1.1F});
  builder.box({0, -width / 2 + 0.08F, 1.03F}, {0.13F, 0.025F, 0.025F}, handle);
  builder.box({0, -width / 2 + 0.12F, 1.03F}, {0.12F, 0.1F, 0.02F}, handle);
}

}  // namespace rds::simulator
