// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/building/floor_layout.hpp"

#include <algorithm>
#include <array>

#include "tools/simulator/rendering/random.hpp"

namespace rds::simulator {
namespace {

using geometry::Box3;

constexpr double kWall = kWallThicknessM;
constexpr double kHeight = 2.65;
constexpr double kDoorHeight = 2.05;
constexpr int kFewestOfRing = 10;
constexpr std::uint64_t kLayoutStream = 10;

/// A row of rooms along a corridor.
struct Row {
  std::size_t corridor = 0;
  double near = 0;  // y of the row's face at the corridor
  double far = 0;   // y of the opposite one
  int rooms = 0;
  bool is_outside = false;
};

/// What the rooms of a row have in common by pairs.
struct Slot {
  double share = 1;  // of the row's length
  std::uint64_t style = 0;
  RoomKind kind = RoomKind::kOffice;
  double door_at = 0;  // of the free length of the wall, −1 … 1 in the room's frame
  double door_width = 0.95;
  bool is_copy = false;
};

/// Draws the floor row by row; `random` decides every free choice.
class FloorDrawer {
 public:
  FloorDrawer(std::uint64_t seed, int rooms) : random_(seed, kLayoutStream) {
    const bool is_ring = rooms >= kFewestOfRing;
    const int rows = is_ring ? 4 : 2;
    std::vector<int> counts;
    for (int i = 0; i < rows; ++i) counts.push_back(rooms / rows + (i < rooms % rows ? 1 : 0));
    half_length_ = counts.front() * random_.uniform(4.6, 5.1) / 2;
    width_ = random_.uniform(1.9, 2.2);
    for (auto& depth : depths_) depth = random_.uniform(4.4, 5.3);
    const auto plan = is_ring ? ring(counts) : straight(counts);
    for (const Row& row : plan) fill(row);
  }

  FloorLayout take() && { return std::move(layout_); }

 private:
  std::size_t corridor(double x0, double y0, double x1, double y1) {
    layout_.rooms.push_back({.box = {{x0, y0, 0}, {x1, y1, kHeight}},
                             .kind = RoomKind::kCorridor,
                             .style = random_.next(),
                             .is_turned = false,
                             .has_window = false});
    return layout_.rooms.size() - 1;
  }

  /// One corridor along x, a row in the south and one in the north.
  std::vector<Row> straight(const std::vector<int>& counts) {
    const double y = width_ / 2;
    const std::size_t middle = corridor(-half_length_, -y, half_length_, y);
    return {{middle, -y - kWall, -y - kWall - depths_[0], counts[0], true},
            {middle, y + kWall, y + kWall + depths_[1], counts[1], true}};
  }

  /// Two corridors along x, joined at both ends, two rows between them and one on either outer side.
  std::vector<Row> ring(const std::vector<int>& counts) {
    const double x = half_length_ + kWall;
    const double south = -kWall / 2 - depths_[1] - kWall;
    const double north = kWall / 2 + depths_[2] + kWall;
    const std::size_t a = corridor(-x - width_, south - width_, x + width_, south);
    const std::size_t b = corridor(-x - width_, north, x + width_, north + width_);
    for (const double side : {-1.0, 1.0}) {
      const double x0 = side > 0 ? x : -x - width_;
      const std::size_t cross = corridor(x0, south, x0 + width_, north);
      layout_.openings.push_back({{a, cross}, {{x0, south, 0}, {x0 + width_, south, kHeight}}});
      layout_.openings.push_back({{b, cross}, {{x0, north, 0}, {x0 + width_, north, kHeight}}});
    }
    const double outer_south = south - width_ - kWall;
    const double outer_north = north + width_ + kWall;
    return {{a, outer_south, outer_south - depths_[0], counts[0], true},
            {a, south + kWall, south + kWall + depths_[1], counts[1], false},
            {b, north - kWall, north - kWall - depths_[2], counts[2], false},
            {b, outer_north, outer_north + depths_[3], counts[3], true}};
  }

  RoomKind draw_kind() {
    constexpr std::array kKinds{RoomKind::kOffice,  RoomKind::kOffice,  RoomKind::kOffice, RoomKind::kOffice,
                                RoomKind::kMeeting, RoomKind::kMeeting, RoomKind::kLounge, RoomKind::kStore};
    return kKinds[static_cast<std::size_t>(random_.integer(kKinds.size()))];
  }

  std::vector<Slot> slots(int count) {
    std::vector<Slot> slots(static_cast<std::size_t>(count));
    for (Slot& slot : slots)
      slot = {random_.uniform(0.85, 1.15), random_.next(), draw_kind(), random_.uniform(-0.8, 0.8),
              random_.uniform(0.9, 1.0),   false};
    if (count < 2) return slots;
    const int original = random_.integer(count);
    const int copy = (original + 1 + random_.integer(count - 1)) % count;
    slots[static_cast<std::size_t>(original)].is_copy = true;
    slots[static_cast<std::size_t>(copy)] = slots[static_cast<std::size_t>(original)];
    return slots;
  }

  void fill(const Row& row) {
    const auto all = slots(row.rooms);
    double sum = 0;
    for (const Slot& slot : all) sum += slot.share;
    const double free_length = 2 * half_length_ - kWall * (row.rooms - 1);
    double x = -half_length_;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double width = all[i].share / sum * free_length;
      add_room(row, all[i], x, width);
      if (i > 0 && !all[i].is_copy && !all[i - 1].is_copy && random_.chance(0.5)) add_side_door(row, x);
      x += width + kWall;
    }
  }

  void add_room(const Row& row, const Slot& slot, double x, double width) {
    const bool is_north = row.far > row.near;
    layout_.rooms.push_back(
        {.box = {{x, std::min(row.near, row.far), 0}, {x + width, std::max(row.near, row.far), kHeight}},
         .kind = slot.kind,
         .style = slot.style,
         .is_turned = !is_north,
         .has_window = row.is_outside});
    const double reach = width / 2 - slot.door_width / 2 - 0.25;
    const double middle = x + width / 2 + (is_north ? 1 : -1) * slot.door_at * reach;
    const double corridor_face = row.near + (is_north ? -kWall : kWall);
    layout_.openings.push_back(
        {{row.corridor, layout_.rooms.size() - 1},
         {{middle - slot.door_width / 2, std::min(row.near, corridor_face), 0},
          {middle + slot.door_width / 2, std::max(row.near, corridor_face), kDoorHeight}}});
  }

  /// A door between the room that was added last and the one before it; `x` is the left end of the last.
  void add_side_door(const Row& row, double x) {
    const double middle = row.near + (row.far - row.near) * random_.uniform(0.4, 0.6);
    const std::size_t last = layout_.rooms.size() - 1;
    layout_.openings.push_back(
        {{last - 1, last}, {{x - kWall, middle - 0.475, 0}, {x, middle + 0.475, kDoorHeight}}});
  }

  Random random_;
  FloorLayout layout_;
  double half_length_ = 0;
  double width_ = 0;
  std::array<double, 4> depths_{};
};

}  // namespace

FloorLayout lay_out_floor(std::uint64_t seed, int rooms) {
  return FloorDrawer(seed, rooms).take();
}

}  // namespace rds::simulator
