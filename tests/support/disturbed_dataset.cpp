// SPDX-License-Identifier: Apache-2.0
#include "tests/support/disturbed_dataset.hpp"

#include <algorithm>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

constexpr double kHalfFrameS = 0.5 / 30;  // depth is taken that much before or after its colour picture

/// A line of rgb.txt, depth.txt or groundtruth.txt.
struct Entry {
  double stamp_s;
  std::string rest;
};
using Entries = std::vector<Entry>;

Entries read_list(const std::filesystem::path& file) {
  std::istringstream lines(read_text(file));
  Entries entries;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() == '#') continue;
    const auto space = line.find(' ');
    entries.push_back({std::stod(line.substr(0, space)), line.substr(space + 1)});
  }
  return entries;
}

void write_list(const std::filesystem::path& file, const Entries& entries) {
  std::string text;
  for (const Entry& entry : entries) text += fmt::format("{:.6f} {}\n", entry.stamp_s, entry.rest);
  write_text(file, text);
}

/// Rewrites every list; pictures and camera.yaml are linked.
void rewrite(const std::filesystem::path& dataset, const std::filesystem::path& destination,
             const std::function<Entries(const std::string& list, const Entries&)>& change) {
  const auto source = std::filesystem::absolute(dataset);
  std::filesystem::create_directories(destination);
  for (const char* linked : {"rgb", "depth", "camera.yaml"})
    std::filesystem::create_symlink(source / linked, destination / linked);
  for (const std::string list : {"rgb.txt", "depth.txt", "groundtruth.txt"})
    write_list(destination / list, change(list, read_list(source / list)));
}

}  // namespace

void make_blacked_out(const std::filesystem::path& dataset, const std::filesystem::path& destination,
                      FrameRange range, Darkened darkened) {
  const Entries colors = read_list(dataset / "rgb.txt");
  const double begin_s = colors.at(range.first).stamp_s - kHalfFrameS;
  const double end_s = colors.at(range.first + range.count).stamp_s - kHalfFrameS;
  const auto blacken = [&](const std::string& list, Entries entries) {
    const bool color = list == "rgb.txt";
    if (!color && (list != "depth.txt" || darkened == Darkened::kColor)) return entries;
    const cv::Mat picture = cv::imread((dataset / entries.front().rest).string(), cv::IMREAD_UNCHANGED);
    const std::string black = color ? "black_color.png" : "black_depth.png";
    if (!cv::imwrite((destination / black).string(), cv::Mat::zeros(picture.size(), picture.type())))
      throw std::runtime_error(destination.string() + ": picture cannot be written");
    for (Entry& e : entries)
      if (e.stamp_s >= begin_s && e.stamp_s < end_s) e.rest = black;
    return entries;
  };
  rewrite(dataset, destination, blacken);
}

void make_cut(const std::filesystem::path& dataset, const std::filesystem::path& destination,
              FrameRange range) {
  const Entries colors = read_list(dataset / "rgb.txt");
  const double begin_s = colors.at(range.first).stamp_s;
  const double end_s = colors.at(range.first + range.count).stamp_s;
  rewrite(dataset, destination, [&](const std::string& list, Entries entries) {
    if (list != "groundtruth.txt")
      std::erase_if(entries, [&](const Entry& e) { return e.stamp_s >= begin_s && e.stamp_s < end_s; });
    return entries;
  });
}

void make_jump(const std::filesystem::path& dataset, const std::filesystem::path& destination, double until_s,
               double again_from_s, double again_to_s) {
  const double start_s = read_list(dataset / "rgb.txt").front().stamp_s;
  rewrite(dataset, destination, [&](const std::string&, const Entries& entries) {
    Entries changed;
    for (const Entry& e : entries)
      if (e.stamp_s < start_s + until_s) changed.push_back(e);
    for (const Entry& e : entries)
      if (e.stamp_s >= start_s + again_from_s && e.stamp_s < start_s + again_to_s)
        changed.push_back({e.stamp_s + until_s - again_from_s, e.rest});
    return changed;
  });
}

void make_to_and_fro(const std::filesystem::path& dataset, const std::filesystem::path& destination,
                     double from_s, double turn_s, double length_s) {
  const double start_s = read_list(dataset / "rgb.txt").front().stamp_s + from_s;
  const double period_s = turn_s + kHalfFrameS;  // so that no stamp comes twice
  rewrite(dataset, destination, [&](const std::string&, Entries entries) {
    std::erase_if(entries,
                  [&](const Entry& e) { return e.stamp_s < start_s || e.stamp_s > start_s + turn_s; });
    Entries changed;
    for (int pass = 0; pass * period_s < length_s; ++pass) {
      for (const Entry& e : entries) {
        const double since_turn_s = pass % 2 == 0 ? e.stamp_s - start_s : start_s + turn_s - e.stamp_s;
        changed.push_back({start_s + pass * period_s + since_turn_s, e.rest});
      }
      std::ranges::reverse(entries);
    }
    return changed;
  });
}

}  // namespace rds::test
