// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/simulation.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tools/simulator/building/floor_layout.hpp"
#include "tools/simulator/world/visibility.hpp"

namespace rds::simulator {
namespace {

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

SimulationOptions short_recording(int people) {
  SimulationOptions options;
  options.people = people;
  options.seconds = 2;
  options.seed = 4;
  return options;
}

TEST(Simulation, SameSeedSameFramesWhateverWasRenderedBefore) {
  const Simulation a(short_recording(2));
  const Simulation b(short_recording(2));
  Renderer renderer_a(a.options().camera);
  Renderer renderer_b(b.options().camera);
  (void)a.frame(3, renderer_a);
  const SimulatedFrame x = a.frame(20, renderer_a);
  const SimulatedFrame y = b.frame(20, renderer_b);
  EXPECT_TRUE(same(x.color, y.color));
  EXPECT_TRUE(same(x.depth, y.depth));
  EXPECT_TRUE(same(x.mask, y.mask));
}

TEST(Simulation, TwinWithoutPeopleIsTheSameWhereNobodyIs) {
  const Simulation with(short_recording(2));
  const Simulation without(short_recording(0));
  Renderer renderer(with.options().camera);
  const SimulatedFrame a = with.frame(15, renderer);
  const SimulatedFrame b = without.frame(15, renderer);
  ASSERT_FALSE(a.people.empty());
  EXPECT_TRUE(b.people.empty());
  // Depth: a person's own pixels, the rim around them and the projector's shadow to their right differ.
  cv::Mat person;
  cv::dilate(a.mask, person, cv::getStructuringElement(cv::MORPH_RECT, {141, 7}));
  int differs = 0;
  int compared = 0;
  for (int y = 0; y < a.depth.rows; ++y)
    for (int x = 0; x < a.depth.cols; ++x) {
      if (person.at<std::uint8_t>(y, x) != 0) continue;
      ++compared;
      differs += a.depth.at<std::uint16_t>(y, x) != b.depth.at<std::uint16_t>(y, x) ? 1 : 0;
    }
  ASSERT_GT(compared, 50000);
  EXPECT_EQ(differs, 0);
  // Colour: the upper part of the picture has no shadows of people.
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < a.color.cols; ++x) {
      if (person.at<std::uint8_t>(y, x) != 0) continue;
      ASSERT_EQ(a.color.at<cv::Vec3b>(y, x), b.color.at<cv::Vec3b>(y, x));
    }
}

TEST(Simulation, DepthOfOneFrameFitsAnotherThroughTheGroundTruth) {
  const Simulation simulation(short_recording(0));
  Renderer renderer(simulation.options().camera);
  const auto& camera = simulation.options().camera;
  const SimulatedFrame a = simulation.frame(0, renderer);
  const SimulatedFrame b = simulation.frame(55, renderer);
  const geometry::Pose b_from_a =
      simulation.world_from_camera(simulation.time_s(55)).inverse() * simulation.world_from_camera(0);
  ASSERT_GT(b_from_a.translation().norm(), 0.05);
  int compared = 0;
  int agree = 0;
  for (int v = 8; v < camera.height; v += 4)
    for (int u = 8; u < camera.width; u += 4) {
      const double z = a.depth.at<std::uint16_t>(v, u) / DepthSensor::kUnitsPerMetre;
      if (z <= 0) continue;
      const Eigen::Vector3d p = b_from_a * Eigen::Vector3d(camera.ray({1.0 * u, 1.0 * v}) * z);
      const Eigen::Vector2d q = camera.project(p);
      const int x = static_cast<int>(std::lround(q.x()));
      const int y = static_cast<int>(std::lround(q.y()));
      if (x < 0 || y < 0 || x >= camera.width || y >= camera.height) continue;
      const double measured = b.depth.at<std::uint16_t>(y, x) / DepthSensor::kUnitsPerMetre;
      if (measured <= 0) continue;
      ++compared;
      agree += std::abs(measured - p.z()) < 4 * simulation.depth_sensor().sigma_m(p.z()) + 0.01 ? 1 : 0;
    }
  ASSERT_GT(compared, 5000);
  EXPECT_GT(agree, 0.93 * compared);
}

TEST(Simulation, AFloorLooksAsIfAllItsRoomsHadBeenDrawn) {
  SimulationOptions options = short_recording(0);
  options.world = World::kFloor;
  options.rooms = kFewestRooms;
  options.seconds = 20;
  const Simulation simulation(options);
  const Scene& scene = simulation.scene();
  std::vector<const Mesh*> all;
  for (const Room& room : scene.rooms) all.push_back(&room.mesh);
  Renderer renderer(options.camera);
  for (const double t : {0.0, 6.0, 12.0, 18.0}) {
    const geometry::Pose pose = simulation.world_from_camera(t);
    const auto visible = visible_rooms(scene, options.camera, pose);
    EXPECT_LT(visible.size(), scene.rooms.size());
    std::vector<const Mesh*> drawn;
    for (const std::size_t room : visible) drawn.push_back(&scene.rooms[room].mesh);
    Rendering whole;
    Rendering culled;
    renderer.render(all, scene.appearance, {}, pose, whole);
    renderer.render(drawn, scene.appearance, {}, pose, culled);
    EXPECT_TRUE(same(whole.color, culled.color)) << t;
    EXPECT_TRUE(same(whole.depth, culled.depth)) << t;
    EXPECT_EQ(cv::countNonZero(whole.depth == 0), 0) << t;  // no gap in the walls
  }
}

TEST(Simulation, BoxesAndAreasAreThoseOfTheMasks) {
  const Simulation simulation(short_recording(3));
  Renderer renderer(simulation.options().camera);
  const SimulatedFrame frame = simulation.frame(30, renderer);
  int listed = 0;
  for (const auto& person : frame.people) {
    cv::Mat own;
    cv::compare(frame.mask, person.id + 1, own, cv::CMP_EQ);
    EXPECT_EQ(cv::boundingRect(own), person.box);
    EXPECT_EQ(cv::countNonZero(own), person.area);
    EXPECT_GT(person.visible_fraction, 0);
    EXPECT_LE(person.visible_fraction, 1);
    listed += person.area;
  }
  EXPECT_EQ(cv::countNonZero(frame.mask), listed);
}

TEST(Simulation, LabelledThingsLieInTheRoomAndShowTheirLabels) {
  const Simulation simulation(short_recording(0));
  std::map<std::string, int> count;
  const Eigen::Vector3d half = simulation.scene().bounds().max;
  for (const auto& object : simulation.scene().objects) {
    if (object.label.empty()) continue;
    ++count[object.label];
    EXPECT_TRUE((object.box.size().array() > 0.02).all()) << object.label;
    EXPECT_TRUE((object.box.min.head<2>().array() > -half.head<2>().array() - 0.01).all()) << object.label;
    EXPECT_TRUE((object.box.max.head<2>().array() < half.head<2>().array() + 0.01).all()) << object.label;
  }
  for (const char* label : {"chair", "tvmonitor", "diningtable", "sofa", "pottedplant", "bottle"})
    EXPECT_GT(count[label], 0) << label;
}

}  // namespace
}  // namespace rds::simulator
