// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "services/viewer/core/frames/frame.hpp"

namespace rds::viewer::test {

/// Reads values of a frame one after the other, as FRAMES.md lays them out.
class FrameReader {
 public:
  explicit FrameReader(const Bytes& frame) : frame_(frame) {}

  template <class T>
  T get() {
    T value{};
    EXPECT_LE(at_ + sizeof(T), frame_.size());
    if (at_ + sizeof(T) <= frame_.size()) std::memcpy(&value, frame_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  /// Reads the header. @return the kind.
  Kind kind() {
    EXPECT_EQ(get<char>(), 'R');
    EXPECT_EQ(get<char>(), 'V');
    EXPECT_EQ(get<std::uint8_t>(), kFrameVersion);
    const auto kind = static_cast<Kind>(get<std::uint8_t>());
    EXPECT_EQ(get<std::uint32_t>(), 0U);
    return kind;
  }
  [[nodiscard]] std::string rest() const {
    return {frame_.begin() + static_cast<std::ptrdiff_t>(at_), frame_.end()};
  }
  [[nodiscard]] bool at_end() const { return at_ == frame_.size(); }

 private:
  const Bytes& frame_;
  std::size_t at_ = 0;
};

/// A page's copy of the map: chunks as they were last sent.
struct PageMap {
  using Key = std::array<std::uint16_t, 3>;
  struct Voxel {
    std::array<std::uint8_t, 4> color_and_certainty{};
    std::uint16_t label = 0;
    bool operator==(const Voxel&) const = default;
  };

  std::uint64_t generation = 0;
  std::uint64_t revision = 0;
  double resolution = 0;
  bool complete = false;
  std::map<Key, std::map<Key, Voxel>> chunks;  // voxels by their own keys

  void apply(const Bytes& frame) {
    FrameReader in(frame);
    EXPECT_EQ(in.kind(), Kind::kMap);
    const auto told = in.get<std::uint64_t>();
    if (told != generation) chunks.clear();
    generation = told;
    resolution = in.get<double>();
    revision = in.get<std::uint64_t>();
    const auto count = in.get<std::uint32_t>();
    complete = in.get<std::uint32_t>() != 0;
    for (std::uint32_t i = 0; i < count; ++i) apply_chunk(in);
    EXPECT_TRUE(in.at_end());
  }
  [[nodiscard]] std::map<Key, Voxel> voxels() const {
    std::map<Key, Voxel> all;
    for (const auto& [chunk, voxels] : chunks) all.insert(voxels.begin(), voxels.end());
    return all;
  }

 private:
  void apply_chunk(FrameReader& in) {
    Key chunk{};
    for (auto& axis : chunk) axis = in.get<std::uint16_t>();
    in.get<std::uint16_t>();
    const auto count = in.get<std::uint32_t>();
    in.get<std::uint32_t>();
    auto& voxels = chunks[chunk];
    voxels.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto place = in.get<std::uint16_t>();
      Key key{};
      for (unsigned axis = 0; axis < 3; ++axis)
        key[axis] = static_cast<std::uint16_t>(chunk[axis] * 32 + (place >> (5 * axis) & 31));
      Voxel voxel;
      for (auto& channel : voxel.color_and_certainty) channel = in.get<std::uint8_t>();
      voxel.label = in.get<std::uint16_t>();
      EXPECT_TRUE(voxels.emplace(key, voxel).second) << "a voxel twice";
    }
  }
};

}  // namespace rds::viewer::test
