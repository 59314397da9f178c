// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/tour.hpp"

#include <algorithm>
#include <numeric>

namespace rds::simulator {
namespace {

constexpr std::uint64_t kTourStream = 22;
constexpr int kComesBackEvery = 3;
constexpr std::size_t kChoices = 2;  // among the nearest rooms

}  // namespace

Tour::Tour(const Scene& scene, const FloorMap& floor, std::uint64_t seed)
    : floor_(floor), random_(seed, kTourStream) {
  for (const Room& room : scene.rooms) rooms_.push_back(room.box);
  last_visit_.assign(rooms_.size(), 0);
}

std::size_t Tour::draw_room(const Eigen::Vector2d& position) {
  const bool comes_back = (visits_ + 1) % kComesBackEvery == 0;
  std::vector<std::size_t> candidates;
  const auto collect = [&](bool visited) {
    for (std::size_t i = 0; i < rooms_.size(); ++i)
      if ((last_visit_[i] > 0) == visited && (visits_ == 0 || last_visit_[i] != visits_))
        candidates.push_back(i);
  };
  collect(comes_back);
  if (candidates.empty()) collect(!comes_back);
  std::ranges::sort(candidates, {},
                    [&](std::size_t i) { return (rooms_[i].center().head<2>() - position).norm(); });
  const std::size_t choices = comes_back ? candidates.size() : std::min(kChoices, candidates.size());
  return candidates[static_cast<std::size_t>(random_.integer(static_cast<int>(choices)))];
}

Eigen::Vector2d Tour::next(const Eigen::Vector2d& position) {
  const std::size_t room = draw_room(position);
  last_visit_[room] = ++visits_;
  const Eigen::Vector2d half = rooms_[room].size().head<2>() / 2;
  const Eigen::Vector2d shift(random_.uniform(-0.4, 0.4), random_.uniform(-0.4, 0.4));
  return floor_.nearest_free(rooms_[room].center().head<2>() + half.cwiseProduct(shift));
}

}  // namespace rds::simulator
