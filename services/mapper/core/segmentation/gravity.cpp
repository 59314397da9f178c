// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/gravity.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rds::mapper {
namespace {

constexpr double kDegree = 3.14159265358979 / 180;
constexpr double kMaxTilt = 40 * kDegree;
constexpr double kCone = 5 * kDegree;
constexpr std::size_t kMaxKeyframes = 40;
constexpr std::size_t kMaxCandidates = 300;
constexpr std::size_t kMinVotes = 50;
constexpr int kStep = 8;          // sampled pixels between two normals
constexpr int kReach = 3;         // sampled pixels from a normal's centre to its neighbours
constexpr float kMaxStep = 0.1F;  // neighbours farther apart than this share of depth straddle an edge

/// Appends the normals [map frame, on guess's side] of a keyframe that lie near the guess.
void append_normals(const KeyframeRecord& record, const Eigen::Vector3d& guess,
                    std::vector<Eigen::Vector3d>& normals) {
  const auto point = [&](int x, int y, Eigen::Vector3f& p) {
    const auto i = record.grid.index(x, y);
    p = record.point_in_camera(i);
    return looks_static(record.classes[i]);
  };
  Eigen::Vector3f left;
  Eigen::Vector3f right;
  Eigen::Vector3f above;
  Eigen::Vector3f below;
  for (int y = kReach; y + kReach < record.grid.height; y += kStep)
    for (int x = kReach; x + kReach < record.grid.width; x += kStep) {
      if (!point(x - kReach, y, left) || !point(x + kReach, y, right) || !point(x, y - kReach, above) ||
          !point(x, y + kReach, below))
        continue;
      const float limit = kMaxStep * left.z();
      if ((right - left).norm() > limit || (below - above).norm() > limit) continue;
      Eigen::Vector3d normal =
          record.map_from_camera.linear() * (right - left).cross(below - above).normalized().cast<double>();
      if (normal.dot(guess) < 0) normal = -normal;
      if (normal.dot(guess) > std::cos(kMaxTilt)) normals.push_back(normal);
    }
}

std::size_t votes_for(const Eigen::Vector3d& axis, const std::vector<Eigen::Vector3d>& normals,
                      Eigen::Vector3d& mean) {
  std::size_t votes = 0;
  mean.setZero();
  for (const auto& normal : normals)
    if (normal.dot(axis) > std::cos(kCone)) {
      ++votes;
      mean += normal;
    }
  return votes;
}

}  // namespace

Eigen::Vector3d axis_of(const std::string& name) {
  const bool negative = name.starts_with('-');
  const std::string axis = name.substr(negative ? 1 : 0);
  if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z') throw std::invalid_argument("no axis: " + name);
  return Eigen::Vector3d::Unit(axis[0] - 'x') * (negative ? -1 : 1);
}

Eigen::Vector3d estimate_up(std::span<const geometry::Pose> poses,
                            const std::function<std::optional<KeyframeRecord>(std::size_t)>& record_of) {
  Eigen::Vector3d guess = Eigen::Vector3d::Zero();
  for (const auto& pose : poses) guess -= pose.linear().col(1);
  if (guess.norm() < 1e-3) return -Eigen::Vector3d::UnitY();
  guess.normalize();

  std::vector<Eigen::Vector3d> normals;
  const std::size_t step = poses.size() / kMaxKeyframes + 1;
  for (std::size_t i = 0; i < poses.size(); i += step)
    if (const auto record = record_of(i)) append_normals(*record, guess, normals);

  Eigen::Vector3d up = guess;
  Eigen::Vector3d mean;
  std::size_t most = kMinVotes;
  const std::size_t candidate_step = normals.size() / kMaxCandidates + 1;
  for (std::size_t i = 0; i < normals.size(); i += candidate_step) {
    const auto votes = votes_for(normals[i], normals, mean);
    if (votes > most) {
      most = votes;
      up = mean.normalized();
    }
  }
  for (int i = 0; i < 3 && most > kMinVotes; ++i)
    if (votes_for(up, normals, mean) > 0) up = mean.normalized();
  return up;
}

}  // namespace rds::mapper
