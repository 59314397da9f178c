// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/spill_file.hpp"

namespace rds::mapper {
namespace {
constexpr const char* kKeyframe = "keyframe";
}

bool SpillFile::put(std::uint64_t id, std::span<const std::uint8_t> bytes) {
  if (!file_) {
    auto opened = store::Store::nameless(folder_);
    if (!opened) return false;
    file_ = std::move(*opened);
  }
  store::Batch batch;
  batch.put(kKeyframe, id, {bytes.begin(), bytes.end()});
  return file_->apply(batch).has_value();
}

std::optional<map_file::Bytes> SpillFile::get(std::uint64_t id) {
  if (!file_) return std::nullopt;
  auto bytes = file_->get(kKeyframe, id);
  return bytes ? std::move(*bytes) : std::nullopt;
}

void SpillFile::erase(std::uint64_t id) {
  if (!file_) return;
  store::Batch batch;
  batch.erase(kKeyframe, id);
  (void)file_->apply(batch);  // where that fails its space is not used again
}

}  // namespace rds::mapper
