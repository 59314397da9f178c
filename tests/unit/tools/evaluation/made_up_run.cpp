// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/tools/evaluation/made_up_run.hpp"

#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <octomap/ColorOcTree.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/stamp.hpp"
#include "common/geometry/trajectory.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {
using geometry::Pose;
using geometry::StampedPose;

constexpr int kFrames = 40;
constexpr int kKeyframeEvery = 4;
constexpr double kResolutionM = 0.05;
constexpr double kUnitsPerMetre = 1000;
constexpr double kNoiseM = 0.01;
const char* const kCameraYaml =
    "width: 640\nheight: 480\nfx: 525.0\nfy: 520.0\ncx: 319.5\ncy: 239.5\n"
    "distortion: [0.1, -0.2, 0.001, 0.002, 0.05]\ndepth_scale: 1000.0\nfps: 15\n";
const geometry::CameraModel kCamera{640, 480, 525, 520, 319.5, 239.5, {0.1, -0.2, 0.001, 0.002, 0.05}};

void write_poses(const std::filesystem::path& file, const std::vector<StampedPose>& poses) {
  if (const auto written = geometry::write_trajectory(file, poses); !written)
    throw std::runtime_error(written.error());
}

std::int64_t stamp_of(int frame) {
  return 10'000'000'000 + frame * std::int64_t{66'667'000};
}

Pose world_from_camera(int frame) {
  const Eigen::AngleAxisd turn(0.004 * frame, Eigen::Vector3d(0.2, 1, 0.1).normalized());
  return geometry::make_pose({0.02 * frame, 0.1 * std::sin(0.3 * frame), 0.01 * frame},
                             Eigen::Quaterniond(turn));
}

/// The person's place in the picture.
cv::Rect person_in(int frame) {
  return {20 + 10 * frame, 120, 110, 300};
}

cv::Mat background_depth(int frame) {
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(3000 - 10 * frame));
  depth(cv::Rect(400 - 3 * frame, 200, 150, 150)).setTo(2200 - 10 * frame);
  depth(cv::Rect(0, 0, 640, 20)).setTo(0);
  return depth;
}

cv::Mat dataset_depth(int frame) {
  cv::Mat depth = background_depth(frame);
  depth(person_in(frame)).setTo(1500);
  return depth;
}

std::string people_json() {
  std::string frames;
  for (int n = 0; n < kFrames; ++n) {
    const cv::Rect box = person_in(n);
    frames += fmt::format(
        R"({}{{"timestamp": "{}", "people": [{{"id": 0, "box": [{}, {}, {}, {}], "visible_fraction": {:.2f}, "area": {}}}]}})",
        n == 0 ? "" : ",\n", geometry::format_stamp(stamp_of(n)), box.x, box.y, box.br().x, box.br().y,
        n % 7 == 0 ? 0.4 : 0.9, box.area());
  }
  return "{\"frames\": [\n" + frames + "]}\n";
}

void write_dataset(const std::filesystem::path& folder, bool with_person) {
  std::string color;
  std::string depth;
  std::vector<StampedPose> truth;
  std::filesystem::create_directories(folder / "depth");
  for (int n = 0; n < kFrames; ++n) {
    const auto stamp = geometry::format_stamp(stamp_of(n));
    color += fmt::format("{} rgb/{}.jpg\n", stamp, stamp);
    depth += fmt::format("{} depth/{}.png\n", stamp, stamp);
    truth.push_back({stamp_of(n), world_from_camera(n), ""});
    cv::imwrite((folder / "depth" / (stamp + ".png")).string(),
                with_person ? dataset_depth(n) : background_depth(n));
    if (!with_person) continue;
    cv::Mat mask = cv::Mat::zeros(480, 640, CV_8UC1);
    mask(person_in(n)).setTo(255);
    std::filesystem::create_directories(folder / "masks");
    cv::imwrite((folder / "masks" / (stamp + ".png")).string(), mask);
  }
  write_text(folder / "rgb.txt", color);
  write_text(folder / "depth.txt", depth);
  write_text(folder / "camera.yaml", kCameraYaml);
  if (with_person) write_text(folder / "people.json", people_json());
  write_poses(folder / "groundtruth.txt", truth);
}

Pose map_from_world() {
  return geometry::make_pose(
      {0.5, -1, 2}, Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized())));
}

std::vector<StampedPose> noisy_trajectory(int every, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, kNoiseM);
  std::vector<StampedPose> poses;
  for (int n = 1; n < kFrames; n += every) {
    Pose pose = map_from_world() * world_from_camera(n);
    for (int axis = 0; axis < 3; ++axis) pose.translation()[axis] += noise(random);
    pose.rotate(Eigen::AngleAxisd(noise(random), Eigen::Vector3d::UnitY()));
    poses.push_back({stamp_of(n), pose, ""});
  }
  return poses;
}

void write_map(const std::filesystem::path& file, const std::vector<StampedPose>& keyframes) {
  octomap::ColorOcTree tree(kResolutionM);
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const int frame = 1 + static_cast<int>(k) * kKeyframeEvery;
    const cv::Mat depth = k % 3 == 0 ? dataset_depth(frame) : background_depth(frame);
    for (int y = 20; y < 480; y += 5)
      for (int x = 0; x < 640; x += 5) {
        const double z = depth.at<std::uint16_t>(y, x) / kUnitsPerMetre;
        const Eigen::Vector3f p = (keyframes[k].map_from_camera * (kCamera.ray({x, y}) * z)).cast<float>();
        tree.updateNode(octomap::point3d(p.x(), p.y(), p.z()), (x + y) % 50 != 0, true);
      }
  }
  tree.updateInnerOccupancy();
  tree.prune();
  tree.write(file.string());
}

void write_predictions(const std::filesystem::path& file) {
  std::mt19937 random(5);
  std::normal_distribution<double> jitter(0, 15);
  std::string text;
  for (int n = 0; n < kFrames; ++n) {
    const cv::Rect box = person_in(n);
    std::string boxes = fmt::format(
        R"({{"id": 1, "label": "person", "box": [{:.3f}, {:.3f}, {:.3f}, {:.3f}]}})", box.x + jitter(random),
        box.y + jitter(random), box.br().x + jitter(random), box.br().y + jitter(random));
    if (n % 5 == 0) boxes += R"(, {"id": 2, "label": "person", "box": [590.5, -20, 700, 90.5]})";
    if (n % 3 == 0) boxes += R"(, {"id": 3, "label": "chair", "box": [0, 0, 640, 480]})";
    if (n % 4 != 3)
      text += fmt::format("{{\"stamp\": {}, \"boxes\": [{}]}}\n", geometry::format_stamp(stamp_of(n)), boxes);
  }
  write_text(file, text);
}

void write_frame_times(const std::filesystem::path& file) {
  std::mt19937 random(9);
  std::gamma_distribution<double> time(5, 3);
  std::string text = "stamp,state,total_ms,predict_ms,boxes\n";
  for (int n = 0; n < kFrames; ++n)
    text += fmt::format("{},tracking,{:.3f},{:.3f},1\n", geometry::format_stamp(stamp_of(n)), time(random),
                        time(random) / 50);
  write_text(file, text);
}

}  // namespace

void make_scored_run(const std::filesystem::path& folder) {
  write_dataset(folder / "background", false);
  write_dataset(folder / "dataset", true);
  const auto run = folder / "run";
  std::filesystem::create_directories(run);
  const auto keyframes = noisy_trajectory(kKeyframeEvery, 3);
  write_poses(run / "trajectory.txt", noisy_trajectory(1, 1));
  write_poses(run / "trajectory_optimized.txt", noisy_trajectory(1, 2));
  write_poses(run / "keyframes.txt", keyframes);
  write_frame_times(run / "frames.csv");
  write_predictions(run / "predictions.jsonl");
  write_map(run / "map.ot", keyframes);
}

}  // namespace rds::test
