// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace rds::detector {

/// SHA-256 of the bytes as 64 hexadecimal digits in lower case.
std::string sha256_hex(std::span<const unsigned char> bytes);

}  // namespace rds::detector
