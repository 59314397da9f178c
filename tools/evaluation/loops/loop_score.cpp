// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/loops/loop_score.hpp"

#include <array>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/evaluation/loops/loop_tolerance.hpp"

namespace rds::evaluation {
namespace {

using geometry::Pose;
using nlohmann::json;

std::int64_t nanoseconds(const json& seconds) {
  return std::llround(seconds.get<double>() * 1e9);
}

Pose pose_from(const json& numbers) {
  const auto n = numbers.get<std::array<double, 7>>();
  return geometry::make_pose({n[0], n[1], n[2]}, Eigen::Quaterniond(n[6], n[3], n[4], n[5]));
}

void add_line(const json& line, std::span<const geometry::StampedPose> truth, LoopScore& score) {
  const auto later = geometry::pose_at(truth, nanoseconds(line.at("stamp")), kMaxTruthGapNs);
  for (const json& loop : line.at("loops")) {
    const Pose earlier_from_later = pose_from(loop.at("earlier_from_later"));
    const auto earlier = geometry::pose_at(truth, nanoseconds(loop.at("earlier")), kMaxTruthGapNs);
    if (!later || !earlier) continue;
    ++(agree(earlier_from_later, earlier->inverse() * *later) ? score.right : score.wrong);
  }
}

}  // namespace

tl::expected<LoopScore, std::string> score_loops(const std::filesystem::path& loops,
                                                 std::span<const geometry::StampedPose> truth) {
  std::ifstream file(loops);
  if (!file) return tl::unexpected(fmt::format("{}: cannot be read", loops.string()));
  LoopScore score;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.empty()) continue;
    try {
      add_line(json::parse(line), truth, score);
    } catch (const json::exception&) {
      return tl::unexpected(fmt::format(
          R"({}:{}: expected {{"stamp": s, "loops": [{{"earlier": s, "earlier_from_later": [7 numbers]}}]}})",
          loops.string(), number));
    }
  }
  return score;
}

}  // namespace rds::evaluation
