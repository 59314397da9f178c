// SPDX-License-Identifier: Apache-2.0
#include "common/image/sensors/imu_file.hpp"

#include <array>
#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "common/geometry/stamp.hpp"
#include "common/geometry/text_line.hpp"

namespace rds::image {
namespace {

constexpr std::size_t kWithoutGyroscope = 4;  // numbers in a line
constexpr std::size_t kWithGyroscope = 7;

std::optional<ImuMeasurement> parse_line(const std::vector<std::string_view>& words) {
  const auto stamp_ns = geometry::parse_stamp_ns(words[0]);
  if (!stamp_ns) return std::nullopt;
  std::array<double, kWithGyroscope - 1> values{};
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto number = geometry::parse_number(words[i]);
    if (!number) return std::nullopt;
    values[i - 1] = *number;
  }
  return ImuMeasurement{*stamp_ns, {values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
}

}  // namespace

tl::expected<ImuTrack, std::string> read_imu(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file))
    return tl::unexpected(fmt::format("{}: cannot be read, expected an IMU's measurements", file.string()));
  ImuTrack track;
  std::size_t columns = 0;  // as the first line has them
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const auto words = geometry::split_words(line);
    if (words.empty() || line.starts_with('#')) continue;
    if (columns == 0 && (words.size() == kWithGyroscope || words.size() == kWithoutGyroscope))
      columns = words.size();
    const auto measurement = words.size() == columns ? parse_line(words) : std::nullopt;
    if (!measurement)
      return tl::unexpected(fmt::format("{}:{}: expected `timestamp ax ay az wx wy wz`, found {}",
                                        file.string(), number, geometry::shown(line)));
    auto& told = track.measurements;
    if (!told.empty() && measurement->stamp_ns < told.back().stamp_ns)
      return tl::unexpected(fmt::format("{}:{}: stamp {} goes back, expected {} or later", file.string(),
                                        number, words[0], geometry::format_stamp(told.back().stamp_ns)));
    if (told.empty() || measurement->stamp_ns > told.back().stamp_ns) told.push_back(*measurement);
  }
  if (track.measurements.empty())
    return tl::unexpected(fmt::format("{}: expected at least one measurement", file.string()));
  track.has_gyroscope = columns == kWithGyroscope;
  return track;
}

std::string imu_lines(const ImuTrack& track) {
  const auto numbers = [&](const Eigen::Vector3d& in_imu) {
    const Eigen::Vector3d v = track.camera_from_imu.linear() * in_imu;
    return fmt::format(" {:.9f} {:.9f} {:.9f}", v.x(), v.y(), v.z());
  };
  std::string text = fmt::format("# IMU, in the axes of the camera's optical frame\n# timestamp ax ay az{}\n",
                                 track.has_gyroscope ? " wx wy wz" : "");
  for (const ImuMeasurement& m : track.measurements)
    text += geometry::format_stamp(m.stamp_ns) + numbers(m.acceleration) +
            (track.has_gyroscope ? numbers(m.turn_rate) : "") + '\n';
  return text;
}

}  // namespace rds::image
