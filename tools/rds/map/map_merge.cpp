// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map/map_merge.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "common/map_file/geometry_bytes.hpp"
#include "services/loop_closer/core/map_bytes.hpp"
#include "services/mapper/core/map_merging.hpp"
#include "services/mapper/core/semantic_mapper.hpp"
#include "services/mapper/io/map_files.hpp"

namespace rds::tools {
namespace fs = std::filesystem;
namespace {

using map_file::Sections;
template <class T>
using Result = tl::expected<T, std::string>;

/// A saved map as its file holds it.
struct Source {
  fs::path path;
  Sections sections;

  [[nodiscard]] const map_file::Bytes& bytes(const std::string& section) const {
    return sections.at(section);
  }
  [[nodiscard]] tl::unexpected<std::string> damaged(const std::string& fault) const {
    return tl::unexpected(fmt::format("{}: is damaged: {}", path.string(), fault));
  }
};

Result<Source> read(const fs::path& path) {
  auto sections =
      map_file::read_saved_map(path, {map_file::kKeyframePoses, map_file::kTracker, map_file::kMapper});
  if (!sections) return tl::unexpected(sections.error());
  return Source{path, std::move(*sections)};
}

Result<tracker::SavedMap> tracked_map(const Source& source, const tracker::ExtractionConfig& extraction) {
  const auto poses = map_file::keyframe_poses_from_bytes(source.bytes(map_file::kKeyframePoses));
  if (!poses) return source.damaged(poses.error());
  auto map = tracker::map_from_bytes(source.bytes(map_file::kTracker), *poses, extraction);
  if (!map) return tl::unexpected(fmt::format("{}: cannot be merged: {}", source.path.string(), map.error()));
  return map;
}

Result<mapper::SavedMap> semantic_map(const Source& source, const mapper::MapperConfig& config) {
  auto map = mapper::saved_map_from(source.bytes(map_file::kMapper), config);
  if (!map) return tl::unexpected(fmt::format("{}: cannot be merged: {}", source.path.string(), map.error()));
  return map;
}

tl::unexpected<std::string> not_merged(const Source& earlier, const Source& later, const std::string& why) {
  return tl::unexpected(
      fmt::format("{} cannot be merged into {}: {}", later.path.string(), earlier.path.string(), why));
}

std::vector<geometry::StampedPose> by_stamp(const std::vector<geometry::KeyframePose>& poses) {
  std::vector<geometry::StampedPose> stamped;
  for (const auto& pose : poses) stamped.push_back({pose.stamp_ns, pose.map_from_camera, {}});
  std::ranges::stable_sort(stamped, {}, &geometry::StampedPose::stamp_ns);
  return stamped;
}

/// The tracker's part.
Result<tracker::MergedMap> merge_tracked(const Source& earlier, const Source& later, MapMerge& merge) {
  const auto extraction = tracker::pyramid_of(earlier.bytes(map_file::kTracker));
  if (!extraction) return earlier.damaged(extraction.error());
  const auto first = tracked_map(earlier, *extraction);
  if (!first) return tl::unexpected(first.error());
  const auto second = tracked_map(later, *extraction);
  if (!second) return tl::unexpected(second.error());
  auto merged = tracker::merge_maps(*first, *second);
  if (!merged) return not_merged(earlier, later, merged.error());
  const auto poses = tracker::keyframe_poses(merged->saved.map);
  merge.sections[map_file::kKeyframePoses] = map_file::to_bytes(poses);
  merge.sections[map_file::kTracker] =
      tracker::to_bytes(merged->saved.map, merged->saved.camera, *extraction);
  merge.keyframes = by_stamp(poses);
  merge.report.joint = merged->joint;
  merge.report.keyframes = poses.size();
  merge.report.points = merged->saved.map.points().size();
  return merged;
}

/// The mapper's part, and what it makes for others.
Result<void> merge_semantic(const Source& earlier, const Source& later,
                            std::span<const geometry::PoseChange> moved, MapMerge& merge) {
  mapper::MapperConfig config;
  const auto voxel_m = mapper::voxel_size_of(earlier.bytes(map_file::kMapper));
  if (!voxel_m) return earlier.damaged(voxel_m.error());
  config.octree.resolution_m = *voxel_m;
  const auto first = semantic_map(earlier, config);
  if (!first) return tl::unexpected(first.error());
  const auto second = semantic_map(later, config);
  if (!second) return tl::unexpected(second.error());
  auto merged = mapper::merge_maps(*first, *second, moved, config);
  mapper::SemanticMapper whole(config);
  whole.start_from(std::move(merged.saved));
  const Eigen::Vector3d up = whole.up_in_map();
  const mapper::SemanticMap& map = whole.map();
  const auto objects = map.objects(up);
  merge.sections[map_file::kMapper] = mapper::to_bytes(map, up);
  merge.files = mapper::files_for_others(map.tree(), objects, mapper::make_grid(map.tree(), up, config.grid));
  merge.report.voxels = merged.voxels;
  merge.report.objects = objects.size();
  merge.report.common_objects = merged.common_objects;
  merge.report.gone_objects = merged.gone_objects;
  return {};
}

/// The loop closer's part; of a map that lacks it, nothing.
Result<void> merge_loop_closer(const Source& earlier, const Source& later, std::uint64_t first_of_later,
                               MapMerge& merge) {
  static const map_file::Bytes kNoKeyframes(sizeof(std::uint64_t));
  const auto part_of = [&](const Source& source) -> const map_file::Bytes& {
    const auto part = source.sections.find(map_file::kLoopCloser);
    if (part != source.sections.end()) return part->second;
    merge.report.without_loop_closer.push_back(source.path.string());
    return kNoKeyframes;
  };
  const map_file::Bytes& first = part_of(earlier);
  const map_file::Bytes& second = part_of(later);
  if (merge.report.without_loop_closer.size() == 2) return {};
  auto merged = loop_closer::merge_maps(first, second, first_of_later);
  if (!merged) return not_merged(earlier, later, merged.error());
  merge.sections[map_file::kLoopCloser] = std::move(*merged);
  return {};
}

}  // namespace

Result<MapMerge> merge_saved_maps(const fs::path& earlier_path, const fs::path& later_path) {
  const auto earlier = read(earlier_path);
  if (!earlier) return tl::unexpected(earlier.error());
  const auto later = read(later_path);
  if (!later) return tl::unexpected(later.error());
  MapMerge merge;
  merge.report.earlier = earlier_path.string();
  merge.report.later = later_path.string();
  const auto tracked = merge_tracked(*earlier, *later, merge);
  if (!tracked) return tl::unexpected(tracked.error());
  if (auto merged = merge_loop_closer(*earlier, *later, tracked->first_of_later, merge); !merged)
    return tl::unexpected(merged.error());
  if (auto merged = merge_semantic(*earlier, *later, tracked->moved, merge); !merged)
    return tl::unexpected(merged.error());
  return merge;
}

}  // namespace rds::tools
