// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/byte_reader.hpp"

#include <fmt/format.h>

namespace rds::map_file {

std::span<const std::uint8_t> ByteReader::get_bytes(std::size_t count) {
  if (count > left()) refuse(fmt::format("{} bytes expected where {} are left", count, left()));
  if (!ok()) return {};
  at_ += count;
  return bytes_.subspan(at_ - count, count);
}

std::size_t ByteReader::get_count(std::size_t bytes_each) {
  const auto count = get<std::uint64_t>();
  if (count <= left() / std::max<std::size_t>(bytes_each, 1)) return static_cast<std::size_t>(count);
  refuse(fmt::format("a list of {} elements where {} bytes are left", count, left()));
  return 0;
}

std::string ByteReader::get_text() {
  const auto characters = get_bytes(get_count(1));
  return {characters.begin(), characters.end()};
}

void ByteReader::refuse(const std::string& fault) {
  if (ok()) fault_ = fmt::format("{} (before byte {})", fault, at_);
  at_ = bytes_.size();
}

tl::expected<void, std::string> ByteReader::finish() {
  if (left() > 0) refuse(fmt::format("{} bytes too many", left()));
  if (!ok()) return tl::unexpected(fault_);
  return {};
}

}  // namespace rds::map_file
