// SPDX-License-Identifier: Apache-2.0
#include "services/detector/models/file_digest.hpp"

#include <array>

#include <fmt/format.h>
#include <openssl/sha.h>

namespace rds::detector {

std::string sha256_hex(std::span<const unsigned char> bytes) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(bytes.data(), bytes.size(), digest.data());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace rds::detector
