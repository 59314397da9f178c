// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/mapper_checkpoints.hpp"

#include "common/map_file/geometry_bytes.hpp"

namespace rds::mapper {
namespace {

constexpr const char* kRecord = "record";
constexpr const char* kArrival = "arrival";
constexpr const char* kKeyframes = "keyframes";
constexpr const char* kState = "state";
constexpr const char* kFinal = "final";
constexpr std::size_t kMaxWaitingBytes = 64'000'000;  // while the disk is full

store::Bytes to_bytes(const IntegratedKeyframe& keyframe) {
  map_file::ByteWriter writer;
  map_file::put(writer, keyframe.camera_from_map);
  map_file::put(writer, keyframe.camera);
  writer.put(keyframe.stamp_ns);
  return writer.take();
}

tl::expected<IntegratedKeyframe, std::string> integrated_from(std::uint64_t id,
                                                              std::span<const std::uint8_t> bytes) {
  map_file::ByteReader reader(bytes);
  IntegratedKeyframe keyframe;
  keyframe.id = id;
  keyframe.camera_from_map = map_file::get_pose(reader);
  keyframe.camera = map_file::get_camera(reader);
  keyframe.stamp_ns = reader.get<std::int64_t>();
  if (auto read = reader.finish(); !read) return tl::unexpected(read.error());
  return keyframe;
}

}  // namespace

/// Records as rows of the checkpoint.
class CheckpointedRecords : public SpillStorage {
 public:
  explicit CheckpointedRecords(MapperCheckpoints& map) : map_(map) {}

  bool put(std::uint64_t id, std::span<const std::uint8_t> bytes) override {
    if (map_.changes_.bytes() + bytes.size() > kMaxWaitingBytes) return false;
    map_.changes_.put(kRecord, id, {bytes.begin(), bytes.end()});
    return true;
  }
  std::optional<map_file::Bytes> get(std::uint64_t id) override {
    if (const auto* row = map_.changes_.find({kRecord, id})) return *row;
    return map_.writer_->get(kRecord, id);
  }
  void erase(std::uint64_t id) override {
    map_.changes_.erase(kRecord, id);
    map_.changes_.erase(kArrival, id);
  }
  void clear() override {
    map_.changes_.clear();
    map_.blocks_.clear();
  }

 private:
  MapperCheckpoints& map_;
};

MapperCheckpoints::MapperCheckpoints(std::unique_ptr<store::CheckpointWriter> writer, double period_s)
    : writer_(std::move(writer)), schedule_(period_s) {}

std::unique_ptr<SpillStorage> MapperCheckpoints::storage() {
  return writer_ ? std::make_unique<CheckpointedRecords>(*this) : nullptr;
}

void MapperCheckpoints::add(const IntegratedKeyframe& keyframe) {
  schedule_.note_keyframe();
  if (writer_) changes_.put(kArrival, keyframe.id, to_bytes(keyframe));
}

void MapperCheckpoints::save(SemanticMapper& mapper, bool now) {
  if (!writer_ || (!now && !schedule_.is_due())) return;
  schedule_.restart();
  const auto checkpoint = mapper.checkpoint();
  if (!checkpoint) return writer_->try_again();
  std::set<std::uint64_t> blocks;
  for (const auto& [block, bytes] : checkpoint->keyframes) {
    changes_.put(kKeyframes, block, bytes);
    blocks.insert(block);
    blocks_.erase(block);
  }
  for (const std::uint64_t block : blocks_) changes_.erase(kKeyframes, block);
  blocks_ = std::move(blocks);
  changes_.put(kState, 0, checkpoint->state);
  if (checkpoint->final_map) changes_.put(kFinal, 0, *checkpoint->final_map);
  (void)writer_->write(changes_);  // where too much waits these wait here for the next time
}

tl::expected<std::vector<IntegratedKeyframe>, std::string> MapperCheckpoints::restore(
    SemanticMapper& mapper) {
  std::vector<IntegratedKeyframe> keyframes;
  const auto state = writer_ ? writer_->get(kState, 0) : std::nullopt;
  if (!state) return keyframes;
  MapCheckpoint checkpoint{*state, {}, writer_->get(kFinal, 0)};
  std::string fault;
  auto read = writer_->for_each(kKeyframes, [&](std::uint64_t block, std::span<const std::uint8_t> bytes) {
    checkpoint.keyframes[block] = {bytes.begin(), bytes.end()};
    blocks_.insert(block);
  });
  if (read)
    read = writer_->for_each(kArrival, [&](std::uint64_t id, std::span<const std::uint8_t> bytes) {
      auto keyframe = integrated_from(id, bytes);
      if (keyframe)
        keyframes.push_back(std::move(*keyframe));
      else
        fault = keyframe.error();
    });
  if (!read) return tl::unexpected(read.error());
  if (!fault.empty()) return tl::unexpected(fault);
  if (const auto restored = mapper.restore(checkpoint); !restored) return tl::unexpected(restored.error());
  return keyframes;
}

}  // namespace rds::mapper
