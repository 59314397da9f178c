// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/geometry_bytes.hpp"

#include <gmock/gmock.h>

namespace rds::map_file {
namespace {

using ::testing::HasSubstr;

geometry::Pose some_pose() {
  return geometry::make_pose({1, -2, 0.3}, Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2));
}

TEST(GeometryBytes, KeyframePosesComeBackBitByBit) {
  const std::vector<geometry::KeyframePose> poses{{3, 17, some_pose()}, {9, -5, some_pose().inverse()}};
  const auto read = keyframe_poses_from_bytes(to_bytes(poses));
  ASSERT_TRUE(read) << read.error();
  ASSERT_EQ(read->size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ((*read)[i].id, poses[i].id);
    EXPECT_EQ((*read)[i].stamp_ns, poses[i].stamp_ns);
    EXPECT_EQ((*read)[i].map_from_camera.matrix(), poses[i].map_from_camera.matrix());
  }
}

TEST(GeometryBytes, RefusesIdsThatDoNotCountUp) {
  const std::vector<geometry::KeyframePose> poses{{3, 17, some_pose()}, {3, 18, some_pose()}};
  const auto read = keyframe_poses_from_bytes(to_bytes(poses));
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error(), HasSubstr("keyframe 3 after keyframe 3"));
}

TEST(GeometryBytes, RefusesAPoseThatIsNotRigid) {
  geometry::Pose stretched = some_pose();
  stretched.linear() *= 1.1;
  ByteWriter writer;
  put(writer, stretched);
  ByteReader reader(writer.bytes());
  EXPECT_TRUE(get_pose(reader).isApprox(geometry::Pose::Identity()));
  EXPECT_FALSE(reader.finish());
}

TEST(GeometryBytes, CamerasComeBackAndMustBeValid) {
  geometry::CameraModel camera{640, 480, 525, 524, 319.5, 239.5, {0.1, -0.2, 0.01, 0.02, 0.3}};
  ByteWriter writer;
  put(writer, camera);
  camera.fy = -1;
  put(writer, camera);
  ByteReader reader(writer.bytes());
  camera.fy = 524;
  EXPECT_EQ(get_camera(reader), camera);
  EXPECT_TRUE(reader.ok());
  get_camera(reader);
  EXPECT_FALSE(reader.ok());
}

}  // namespace
}  // namespace rds::map_file
