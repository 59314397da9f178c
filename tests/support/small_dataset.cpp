// SPDX-License-Identifier: Apache-2.0
#include "tests/support/small_dataset.hpp"

#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {
constexpr int kWidth = 64;
constexpr int kHeight = 48;

void write_pictures(const std::filesystem::path& folder, const std::string& stamp, cv::RNG& random) {
  cv::Mat color(kHeight, kWidth, CV_8UC3);
  random.fill(color, cv::RNG::UNIFORM, 0, 255);
  cv::Mat depth(kHeight, kWidth, CV_16UC1);
  random.fill(depth, cv::RNG::UNIFORM, 1000, 3000);
  if (!cv::imwrite((folder / "rgb" / (stamp + ".jpg")).string(), color) ||
      !cv::imwrite((folder / "depth" / (stamp + ".png")).string(), depth))
    throw std::runtime_error(folder.string() + ": pictures cannot be written");
}

/// Comments and the lines `start` … `start + count − 1` of a list.
std::string part_of_list(const std::string& list, std::size_t start, std::size_t count) {
  std::istringstream in(list);
  std::string part;
  std::string line;
  for (std::size_t entry = 0; std::getline(in, line);) {
    const bool comment = line.empty() || line.front() == '#';
    if (comment || (entry >= start && entry < start + count)) part += line + '\n';
    if (!comment) ++entry;
  }
  return part;
}
}  // namespace

void make_small_dataset(const std::filesystem::path& folder, std::size_t frames) {
  std::filesystem::create_directories(folder / "rgb");
  std::filesystem::create_directories(folder / "depth");
  cv::RNG random(7);
  std::string color;
  std::string depth;
  std::string truth;
  for (std::size_t i = 0; i < frames; ++i) {
    const double seconds = 10 + static_cast<double>(i) / 30;
    const std::string stamp = fmt::format("{:.6f}", seconds);
    write_pictures(folder, stamp, random);
    color += fmt::format("{} rgb/{}.jpg\n", stamp, stamp);
    depth += fmt::format("{} depth/{}.png\n", stamp, stamp);
    truth += fmt::format("{} {:.6f} 0 0 0 0 0 1\n", stamp, 0.3 * (seconds - 10));
  }
  write_text(folder / "rgb.txt", "# colour\n" + color);
  write_text(folder / "depth.txt", "# depth\n" + depth);
  write_text(folder / "groundtruth.txt", "# timestamp tx ty tz qx qy qz qw\n" + truth);
  write_text(folder / "camera.yaml",
             fmt::format("width: {}\nheight: {}\nfx: 60.0\nfy: 60.0\ncx: 31.5\ncy: 23.5\n"
                         "distortion: [0.0, 0.0, 0.0, 0.0, 0.0]\ndepth_scale: 1000.0\nfps: 30\n",
                         kWidth, kHeight));
}

void make_excerpt(const std::filesystem::path& dataset, const std::filesystem::path& destination,
                  std::size_t frames, std::size_t start) {
  const auto source = std::filesystem::absolute(dataset);
  std::filesystem::create_directories(destination);
  for (const char* list : {"rgb.txt", "depth.txt"})
    write_text(destination / list, part_of_list(read_text(source / list), start, frames));
  for (const char* whole : {"rgb", "depth", "masks", "camera.yaml", "groundtruth.txt", "people.json"})
    if (std::filesystem::exists(source / whole))
      std::filesystem::create_symlink(source / whole, destination / whole);
}

}  // namespace rds::test
