// SPDX-License-Identifier: Apache-2.0
#include "common/store/scratch_file.hpp"

namespace rds::store {

bool ScratchFile::put(const std::string& kind, std::uint64_t id, std::span<const std::uint8_t> bytes) {
  if (!file_) {
    auto opened = Store::nameless(folder_);
    if (!opened) return false;
    file_ = std::move(*opened);
  }
  Batch batch;
  batch.put(kind, id, {bytes.begin(), bytes.end()});
  return file_->apply(batch).has_value();
}

std::optional<Bytes> ScratchFile::get(const std::string& kind, std::uint64_t id) const {
  if (!file_) return std::nullopt;
  auto bytes = file_->get(kind, id);
  return bytes ? std::move(*bytes) : std::nullopt;
}

void ScratchFile::erase(const std::string& kind, std::uint64_t id) {
  if (!file_) return;
  Batch batch;
  batch.erase(kind, id);
  (void)file_->apply(batch);  // where that fails its space is not used again
}

}  // namespace rds::store
