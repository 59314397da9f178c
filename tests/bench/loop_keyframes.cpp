// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/loop_keyframes.hpp"

#include <opencv2/features2d.hpp>

#include "common/image/tum_dataset.hpp"

namespace rds::bench {
namespace {

loop_closer::KeyframeFeatures features_of(const image::RgbdFrame& frame, cv::ORB& orb) {
  cv::Mat gray;
  frame.color.to_gray(gray);
  std::vector<cv::KeyPoint> keypoints;
  loop_closer::KeyframeFeatures features;
  orb.detectAndCompute(gray, cv::noArray(), keypoints, features.descriptors);
  for (const auto& keypoint : keypoints) {
    const Eigen::Vector2d pixel(keypoint.pt.x, keypoint.pt.y);
    const float depth = frame.depth.at(cvRound(keypoint.pt.x), cvRound(keypoint.pt.y));
    const Eigen::Vector3f point = (frame.camera.ray(pixel) * static_cast<double>(depth)).cast<float>();
    features.points.push_back(depth > 0 ? point : Eigen::Vector3f::Constant(std::nanf("")));
  }
  features.stamp_ns = frame.stamp_ns;
  return features;
}

}  // namespace

tl::expected<RecordedKeyframes, std::string> read_keyframes(const std::filesystem::path& folder,
                                                            std::size_t every) {
  const auto dataset = image::TumDataset::open(folder);
  if (!dataset) return tl::unexpected(dataset.error());
  if (!dataset->ground_truth()) return tl::unexpected(folder.string() + ": no groundtruth.txt");
  const auto orb = cv::ORB::create(1000);
  RecordedKeyframes recorded;
  for (std::size_t i = 0; i < dataset->frames().size(); i += every) {
    const auto frame = dataset->load(dataset->frames()[i]);
    if (!frame) return tl::unexpected(frame.error());
    recorded.truth.push_back(geometry::interpolate(*dataset->ground_truth(), frame->stamp_ns));
    auto features = features_of(*frame, *orb);
    features.map_epoch = 1;
    features.id = recorded.keyframes.size();
    features.map_from_camera = recorded.truth.back();
    recorded.keyframes.push_back(std::move(features));
  }
  return recorded;
}

std::vector<geometry::Pose> drifted(const std::vector<geometry::Pose>& truth, double drift_share,
                                    double turn_rad) {
  std::vector<geometry::Pose> poses{truth.front()};
  cv::RNG noise(5);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    geometry::Pose step = truth[i - 1].inverse() * truth[i];
    const double length = step.translation().norm();
    step.translation() += length * drift_share * Eigen::Vector3d(1, 0.3, 0.5).normalized();
    for (int axis = 0; axis < 3; ++axis) step.translation()[axis] += noise.gaussian(0.002);
    const Eigen::AngleAxisd turn(length * turn_rad + noise.gaussian(0.001), Eigen::Vector3d::UnitY());
    step.linear() = step.linear() * turn.toRotationMatrix();
    poses.push_back(poses.back() * step);
  }
  return poses;
}

}  // namespace rds::bench
