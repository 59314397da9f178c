// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/camera/camera_driver.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "common/geometry/trajectory.hpp"
#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "rds_msgs/msg/KeyFrameImages.h"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/shared_data.hpp"
#include "tools/evaluation/trajectory_evaluation.hpp"

/// Drivers as there are, each beside a tracker with its defaults.
namespace rds::test {
namespace {

using ::testing::HasSubstr;

constexpr int kDomain = 141;

class Driver : public ::testing::TestWithParam<bus::Vendor> {
 protected:
  void expect_tracked(const DriverHabits& habits, const std::string& settings = "{}") {
    TrackerWithDriver driver(GetParam(), kDomain, habits, settings);
    EXPECT_TRUE(driver.publish_until([&] { return driver.tracked() >= 10; })) << driver.log();
  }
  /// One sentence in the log and in diagnostics, within two seconds of the first picture (measured, not
  /// asserted).
  void expect_warning(const std::string& name, const DriverHabits& habits,
                      const std::vector<std::string>& words) {
    if (vendor_in_turn(warnings_++) != GetParam()) return;
    SCOPED_TRACE(name);
    TrackerWithDriver driver(GetParam(), kDomain, habits);
    const auto started = std::chrono::steady_clock::now();
    std::chrono::duration<double> took{0};
    const auto is_said = [&] {
      const std::string said = driver.log();
      return std::ranges::all_of(
          words, [&](const std::string& word) { return said.find(word) != std::string::npos; });
    };
    EXPECT_TRUE(driver.publish_until([&] {
      if (!is_said()) return false;
      if (took.count() == 0) took = std::chrono::steady_clock::now() - started;
      return driver.diagnosis().find(words.front()) != std::string::npos;
    })) << driver.log()
        << driver.diagnosis();
    fmt::print("{} on {}: said after {:.2f} s\n", name, name_of(GetParam()), took.count());
  }

 private:
  std::size_t warnings_ = 0;
};

TEST_P(Driver, WithSensorDataQosIsReadWithoutASetting) {
  expect_tracked({.best_effort = true});
}

TEST_P(Driver, ThatPublishesCompressedPicturesAloneIsRead) {
  expect_tracked({.compressed = true});
}

TEST_P(Driver, OfAPresetIsReadByItsName) {
  expect_tracked({.color_topic = "camera/rgb/image_raw",
                  .info_topic = "camera/rgb/camera_info",
                  .depth_topic = "camera/depth/image_raw"},
                 "{camera: {preset: xtion}}");
}

TEST_P(Driver, ThatIsSilentlyWrongGetsASentence) {
  expect_warning("another topic", {.color_topic = "camera/rgb/image_raw"},
                 {"nobody publishes camera/color/image_raw", "camera/rgb/image_raw",
                  "set camera.preset to xtion, or camera.color"});
  expect_warning("no camera_info", {.info_topic = ""},
                 {"nobody publishes camera/color/camera_info", "calibration"});
  expect_warning("no depth", {.depth_topic = ""},
                 {"nobody publishes camera/aligned_depth_to_color/image_raw", "align_depth"});
  expect_warning("without partner", {.depth_delay_ns = 7'000'000'000},
                 {"have no partner", "camera.pairing_tolerance_s"});
  expect_warning("unknown encoding", {.encoding = "nv21"},
                 {"camera/color/image_raw: image encoding 'nv21'", "expected one of rgb8"});
  expect_warning("depth elsewhere", {.depth_frame = "camera_depth_optical_frame"},
                 {"no tf joins them, so depth is not registered to colour", "tf_static", "align_depth"});
}

INSTANTIATE_TEST_SUITE_P(Of, Driver, ::testing::ValuesIn(kAllVendors), vendor_name);

/// How two depth pictures agree where both measure.
struct Agreement {
  double alike = 0;     // share of those pixels that differ by less than 2 %
  double measured = 0;  // their share of those that `expected` measures
};
Agreement agreement(const image::DepthImage& expected, const image::DepthImage& given) {
  int all = 0;
  int both = 0;
  int alike = 0;
  for (int y = 0; y < expected.values.rows; ++y)
    for (int x = 0; x < expected.values.cols; ++x) {
      const float wanted = expected.at(x, y);
      if (wanted <= 0) continue;
      ++all;
      if (given.at(x, y) <= 0) continue;
      ++both;
      alike += std::abs(given.at(x, y) - wanted) < 0.02F * wanted ? 1 : 0;
    }
  return {static_cast<double>(alike) / both, static_cast<double>(both) / all};
}

TEST(DepthOfAnotherCamera, IsColoursInTheKeyframe) {
  TrackerWithDriver driver(bus::Vendor::kFastDds, kDomain + 1,
                           {.depth_frame = "camera_depth_optical_frame", .depth_apart = true},
                           "{dynamics: false, loop_closer: false}");
  std::promise<std::shared_ptr<const rds_msgs::msg::KeyFrameImages>> first;
  const auto keyframes = driver.bus().subscribe<rds_msgs::msg::KeyFrameImages>(
      "rds/keyframe/images", bus::kKeyframeImages, [&, is_first = true](const auto& m) mutable {
        if (std::exchange(is_first, false)) first.set_value(m);
      });
  driver.track(0);
  auto keyframe = first.get_future();
  ASSERT_EQ(keyframe.wait_for(10s), std::future_status::ready) << driver.log();
  const auto images = keyframe.get();
  const auto depth =
      messages::to_depth_image(std::shared_ptr<const sensor_msgs::msg::Image>(images, &images->depth()));
  ASSERT_TRUE(depth);
  const auto& recorded = TrackerWithDriver::frames()[0].depth;
  ASSERT_EQ(depth->values.size(), recorded.values.size());
  const auto [alike, measured] = agreement(recorded, *depth);
  fmt::print("{:.1f} % alike, {:.1f} % measured\n", 100 * alike, 100 * measured);
  EXPECT_GT(alike, recording_of_a_room().bound(0.97, 0.91))
      << "but for the edges, which half of the size moves";
  EXPECT_GT(measured, 0.9) << "but for the margin that the other camera does not see, without holes";
}

/// ATE of the recording's first frames [m], each tracked in its turn.
double ate_m(const DriverHabits& habits) {
  TrackerWithDriver driver(bus::Vendor::kFastDds, kDomain + 1, habits,
                           "{dynamics: false, loop_closer: false}");
  std::vector<geometry::StampedPose> path;
  for (std::size_t i = 0; i < TrackerWithDriver::frames().size(); ++i) {
    const auto state = driver.track(i);
    if (state.state() == 1 || state.state() == 2)
      path.push_back({messages::to_nanoseconds(state.header().stamp()),
                      *messages::to_pose(state.map_from_camera()), ""});
  }
  EXPECT_EQ(path.size(), TrackerWithDriver::frames().size()) << driver.log();
  const auto errors = evaluation::evaluate_trajectory(TrackerWithDriver::truth(), path);
  EXPECT_TRUE(errors);
  return errors ? errors->absolute_m.rmse : 1;
}

TEST(PicturesOfAnyDriver, AreTrackedAsThoseOfRgb8) {
  const double reference_m = ate_m({});
  fmt::print("rgb8, plumb_bob: ATE {:.1f} mm\n", 1e3 * reference_m);
  constexpr double kChanceM = 0.003;  // from run to run, and of pictures that were resampled twice
  for (const DriverHabits& habits :
       {DriverHabits{.encoding = "mono8"}, DriverHabits{.encoding = "bayer_rggb8"},
        DriverHabits{.half_depth = true},
        DriverHabits{.depth_frame = "camera_depth_optical_frame", .depth_apart = true},
        DriverHabits{.compressed = true}, DriverHabits{.distortion = "rational_polynomial"},
        DriverHabits{.distortion = "equidistant"}}) {
    const double error_m = ate_m(habits);
    const std::string name = fmt::format(
        "{}, {}{}{}{}", habits.encoding, habits.distortion, habits.half_depth ? ", half depth" : "",
        habits.depth_apart ? ", half depth 5 cm apart" : "", habits.compressed ? ", compressed" : "");
    fmt::print("{}: ATE {:.1f} mm\n", name, 1e3 * error_m);
    EXPECT_LE(error_m, 1.1 * reference_m + kChanceM) << name;
  }
}

}  // namespace
}  // namespace rds::test
