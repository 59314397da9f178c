// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/recording_looks.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace rds::doctor {
namespace {
constexpr std::size_t kEdgeViews = 30;

struct Pictures {
  cv::Mat gray;
  image::DepthImage depth;
};

Pictures pictures_of(const image::RgbdFrame& frame) {
  Pictures pictures;
  frame.color.to_gray(pictures.gray);
  pictures.depth = frame.depth;
  return pictures;
}

FrameLook look_at(const image::RgbdFrame& frame, const Pictures& now, const Pictures& before) {
  FrameLook look{frame.stamp_ns, look_at_color(now.gray), look_at_depth(frame.depth),
                 std::numeric_limits<double>::quiet_NaN(), false};
  if (before.gray.empty()) return look;
  look.color_change = cv::norm(now.gray, before.gray, cv::NORM_L1) / static_cast<double>(now.gray.total());
  look.depth_repeated = cv::countNonZero(now.depth.values) > 0 &&
                        cv::norm(now.depth.values, before.depth.values, cv::NORM_INF) == 0;
  return look;
}

}  // namespace

RecordingLooks look_at_pictures(const image::Recording& dataset, std::size_t every) {
  RecordingLooks looks;
  Pictures before;
  const std::size_t looked_at = (dataset.frames().size() + every - 1) / every;
  const std::size_t edges_every = std::max<std::size_t>(1, looked_at / kEdgeViews);
  for (std::size_t i = 0; i < looked_at; ++i) {
    const auto frame = dataset.load(dataset.frames()[i * every]);
    if (!frame) {
      looks.unreadable.push_back(frame.error());
      continue;
    }
    const Pictures now = pictures_of(*frame);
    looks.frames.push_back(look_at(*frame, now, before));
    if (i % edges_every == 0) looks.edges.push_back(find_edges(now.gray, now.depth.values));
    before = now;
  }
  return looks;
}

}  // namespace rds::doctor
