// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/spill_file.hpp"

namespace rds::mapper {
namespace {
const std::string kKeyframe = "keyframe";
}

bool SpillFile::put(std::uint64_t id, std::span<const std::uint8_t> bytes) {
  return file_.put(kKeyframe, id, bytes);
}

std::optional<map_file::Bytes> SpillFile::get(std::uint64_t id) {
  return file_.get(kKeyframe, id);
}

void SpillFile::erase(std::uint64_t id) {
  file_.erase(kKeyframe, id);
}

}  // namespace rds::mapper
