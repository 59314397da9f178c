// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/visits/visit_score.hpp"

#include <algorithm>
#include <iterator>

#include "tools/evaluation/visits/depth_views.hpp"
#include "tools/evaluation/visits/moved_pieces.hpp"

namespace rds::evaluation {
namespace {

using Views = std::vector<PointViews>;

constexpr std::uint32_t kFewestViews = 3;   // as static_recall asks
constexpr std::size_t kSmallestPiece = 30;  // voxels that show: a lamp has a hundred
constexpr int kMapMargin = 2;               // voxels: as far as a map is off
constexpr double kMostLeft = 0.1;
constexpr double kLeastThere = 0.9;

bool is_on_surface(const PointViews& views) {
  return views.on_surface >= kFewestViews;
}
bool is_seen_through(const PointViews& views) {
  return views.seen_through >= kFewestViews && views.on_surface == 0;
}

VoxelSet united(const VoxelSet& a, const VoxelSet& b) {
  VoxelSet all;
  std::ranges::set_union(a, b, std::back_inserter(all));
  return all;
}

double share_near(const VoxelSet& voxels, const VoxelSet& others, int radius) {
  const auto near =
      std::ranges::count_if(voxels, [&](VoxelKey key) { return has_neighbour(others, key, radius); });
  return static_cast<double>(near) / static_cast<double>(voxels.size());
}

/// Of a set, those for which is(index).
template <class Indices, class Is>
VoxelSet chosen(const VoxelSet& voxels, const Indices& indices, Is is) {
  VoxelSet chosen;
  for (const std::size_t i : indices)
    if (is(i)) chosen.push_back(voxels[i]);
  return chosen;
}

/// Scores one map. Voxels are those of the truth's grid.
class VisitScorer {
 public:
  explicit VisitScorer(const VisitScoreInput& input)
      : input_(input), map_(voxels_of(input.map)), truth_(voxels_of(input.visit.surfaces)) {
    for (const Visit& before : input.earlier) {
      before_ = united(before_, voxels_of(before.surfaces));
      new_ = united(new_, away_from(voxels_of(before.surfaces), truth_, kMapMargin));
    }
  }

  tl::expected<VisitScore, std::string> score() {
    score_whole();
    score_places_left();
    score_places_taken();
    if (!fault_.empty()) return tl::unexpected(fault_);
    return score_;
  }

 private:
  [[nodiscard]] VoxelSet voxels_of(const std::vector<Eigen::Vector3d>& centers) const {
    std::vector<VoxelKey> keys;
    for (const Eigen::Vector3d& center : centers) keys.push_back(voxel_of(center, input_.voxel_m));
    return make_voxel_set(std::move(keys));
  }

  /// Of each voxel; none of any where a recording cannot be read.
  Views views_of(const VoxelSet& voxels, const Visit& visit) {
    std::vector<Eigen::Vector3d> centers;
    for (const VoxelKey key : voxels)
      centers.emplace_back((unpack(key).cast<double>().array() + 0.5) * input_.voxel_m);
    auto views = look_at(centers, visit.recording, {input_.every, input_.voxel_m});
    if (views) return std::move(*views);
    fault_ = views.error();
    return Views(voxels.size());
  }

  void score_whole() {
    const auto of_truth = views_of(truth_, input_.visit);
    const auto of_map = views_of(map_, input_.visit);
    VoxelSet shown;
    for (std::size_t i = 0; i < truth_.size(); ++i)
      if (is_on_surface(of_truth[i])) shown.push_back(truth_[i]);
    VoxelSet judged;
    for (std::size_t i = 0; i < map_.size(); ++i)
      if (is_on_surface(of_map[i]) || is_seen_through(of_map[i])) judged.push_back(map_[i]);
    score_.recall = share_near(shown, map_, 1);
    score_.precision = share_near(judged, truth_, kMapMargin);
  }

  void score_places_left() {
    const VoxelSet gone = away_from(truth_, before_, kMapMargin);
    std::vector<bool> was_seen(gone.size());
    for (const Visit& before : input_.earlier) {
      const auto views = views_of(gone, before);
      for (std::size_t i = 0; i < gone.size(); ++i) was_seen[i] = was_seen[i] || is_on_surface(views[i]);
    }
    const auto now = views_of(gone, input_.visit);
    for (const auto& piece : connected_parts(gone, kSmallestPiece)) {
      const VoxelSet seen =
          chosen(gone, piece, [&](std::size_t i) { return was_seen[i] && is_seen_through(now[i]); });
      if (seen.size() < kSmallestPiece) continue;
      ++score_.moved_from;
      if (share_near(seen, map_, 0) <= kMostLeft) ++score_.moved_from_free;
    }
  }

  void score_places_taken() {
    const auto now = views_of(new_, input_.visit);
    for (const auto& piece : connected_parts(new_, kSmallestPiece)) {
      const VoxelSet seen = chosen(new_, piece, [&](std::size_t i) { return is_on_surface(now[i]); });
      if (seen.size() < kSmallestPiece) continue;
      ++score_.moved_to;
      if (share_near(seen, map_, 1) >= kLeastThere) ++score_.moved_to_mapped;
    }
  }

  const VisitScoreInput& input_;
  VoxelSet map_;
  VoxelSet truth_;   // of the visit
  VoxelSet before_;  // of all earlier ones
  VoxelSet new_;     // of the visit, where some earlier one had nothing
  VisitScore score_;
  std::string fault_;
};

}  // namespace

tl::expected<VisitScore, std::string> score_visit(const VisitScoreInput& input) {
  return VisitScorer(input).score();
}

}  // namespace rds::evaluation
