// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/geometry_bytes.hpp"

#include <fmt/format.h>

namespace rds::map_file {
namespace {

constexpr double kRigid = 1e-6;          // what a rotation's elements may be off
constexpr double kFarthest = 1e6;        // m
constexpr std::size_t kPoseBytes = 112;  // id, stamp, 3 × 4 numbers
constexpr int kMaxSide = 8192;           // px

bool is_rigid(const geometry::Pose& pose) {
  const Eigen::Matrix3d R = pose.linear();
  return (R * R.transpose()).isIdentity(kRigid) && R.determinant() > 0 &&
         pose.translation().norm() < kFarthest;
}

}  // namespace

void put(ByteWriter& writer, const Eigen::Vector3d& vector) {
  for (const double element : vector) writer.put(element);
}

Eigen::Vector3d get_vector(ByteReader& reader) {
  Eigen::Vector3d vector;
  for (double& element : vector) element = reader.get<double>();
  return vector;
}

void put(ByteWriter& writer, const geometry::Pose& pose) {
  for (Eigen::Index column = 0; column < 4; ++column)
    put(writer, Eigen::Vector3d(pose.matrix().col(column).head<3>()));
}

geometry::Pose get_pose(ByteReader& reader) {
  geometry::Pose pose = geometry::Pose::Identity();
  for (Eigen::Index column = 0; column < 4; ++column)
    pose.matrix().col(column).head<3>() = get_vector(reader);
  if (reader.ok() && !is_rigid(pose)) reader.refuse("a pose that is not a rigid transform");
  return reader.ok() ? pose : geometry::Pose::Identity();
}

void put(ByteWriter& writer, const geometry::CameraModel& camera) {
  writer.put(camera.width);
  writer.put(camera.height);
  for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy}) writer.put(value);
  for (const double value : camera.distortion) writer.put(value);
}

geometry::CameraModel get_camera(ByteReader& reader) {
  geometry::CameraModel camera;
  camera.width = reader.get<int>();
  camera.height = reader.get<int>();
  for (double* value : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) *value = reader.get<double>();
  for (double& value : camera.distortion) value = reader.get<double>();
  if (reader.ok() && (!camera.is_valid() || camera.width > kMaxSide || camera.height > kMaxSide))
    reader.refuse("a camera that is not valid");
  return camera;
}

Bytes to_bytes(std::span<const geometry::KeyframePose> poses) {
  ByteWriter writer;
  writer.put_count(poses.size());
  for (const geometry::KeyframePose& keyframe : poses) {
    writer.put(keyframe.id);
    writer.put(keyframe.stamp_ns);
    put(writer, keyframe.map_from_camera);
  }
  return writer.take();
}

tl::expected<std::vector<geometry::KeyframePose>, std::string> keyframe_poses_from_bytes(
    std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  std::vector<geometry::KeyframePose> poses(reader.get_count(kPoseBytes));
  for (std::size_t i = 0; i < poses.size() && reader.ok(); ++i) {
    poses[i].id = reader.get<std::uint64_t>();
    poses[i].stamp_ns = reader.get<std::int64_t>();
    poses[i].map_from_camera = get_pose(reader);
    if (i > 0 && poses[i].id <= poses[i - 1].id)
      reader.refuse(fmt::format("keyframe {} after keyframe {}", poses[i].id, poses[i - 1].id));
  }
  if (const auto read = reader.finish(); !read) return tl::unexpected(read.error());
  return poses;
}

}  // namespace rds::map_file
