// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/room.hpp"

#include <array>
#include <numbers>
#include <tuple>

#include "tools/simulator/rendering/texture_paint.hpp"
#include "tools/simulator/world/furniture.hpp"
#include "tools/simulator/world/lighting.hpp"
#include "tools/simulator/world/wall.hpp"

namespace rds::simulator {
namespace {

using Eigen::Vector3f;

constexpr float kPi = std::numbers::pi_v<float>;

/// Two ceiling lamps, and a window in the west.
std::vector<Lamp> room_lamps(float half_width, float height) {
  const float z = height - 0.03F;
  return {{{-1.3F, 0, z}, {0.6F, 0, 0}, {0, 0.15F, 0}, kLampColor * 1.25F},
          {{1.3F, 0, z}, {0.6F, 0, 0}, {0, 0.15F, 0}, kLampColor * 1.25F},
          {{-half_width + 0.05F, 1.0F, 1.6F}, {0, 0.5F, 0}, {0, 0, 0.5F}, kWindowColor}};
}

/// Builds the room piece by piece; `random` decides every free choice.
class RoomMaker {
 public:
  RoomMaker(Scene& scene, std::uint64_t seed) : builder_(scene), random_(seed, 1) {
    const double half_width = random_.uniform(2.85, 3.1);
    const double half_depth = random_.uniform(2.55, 2.75);
    constexpr float kHeight = 2.65F;
    const geometry::Box3 box{{-half_width, -half_depth, 0}, {half_width, half_depth, kHeight}};
    const auto hx = static_cast<float>(half_width);
    const auto hy = static_cast<float>(half_depth);
    builder_.begin_room(box, room_lamps(hx, kHeight));
    std::tie(north_, south_, east_, west_) = std::tuple_cat(walls_of(box));
    palette_ = make_palette(builder_, random_);
    shell(hx, hy, kHeight);
  }

  void furnish() {
    desk_side();
    sofa_side();
    television_side();
    dining_side();
  }

 private:
  float f(double low, double high) { return static_cast<float>(random_.uniform(low, high)); }

  void shell(float hx, float hy, float height) {
    const cv::Scalar wall(random_.uniform(165, 205), random_.uniform(185, 210), random_.uniform(190, 215));
    const std::uint16_t wallpaper = builder_.material(paint::wallpaper(random_, wall));
    const std::uint16_t floor =
        builder_.material(paint::parquet(random_, cv::Scalar(82, 125, 165)), {.takes_shadows = true});
    const std::uint16_t carpet = builder_.material(paint::carpet(random_), {.takes_shadows = true});
    const std::uint16_t ceiling =
        builder_.material(paint::speckled(random_, {256, 256}, cv::Scalar(225, 230, 232), 4, 5));
    const std::uint16_t lamp =
        builder_.material(cv::Mat(8, 8, CV_8UC3, cv::Scalar(235, 245, 250)), {.emission = 1});
    builder_.panel({0, 0, 0}, {2 * hx, 0, 0}, {0, 2 * hy, 0}, floor, {.metres = 1.3F});
    builder_.panel({0, 0.1F, 0.006F}, {f(2.5, 2.9), 0, 0}, {0, f(1.8, 2.2), 0}, carpet);
    builder_.panel({0, 0, height}, {2 * hx, 0, 0}, {0, -2 * hy, 0}, ceiling, {.metres = 1.1F});
    for (const float x : {-1.3F, 1.3F})
      builder_.panel({x, 0, height - 0.01F}, {1.2F, 0, 0}, {0, -0.3F, 0}, lamp);
    for (const Wall& wall_side : {north_, south_, east_, west_}) {
      const float width = 2 * (std::abs(wall_side.right.x()) > 0.5F ? hx : hy);
      builder_.panel(wall_side.middle + Vector3f(0, 0, height / 2), wall_side.right * width, {0, 0, height},
                     wallpaper, {.metres = 1.6F});
      builder_.begin("", wall_side.middle.x(), wall_side.middle.y(), 0, wall_side.yaw_rad);
      builder_.box({0, -0.008F, 0.045F}, {width, 0.016F, 0.09F}, palette_.white);
      builder_.begin_building();
    }
  }

  /// Framed panel on a wall, `along` to the right of its middle.
  void hang(const Wall& wall, float along, float z, float width, float height, std::uint16_t picture,
            std::uint16_t frame) {
    add_framed_panel(builder_, wall.stand(along, 0.012F, 0, z), width, height, picture, frame);
  }

  void hang_poster(const Wall& wall, float along, float z, float width) {
    const bool painting = random_.chance(0.4);
    hang(wall, along, z, width, width * f(0.8, 1.35),
         builder_.material(painting ? paint::picture(random_) : paint::poster(random_)),
         painting ? palette_.walnut : palette_.white);
  }

  void desk_side() {
    const float x = f(-0.25, 0.25);
    const Place desk = north_.stand(x, 0.45F);
    constexpr float kWidth = 1.7F;
    add_table(builder_, palette_, desk, kWidth, 0.8F);
    const float top = 0.74F;
    add_monitor(builder_, palette_, north_.stand(x - 0.37F, 0.34F, f(-0.1, 0.25), top), f(0.52, 0.6),
                random_);
    add_monitor(builder_, palette_, north_.stand(x + 0.34F, 0.32F, f(-0.25, 0.1), top), f(0.48, 0.56),
                random_);
    add_desk_clutter(builder_, palette_, {desk.x, desk.y, top, desk.yaw_rad}, kWidth, random_);
    add_bottle(builder_, north_.stand(x - 0.77F, 0.5F, 0, top), random_);
    add_office_chair(builder_, palette_, north_.stand(x - f(0.35, 0.55), f(1.05, 1.2), kPi + f(-0.7, 0.7)));
    add_chair(builder_, palette_, north_.stand(x + f(0.4, 0.65), f(1.0, 1.15), kPi + f(-0.6, 0.6)));
    add_shelf(builder_, palette_, north_.stand(f(1.75, 1.95), 0.17F), 0.95F, f(1.8, 2.1), random_);
    add_plant(builder_, palette_, north_.stand(f(-1.6, -1.45), 0.6F), f(1.15, 1.4), random_);
    add_cardboard_box(builder_, north_.stand(f(-2.35, -2.2), 0.4F, f(-0.3, 0.3)), {0.5F, 0.4F, 0.42F},
                      random_);
    add_cardboard_box(builder_, north_.stand(f(-2.32, -2.25), 0.4F, f(-0.4, 0.4), 0.42F),
                      {0.36F, 0.3F, 0.26F}, random_);
    hang(north_, x - 0.55F, 1.72F, 1.15F, 0.62F, builder_.material(paint::whiteboard(random_)),
         palette_.metal);
    hang_poster(north_, x + 0.62F, 1.68F, f(0.5, 0.6));
    hang(north_, x + 1.12F, 2.05F, 0.3F, 0.3F, builder_.material(paint::clock_face()), palette_.black);
    hang_poster(north_, -2.1F, 1.55F, f(0.5, 0.62));
  }

  void sofa_side() {
    add_sofa(builder_, palette_, east_.stand(f(-0.2, 0.2), 0.47F), f(1.75, 1.95));
    add_floor_lamp(builder_, palette_, east_.stand(f(1.25, 1.4), 0.35F));
    add_cardboard_box(builder_, east_.stand(-1.5F, 0.4F, f(-0.4, 0.4)), {0.42F, 0.42F, 0.36F}, random_);
    hang_poster(east_, -0.55F, 1.55F, f(0.6, 0.75));
    hang_poster(east_, 0.45F, 1.6F, f(0.5, 0.65));
    hang_poster(east_, 1.4F, 1.65F, f(0.45, 0.6));
    hang_poster(east_, -1.5F, 1.5F, f(0.5, 0.6));
  }

  void television_side() {
    const float y = f(-0.5, -0.2);
    const float low = 0.62F;
    add_shelf(builder_, palette_, west_.stand(y, 0.17F), 1.5F, low, random_);
    add_monitor(builder_, palette_, west_.stand(y, 0.2F, f(-0.15, 0.15), low), f(0.85, 1.0), random_);
    add_bottle(builder_, west_.stand(y + 0.62F, 0.16F, 0, low), random_);
    add_chair(builder_, palette_, west_.stand(y + f(1.2, 1.35), 0.55F, f(-0.5, 0.5)));
    add_plant(builder_, palette_, west_.stand(-1.75F, 0.48F), f(0.9, 1.1), random_);
    hang(west_, y + 1.35F, 1.6F, 1.0F, 1.1F,
         builder_.material(paint::window_view(random_), {.emission = 0.85F}), palette_.white);
    hang_poster(west_, y - 0.35F, 1.75F, f(0.45, 0.55));
    hang_poster(west_, y + 0.4F, 1.72F, f(0.45, 0.6));
    hang_poster(west_, y - 1.3F, 1.6F, f(0.5, 0.7));
  }

  void dining_side() {
    const float x = f(-0.35, 0.1);
    const Place table = south_.stand(x, 0.62F);
    add_table(builder_, palette_, table, f(1.15, 1.35), 0.8F);
    add_bottle(builder_, south_.stand(x + f(0.1, 0.25), 0.62F, 0, 0.74F), random_);
    add_bottle(builder_, south_.stand(x + f(-0.2, -0.05), 0.55F, 0, 0.74F), random_);
    add_plant(builder_, palette_, south_.stand(x - 0.4F, 0.45F, 0, 0.74F), f(0.42, 0.5), random_);
    add_chair(builder_, palette_, south_.stand(x + f(0.9, 1.0), 0.62F, -kPi / 2 + f(-0.35, 0.35)));
    add_chair(builder_, palette_, south_.stand(x - f(0.9, 1.0), 0.62F, kPi / 2 + f(-0.35, 0.35)));
    add_shelf(builder_, palette_, south_.stand(f(1.95, 2.1), 0.17F), 0.85F, f(1.5, 1.9), random_);
    add_cardboard_box(builder_, south_.stand(f(-2.2, -2.05), 0.42F, f(-0.4, 0.4)), {0.55F, 0.4F, 0.5F},
                      random_);
    hang_poster(south_, -0.75F, 1.65F, f(0.6, 0.75));
    hang_poster(south_, 0.25F, 1.6F, f(0.5, 0.7));
    hang_poster(south_, 1.15F, 1.7F, f(0.45, 0.6));
    hang_poster(south_, -1.7F, 1.6F, f(0.5, 0.65));
  }

  SceneBuilder builder_;
  Random random_;
  Palette palette_;
  Wall north_{};
  Wall south_{};
  Wall east_{};
  Wall west_{};
};

}  // namespace

Scene make_room(std::uint64_t seed) {
  Scene scene;
  RoomMaker(scene, seed).furnish();
  bake_light(scene);
  return scene;
}

}  // namespace rds::simulator
