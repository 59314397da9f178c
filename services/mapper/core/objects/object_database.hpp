// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/byte_writer.hpp"
#include "services/mapper/core/objects/map_object.hpp"
#include "services/mapper/core/objects/object_view.hpp"
#include "services/mapper/core/octree/label_table.hpp"

namespace rds::mapper {

/// The objects of the map: sightings of the same class near each other are one object, fused with their
/// weights.
///
/// Each object carries log-odds of existence: sightings raise them, being in view without being detected
/// lowers them a little, being seen through lowers them much; at 0 an object that was seen through has gone,
/// any other is forgotten. One that has gone is kept, and comes back with a sighting near its place. Movable
/// objects never enter. Source: paper §IV-C "Update 3D Object Database". Deviation: observation-weighted
/// fusion and fading instead of half-and-half averaging without end.
class ObjectDatabase {
 public:
  explicit ObjectDatabase(const ObjectConfig& config) : config_(config) {}

  /// Fuses a keyframe's sightings (of static objects); fades what should have been seen if it looked for
  /// objects.
  void integrate(const ObjectView& view, const LabelTable& labels);

  /// Objects seen often and surely enough, in order of their ids, with those that have gone.
  [[nodiscard]] std::vector<MapObject> objects() const;

  /// All that is known of every object, the one seen once too.
  void put(map_file::ByteWriter& writer) const;
  /// Starts from such bytes. Refuses what put() cannot have written.
  void get(map_file::ByteReader& reader);

 private:
  struct Entry {
    MapObject object;
    Eigen::Vector3d min = Eigen::Vector3d::Zero();
    Eigen::Vector3d max = Eigen::Vector3d::Zero();
    double weight = 0;
    double score_sum = 0;
    double existence = 0;
    bool seen_now = false;
  };

  void fuse(const ObjectSighting& sighting, const ObjectView& view, const LabelTable& labels);
  Entry* nearest(const std::string& label, const geometry::Box3& box);
  [[nodiscard]] bool is_same(const std::string& label, const geometry::Box3& a,
                             const geometry::Box3& b) const;
  void merge_duplicates();
  void let_go();
  [[nodiscard]] bool is_reported(const Entry& entry) const;
  static void describe(Entry& entry);
  void fade(Entry& entry, const ObjectView& view) const;

  ObjectConfig config_;
  std::vector<Entry> entries_;
  std::uint64_t next_id_ = 1;
};

/// Boundary of a sighting in the map: per axis, 2nd to 98th percentile of its points.
geometry::Box3 boundary_in_map(const ObjectSighting& sighting, const geometry::Pose& map_from_camera);

/// objects.json: [{id, label, score, center, size, observations, movable, first_seen, last_seen, gone}],
/// metres with 4 decimals, stamps in seconds.
std::string to_json(std::span<const MapObject> objects);

}  // namespace rds::mapper
