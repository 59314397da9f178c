// SPDX-License-Identifier: Apache-2.0
#include "common/image/camera_yaml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::image {
namespace {
using testing::AllOf;
using testing::HasSubstr;

const std::string kGood =
    "width: 640\nheight: 480\nfx: 517.3\nfy: 516.5\ncx: 318.6\ncy: 255.3\n"
    "distortion: [0.2, -0.9, 0, 0.002, 1.1]\ndepth_scale: 5000.0\n";

std::string error_of(const std::string& text) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "camera.yaml", text);
  const auto read = read_camera_yaml(folder / "camera.yaml");
  return read ? "" : read.error();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(CameraYaml, ReadsAllKeys) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "camera.yaml", kGood + "fps: 15\n");
  const auto read = read_camera_yaml(folder / "camera.yaml");
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(read->camera.width, 640);
  EXPECT_EQ(read->camera.fy, 516.5);
  EXPECT_EQ(read->camera.distortion[4], 1.1);
  EXPECT_EQ(read->depth_scale, 5000);
  EXPECT_EQ(read->fps, 15);
}

TEST(CameraYaml, NamesEveryViolation) {
  EXPECT_THAT(error_of(kGood + "focal: 3\n"),
              AllOf(HasSubstr("camera.yaml: focal"), HasSubstr("unknown key")));
  EXPECT_THAT(error_of(replaced(kGood, "fx: 517.3\n", "")),
              AllOf(HasSubstr("fx: missing"), HasSubstr("expected")));
  EXPECT_THAT(error_of(replaced(kGood, "fx: 517.3", "fx: -517.3")),
              AllOf(HasSubstr("fx: -517.3"), HasSubstr("expected")));
  EXPECT_THAT(error_of(replaced(kGood, "fx: 517.3", "fx: .nan")), HasSubstr("fx: nan"));
  EXPECT_THAT(error_of(replaced(kGood, "width: 640", "width: wide")), HasSubstr("width: wide"));
  EXPECT_THAT(error_of(replaced(kGood, "0.2, ", "")), HasSubstr("[k1, k2, p1, p2, k3]"));
  EXPECT_THAT(error_of("[1, 2"), HasSubstr("camera.yaml:"));
  EXPECT_THAT(error_of("? [a]\n: 1\n"), HasSubstr("camera.yaml"));
  EXPECT_THAT(error_of(""), AllOf(HasSubstr("width: missing"), HasSubstr("depth_scale: missing")));
}

TEST(TumCamera, IsKnownByTheFoldersName) {
  EXPECT_EQ(known_camera_of_folder("rgbd_dataset_freiburg1_rpy")->camera.fx, 517.3);
  EXPECT_EQ(known_camera_of_folder("rgbd_dataset_freiburg2_desk")->camera.cy, 249.7);
  EXPECT_FALSE(known_camera_of_folder("rgbd_dataset_freiburg3_walking_xyz")->camera.has_distortion());
  EXPECT_EQ(known_camera_of_folder("rgbd_bonn_balloon")->depth_scale, 5000);
  EXPECT_FALSE(known_camera_of_folder("kitchen"));
}

}  // namespace
}  // namespace rds::image
