// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "common/bus/participant.hpp"

namespace rds::bus::detail {

/// An endpoint's or participant's RTPS GUID: 12 bytes of the participant, 4 of the entity.
using Guid = std::array<std::uint8_t, 16>;

/// True if both GUIDs belong to one participant.
inline bool same_participant(const Guid& a, const Guid& b) {
  return std::equal(a.begin(), a.begin() + 12, b.begin());
}

inline ParticipantId participant_of(const Guid& guid) {
  ParticipantId id{};
  std::copy_n(guid.begin(), id.size(), id.begin());
  return id;
}

/// As `ros2 topic info --verbose` writes it: "01.0f.…", 16 bytes in hexadecimal.
inline std::string text_of(const Guid& guid) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : guid) {
    if (!text.empty()) text += '.';
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

}  // namespace rds::bus::detail
