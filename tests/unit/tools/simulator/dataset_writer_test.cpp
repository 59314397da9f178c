// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/dataset_writer.hpp"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/image/sensors/imu_file.hpp"

namespace rds::simulator {
namespace {

namespace fs = std::filesystem;

class DatasetWriterTest : public ::testing::Test {
 protected:
  static SimulationOptions options() {
    SimulationOptions options;
    options.people = 1;
    options.seconds = 0.1;
    options.seed = 9;
    return options;
  }
  void SetUp() override { fs::remove_all(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_ =
      fs::temp_directory_path() /
      ("rds_dataset_writer_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
};

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(DatasetWriterTest, WritesPicturesListsAndTruth) {
  const Simulation simulation(options());
  Renderer renderer(simulation.options().camera);
  prepare_folder(folder_, false);
  DatasetWriter writer(simulation, folder_);
  const SimulatedFrame frame = simulation.frame(1, renderer);
  for (int i = 0; i < simulation.frame_count(); ++i) writer.write(i, frame);
  EXPECT_FALSE(fs::exists(folder_ / "rgb.txt"));  // not yet a recording
  writer.finish();

  EXPECT_NE(text_of(folder_ / "rgb.txt").find("1.033333 rgb/1.033333.jpg\n"), std::string::npos);
  EXPECT_NE(text_of(folder_ / "depth.txt").find("1.066667 depth/1.066667.png\n"), std::string::npos);
  EXPECT_NE(text_of(folder_ / "groundtruth.txt").find("\n1.008333 "), std::string::npos);
  const cv::Mat depth = cv::imread((folder_ / "depth/1.033333.png").string(), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(cv::norm(depth, frame.depth, cv::NORM_INF), 0);
  const auto people = nlohmann::json::parse(text_of(folder_ / "people.json"));
  ASSERT_EQ(people["frames"].size(), 3U);
  EXPECT_EQ(people["frames"][1]["timestamp"], "1.033333");
  const auto objects = nlohmann::json::parse(text_of(folder_ / "objects.json"));
  ASSERT_GT(objects.size(), 8U);
  for (const auto& object : objects) {
    const auto& oriented = object.at("oriented");
    const double yaw = oriented.at("yaw").get<double>();
    const double height = oriented.at("size").at(2).get<double>();
    EXPECT_EQ(height, object.at("size").at(2)) << object;
    const double c = std::abs(std::cos(yaw));
    const double s = std::abs(std::sin(yaw));
    const double x = oriented["size"].at(0).get<double>();
    const double y = oriented["size"].at(1).get<double>();
    // What stands turned fits into the hull of its own box, and fills it in each direction by a good part.
    EXPECT_LE(object["size"].at(0).get<double>(), c * x + s * y + 1e-3) << object;
    EXPECT_LE(object["size"].at(1).get<double>(), s * x + c * y + 1e-3) << object;
    EXPECT_GT(object["size"].at(0).get<double>(), 0.6 * (c * x + s * y)) << object;
  }
}

TEST_F(DatasetWriterTest, WritesAnImuThatReachesBeyondTheLastPicture) {
  SimulationOptions asked = options();
  asked.imu = true;
  const Simulation simulation(asked);
  prepare_folder(folder_, false);
  DatasetWriter(simulation, folder_).finish();
  const auto imu = image::read_imu(folder_ / "imu.txt");
  ASSERT_TRUE(imu) << imu.error();
  EXPECT_TRUE(imu->has_gyroscope);
  EXPECT_EQ(imu->measurements[1].stamp_ns - imu->measurements[0].stamp_ns, 5'000'000);
  EXPECT_GT(imu->measurements.back().stamp_ns, std::llround(1e9 * (1 + simulation.time_s(2))));
  for (const auto& m : imu->measurements) EXPECT_NEAR(m.acceleration.norm(), 9.81, 3);
  EXPECT_FALSE(fs::exists(folder_ / "odometry.txt"));
}

TEST_F(DatasetWriterTest, RefusesAFolderWithARecordingUnlessForced) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "rgb.txt") << "#\n";
  EXPECT_THROW(prepare_folder(folder_, false), std::runtime_error);
  EXPECT_NO_THROW(prepare_folder(folder_, true));
  EXPECT_FALSE(fs::exists(folder_ / "rgb.txt"));
}

TEST_F(DatasetWriterTest, NamesTheFolderThatCannotBeMade) {
  std::ofstream(folder_) << "a file";
  try {
    prepare_folder(folder_, false);
    FAIL() << "expected an error";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find(folder_.string()), std::string::npos);
  }
}

}  // namespace
}  // namespace rds::simulator
