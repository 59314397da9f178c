// SPDX-License-Identifier: Apache-2.0
// Spoiled deltas, maps and files: no reader crashes, none takes more memory than it declares.
#include <algorithm>

#include <gmock/gmock.h>

#include "common/bus/type_ops.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "common/map_file/map_file.hpp"
#include "octomap_msgs/msg/Octomap.h"
#include "rds_msgs/msg/MapInfo.h"
#include "rds_msgs/msg/OctreeDelta.h"
#include "services/mapper/core/octree/octree_replica.hpp"
#include "services/mapper/io/map_files.hpp"
#include "services/mapper/io/octomap_file.hpp"
#include "services/mapper/map_messages.hpp"
#include "tests/fuzz/feed.hpp"
#include "tests/unit/services/mapper/core/random_keyframes.hpp"

namespace rds::fuzz {
namespace {

using mapper::MapDelta;
using mapper::OctreeReplica;
using Octomap = octomap_msgs::msg::Octomap;
using OctreeDelta = rds_msgs::msg::OctreeDelta;

constexpr std::size_t kMemoryOfSmallThings = 64 * 1024;  // messages, sentences, tables
constexpr std::size_t kTwoEmptyTrees = 1'280'000;        // OctoMap reserves 0.6 MB for rays in each
/// What good bytes are made of: small maps with a few keyframes.
struct Examples {
  Examples() {
    mapper::MapperConfig config;
    config.octree.resolution_m = 0.5;
    mapper::SemanticMapper mapper(config, 1);
    mapper::test::RandomKeyframes keyframes(3);
    for (int i = 0; i < 4; ++i) {
      deltas.push_back(mapper.integrate(keyframes.next()));
      maps.push_back(mapper::test::saved_bytes(mapper));
      snapshots.push_back(mapper::take_snapshot(mapper));
      trees.push_back(mapper::to_bytes(mapper.map().tree()));
      binary_trees.push_back(mapper::to_binary_bytes(mapper.map().tree()));
      poses.push_back(map_file::to_bytes(mapper.archive().poses()));
    }
    deltas.push_back(mapper.settle(std::vector<mapper::KeyframePose>{{1, 0, keyframes.pose()}}));
  }
  std::vector<MapDelta> deltas;
  std::vector<mapper::MapSnapshot> snapshots;
  std::vector<Bytes> maps;
  std::vector<Bytes> trees;
  std::vector<Bytes> binary_trees;
  std::vector<Bytes> poses;
};

const Examples& examples() {
  static const Examples kExamples;
  return kExamples;
}

template <class Message>
Bytes encoded(const Message& message) {
  const bus::TypeOps& type = bus::type_ops<Message>();
  Bytes bytes(type.encoded_size(&message));
  bytes.resize(type.encode(&message, bytes.data(), bytes.size()));
  return bytes;
}

template <class Message>
bool decode(const Bytes& bytes, Message& message) {
  return bus::type_ops<Message>().decode(bytes.data(), bytes.size(), &message);
}

std::size_t expanded(std::uint64_t voxels_per_byte, std::size_t bytes) {
  return kTwoEmptyTrees + kMemoryOfSmallThings +
         mapper::kBytesPerVoxel * (mapper::kFreeVoxels + voxels_per_byte * bytes);
}

MapDelta to_delta(const OctreeDelta& m) {
  return {m.map_epoch(),  m.map_id(), m.base_revision(), m.revision(), m.keyframe_id(), 0,
          m.resolution(), m.keys(),   m.log_odds(),      m.labels(),   m.colors(),      m.deleted_keys()};
}

/// A voxel of a delta takes a chain of nodes down to it, a label, and all that again when others are deleted.
std::size_t bound_of_delta(std::size_t bytes) {
  return kTwoEmptyTrees + kMemoryOfSmallThings + 256 * bytes;
}

TEST(MapReaders, DeltasFromTheWire) {
  std::vector<Bytes> seeds;
  for (MapDelta delta : examples().deltas) {
    delta.base_revision = 0;  // each begins a map
    seeds.push_back(encoded(mapper::to_message(delta)));
  }
  feed(25, seeds, bound_of_delta, [](const Bytes& bytes) {
    OctreeDelta message;
    OctreeReplica replica;
    return decode(bytes, message) &&
           replica.apply(to_delta(message)).status == mapper::ReplicaStatus::kApplied;
  });
}

TEST(MapReaders, DeltasToAReplicaThatLives) {
  std::vector<Bytes> seeds;
  for (const MapDelta& delta : examples().deltas) seeds.push_back(encoded(mapper::to_message(delta)));
  OctreeReplica replica;
  std::size_t next = 0;
  feed(
      20, seeds, [](std::size_t) { return std::size_t{64} << 20; },
      [&](const Bytes& bytes) {
        if (!replica.is_valid() || replica.tree().size() > 20'000) replica = OctreeReplica();
        if (next == examples().deltas.size()) {
          next = 0;
          replica = OctreeReplica();
        }
        const std::uint64_t revision = replica.revision();
        OctreeDelta message;
        if (!decode(bytes, message)) return false;
        const auto status = replica.apply(to_delta(message)).status;
        EXPECT_TRUE(status == mapper::ReplicaStatus::kApplied || replica.revision() == revision);
        if (status != mapper::ReplicaStatus::kApplied)  // goes on with the next good one, if it still fits
          replica.apply(examples().deltas[next++]);
        return status == mapper::ReplicaStatus::kApplied || status == mapper::ReplicaStatus::kGap ||
               status == mapper::ReplicaStatus::kOld;
      });
}

TEST(MapReaders, FullMapsFromTheWire) {
  std::vector<Bytes> seeds;
  for (const auto& snapshot : examples().snapshots)
    seeds.push_back(encoded(mapper::full_message(snapshot, 1)));
  const std::vector<std::string> labels{"", "person", "chair"};
  feed(
      15, seeds, [](std::size_t bytes) { return expanded(mapper::kVoxelsPerByte + 8, bytes); },
      [&](const Bytes& bytes) {
        Octomap message;
        OctreeReplica replica;
        if (!decode(bytes, message)) return false;
        const auto* data = reinterpret_cast<const std::uint8_t*>(message.data().data());
        return replica
                   .apply(
                       mapper::FullMap{{data, message.data().size()}, message.resolution(), 1, 1, 1, labels})
                   .status == mapper::ReplicaStatus::kApplied;
      });
}

TEST(MapReaders, MapInfoFromTheWire) {
  rds_msgs::msg::MapInfo info;
  info.labels({"", "chair", "person"});
  info.label_keys({1, 2, 3});
  info.label_values({1});
  feed(5, {encoded(info)}, bound_of_delta, [](const Bytes& bytes) {
    rds_msgs::msg::MapInfo message;
    return decode(bytes, message);
  });
}

TEST(MapReaders, OctomapFiles) {
  const auto file = [](const std::string& header, const Bytes& nodes) {
    Bytes bytes(header.begin(), header.end());
    bytes.insert(bytes.end(), nodes.begin(), nodes.end());
    return bytes;
  };
  std::vector<Bytes> full;
  for (const Bytes& tree : examples().trees)
    full.push_back(file("# Octomap OcTree file\nid ColorOcTree\nsize 1\nres 0.5\ndata\n", tree));
  std::vector<Bytes> binary;
  for (const Bytes& tree : examples().binary_trees)
    binary.push_back(file("# Octomap OcTree binary file\nid OcTree\nsize 1\nres 0.5\ndata\n", tree));
  const auto read = [](const Bytes& bytes) { return mapper::tree_from_octomap_file(bytes).has_value(); };
  feed(
      6, full, [](std::size_t bytes) { return expanded(mapper::kVoxelsPerByte, bytes); }, read);
  feed(
      4, binary, [](std::size_t bytes) { return expanded(mapper::kVoxelsPerBinaryByte, bytes); }, read);
}

TEST(MapReaders, SavedMapFiles) {
  std::vector<Bytes> seeds;
  for (std::size_t i = 0; i < examples().maps.size(); ++i)
    seeds.push_back(map_file::to_bytes(
        map_file::Sections{{"keyframe_poses", examples().poses[i]}, {"mapper", examples().maps[i]}}));
  feed(
      8, seeds, [](std::size_t bytes) { return kMemoryOfSmallThings + 4 * bytes; },
      [&](const Bytes& bytes) {
        const bool is_accepted = map_file::sections_from_bytes(bytes).has_value();
        EXPECT_TRUE(!is_accepted || std::ranges::find(seeds, bytes) != seeds.end()) << "a byte was changed";
        return is_accepted;
      });
}

TEST(MapReaders, SectionOfTheMapper) {
  mapper::MapperConfig config;
  config.octree.resolution_m = 0.5;
  // Beside the tree's node a voxel has a look in its block of evidence, and a look and counts in the final
  // part that the block begins with; blocks and looks lie in a pool, whose pieces are larger than they ask for.
  constexpr std::uint64_t kEvidenceOfVoxel = 104;
  constexpr std::uint64_t kPerByte = mapper::kVoxelsPerByte + 8;
  const auto bound = [](std::size_t bytes) {
    return expanded(kPerByte, bytes) + kEvidenceOfVoxel * (mapper::kFreeVoxels + kPerByte * bytes);
  };
  feed(10, examples().maps, bound, [&](const Bytes& bytes) {
    mapper::SemanticMapper mapper(config);
    const bool is_whole = mapper::test::start_from(mapper, bytes, config).has_value();
    const bool is_tree = mapper::tree_from_map_bytes(bytes).has_value();
    EXPECT_TRUE(is_tree || !is_whole);
    return is_whole;
  });
}

TEST(MapReaders, SectionOfKeyframePoses) {
  feed(
      7, examples().poses, [](std::size_t bytes) { return kMemoryOfSmallThings + 4 * bytes; },
      [](const Bytes& bytes) { return map_file::keyframe_poses_from_bytes(bytes).has_value(); });
}

}  // namespace
}  // namespace rds::fuzz
