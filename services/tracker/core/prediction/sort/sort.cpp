// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/sort/sort.hpp"

#include "services/tracker/core/prediction/sort/assignment.hpp"

namespace rds::tracker::prediction {
namespace {

/// True if no row and no column holds more than one overlap above the threshold.
bool is_one_to_one(const Eigen::MatrixXd& overlap, double threshold) {
  const Eigen::ArrayXXi above = (overlap.array() > threshold).cast<int>();
  return above.rowwise().sum().maxCoeff() == 1 && above.colwise().sum().maxCoeff() == 1;
}

}  // namespace

std::vector<std::uint64_t> Sort::update(double frames, std::span<const geometry::Box2> boxes) {
  ++updates_;
  predict(frames);
  const auto track_of = match(boxes);
  std::vector<std::uint64_t> ids;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (track_of[i] < 0) {
      tracks_.push_back({++last_id_, BoxFilter(boxes[i]), 0, 0});
      ids.push_back(last_id_);
      continue;
    }
    Track& track = tracks_[static_cast<std::size_t>(track_of[i])];
    track.filter.correct(boxes[i]);
    track.age = 0;
    ++track.hit_streak;
    ids.push_back(track.id);
  }
  std::erase_if(tracks_, [&](const Track& track) { return track.age > config_.max_age; });
  return ids;
}

bool Sort::is_reported(const Track& track) const {
  return track.age == 0 && (track.hit_streak >= config_.min_hits || updates_ <= config_.min_hits);
}

void Sort::predict(double frames) {
  for (Track& track : tracks_) {
    track.filter.predict(frames);
    if (track.age > 0) track.hit_streak = 0;
    track.age += frames;
  }
  std::erase_if(tracks_, [](const Track& track) { return !track.filter.is_finite(); });
}

std::vector<std::ptrdiff_t> Sort::match(std::span<const geometry::Box2> boxes) const {
  std::vector<std::ptrdiff_t> track_of(boxes.size(), -1);
  if (boxes.empty() || tracks_.empty()) return track_of;
  Eigen::MatrixXd overlap(boxes.size(), tracks_.size());
  for (Eigen::Index j = 0; j < overlap.cols(); ++j) {
    const geometry::Box2 predicted = tracks_[static_cast<std::size_t>(j)].filter.box();
    for (Eigen::Index i = 0; i < overlap.rows(); ++i)
      overlap(i, j) = geometry::iou(boxes[static_cast<std::size_t>(i)], predicted);
  }
  if (is_one_to_one(overlap, config_.min_iou)) {
    // Unambiguous pairs are taken as they are: an assignment may break one for a larger sum.
    overlap = (overlap.array() > config_.min_iou).select(overlap, 0);
  }
  const auto column_of = assign(-overlap);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (column_of[i] && overlap(static_cast<Eigen::Index>(i), *column_of[i]) >= config_.min_iou)
      track_of[i] = *column_of[i];
  return track_of;
}

}  // namespace rds::tracker::prediction
