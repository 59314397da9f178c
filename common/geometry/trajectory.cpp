// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "common/geometry/stamp.hpp"
#include "common/geometry/text_line.hpp"

namespace rds::geometry {
namespace {
constexpr std::size_t kNumbersPerLine = 8;
constexpr double kShortestQuaternion = 1e-6;
constexpr double kLongestStampS = 2147483647.0;

/// Other programs write stamps such as 1.305e+09, which only a double can read.
std::optional<std::int64_t> any_stamp_ns(std::string_view word) {
  if (const auto exact = parse_stamp_ns(word)) return exact;
  const auto seconds = parse_number(word);
  if (!seconds || *seconds < 0 || *seconds > kLongestStampS) return std::nullopt;
  return std::llround(*seconds * 1e9);
}

std::optional<StampedPose> parse_line(std::string_view line) {
  const auto words = split_words(line);
  if (words.size() < kNumbersPerLine) return std::nullopt;
  const auto stamp = any_stamp_ns(words[0]);
  std::array<double, kNumbersPerLine - 1> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto number = parse_number(words[i + 1]);
    if (!number) return std::nullopt;
    v[i] = *number;
  }
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (!stamp || q.norm() < kShortestQuaternion) return std::nullopt;
  return StampedPose{*stamp, make_pose({v[0], v[1], v[2]}, q), std::string(words[0])};
}
}  // namespace

tl::expected<std::vector<StampedPose>, std::string> read_trajectory(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file))
    return tl::unexpected(fmt::format("{}: cannot be read, expected a trajectory file", file.string()));
  std::vector<StampedPose> poses;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (split_words(line).empty() || line.starts_with('#')) continue;
    auto pose = parse_line(line);
    if (!pose)
      return tl::unexpected(fmt::format("{}:{}: expected `timestamp tx ty tz qx qy qz qw`, found {}",
                                        file.string(), number, shown(line)));
    if (!poses.empty() && pose->stamp_ns < poses.back().stamp_ns)
      return tl::unexpected(fmt::format("{}:{}: stamp {} goes back, expected {} or later", file.string(),
                                        number, pose->stamp_text, poses.back().stamp_text));
    poses.push_back(std::move(*pose));
  }
  return poses;
}

std::string trajectory_line(const StampedPose& pose) {
  Eigen::Quaterniond q(pose.map_from_camera.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const Eigen::Vector3d t = pose.map_from_camera.translation();
  return fmt::format("{} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}",
                     pose.stamp_text.empty() ? format_stamp(pose.stamp_ns) : pose.stamp_text, t.x(), t.y(),
                     t.z(), q.x(), q.y(), q.z(), q.w());
}

tl::expected<void, std::string> write_trajectory(const std::filesystem::path& file,
                                                 std::span<const StampedPose> poses) {
  auto temporary = file;
  temporary += ".part";
  std::ofstream out(temporary, std::ios::trunc);
  out << "# timestamp tx ty tz qx qy qz qw\n";
  for (const auto& pose : poses) out << trajectory_line(pose) << '\n';
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(temporary, file, error);
  if (!out || error) return tl::unexpected(fmt::format("{}: cannot be written", file.string()));
  return {};
}

Pose interpolate(std::span<const StampedPose> poses, std::int64_t stamp_ns) {
  if (poses.empty()) throw std::invalid_argument("interpolate: at least one pose is needed");
  const auto after = std::ranges::upper_bound(poses, stamp_ns, {}, &StampedPose::stamp_ns);
  if (after == poses.begin()) return poses.front().map_from_camera;
  // Of poses that share a stamp the first counts.
  const auto before = std::ranges::lower_bound(poses, (after - 1)->stamp_ns, {}, &StampedPose::stamp_ns);
  if (after == poses.end()) return before->map_from_camera;
  const double share = static_cast<double>(stamp_ns - before->stamp_ns) /
                       static_cast<double>(after->stamp_ns - before->stamp_ns);
  const Eigen::Quaterniond a(before->map_from_camera.linear());
  const Eigen::Quaterniond b(after->map_from_camera.linear());
  const Eigen::Vector3d t =
      (1 - share) * before->map_from_camera.translation() + share * after->map_from_camera.translation();
  return make_pose(t, a.slerp(share, b));
}

std::optional<Pose> pose_at(std::span<const StampedPose> poses, std::int64_t stamp_ns,
                            std::int64_t max_gap_ns) {
  const auto next = std::ranges::lower_bound(poses, stamp_ns, {}, &StampedPose::stamp_ns);
  if (next == poses.end()) return std::nullopt;
  if (next->stamp_ns == stamp_ns) return next->map_from_camera;
  if (next == poses.begin() || next->stamp_ns - (next - 1)->stamp_ns > max_gap_ns) return std::nullopt;
  return interpolate(poses, stamp_ns);
}

}  // namespace rds::geometry
