// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/byte_writer.hpp"
#include "services/mapper/core/objects/map_object.hpp"
#include "services/mapper/core/objects/object_view.hpp"
#include "services/mapper/core/octree/label_table.hpp"

namespace rds::mapper {

/// The objects of the map: sightings of the same label near each other are one object, fused with their
/// weights, and so are sightings of one place, whatever their labels. All of them together say which label it
/// bears.
///
/// Each object carries log-odds of existence: sightings raise them, being in view without being detected
/// lowers them a little, being seen through lowers them much; at 0 an object that was seen through has gone,
/// any other is forgotten. One that has gone is kept, and comes back with a sighting near its place. Movable
/// objects never enter. Source: paper §IV-C "Update 3D Object Database". Deviation: observation-weighted
/// fusion and fading instead of half-and-half averaging without end; a distribution over labels.
///
/// An object is the sightings that were fused into it. So a database that is made again, from other poses or
/// without some keyframes, takes over the ids of the one before it.
class ObjectDatabase {
 public:
  explicit ObjectDatabase(const ObjectConfig& config) : config_(config) {}

  /// Fuses a keyframe's sightings (of static objects); fades what should have been seen if it looked for
  /// objects.
  void integrate(const ObjectView& view, const LabelTable& labels);

  /// Objects seen often and surely enough, in order of their ids, with those that have gone.
  [[nodiscard]] std::vector<MapObject> objects() const;

  /// From here on ids are given that `other` has not given.
  void reserve_ids_of(const ObjectDatabase& other);
  /// Objects that are new since reserve_ids_of(before) get the id of the object of `before` of which they
  /// have most sightings, of several whole ones the lowest, or else the next one. No two have the same.
  void take_ids_from(const ObjectDatabase& before);

  /// Whether an object stands where it is known to stand.
  using IsThere = std::function<bool(const MapObject& object)>;
  /// Those that do not have gone. @return how many went now.
  std::size_t let_go_unless(const IsThere& is_there);
  /// How what lies at a point of the later map goes to this one.
  using HereFromThere = std::function<geometry::Pose(const Eigen::Vector3d& point)>;
  /// Adds the objects of a map of a later time: one that is there already, by place and label as sightings
  /// are told, keeps its id, with the evidence of both, and has gone if it had gone later; others get the
  /// next ids. Sightings are not taken over.
  /// @return how many were there already.
  std::size_t add_later(const ObjectDatabase& later, const HereFromThere& here_from_there);

  /// All that is known of every object, the one seen once too, but for its sightings.
  void put(map_file::ByteWriter& writer) const;
  /// Starts from such bytes. Refuses what put() cannot have written.
  void get(map_file::ByteReader& reader);
  /// Ids and sightings: all that take_ids_from() asks of the database before.
  void put_identities(map_file::ByteWriter& writer) const;
  void get_identities(map_file::ByteReader& reader);

 private:
  /// One of a keyframe's.
  struct SightingId {
    std::uint64_t keyframe = 0;
    std::uint32_t index = 0;
    auto operator<=>(const SightingId&) const = default;
  };
  struct Entry {
    MapObject object;
    Eigen::Vector3d min = Eigen::Vector3d::Zero();
    Eigen::Vector3d max = Eigen::Vector3d::Zero();
    double weight = 0;
    double score_sum = 0;
    double existence = 0;
    bool seen_now = false;
    LabelDistribution labels;
    std::vector<SightingId> sightings;
  };

  void fuse(const ObjectInPlace& sighting, SightingId id, const ObjectView& view, const std::string& label);
  Entry* object_of(const std::string& label, const geometry::Box3& box);
  [[nodiscard]] bool is_same(const std::string& label, const geometry::Box3& a,
                             const geometry::Box3& b) const;
  void merge_duplicates();
  static void merge(Entry& into, const Entry& other);
  void let_go();
  [[nodiscard]] bool is_reported(const Entry& entry) const;
  static void describe(Entry& entry);
  void fade(Entry& entry, const ObjectView& view) const;

  ObjectConfig config_;
  std::vector<Entry> entries_;
  std::uint64_t next_id_ = 1;
};

}  // namespace rds::mapper
