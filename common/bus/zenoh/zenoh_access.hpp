// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/bus/security.hpp"

namespace rds::bus {

/// Beside governance in the folder of a secured domain (common/bus/security.hpp): what all may do on Zenoh,
/// signed.
inline constexpr const char* kAccessFile = "access.p7s";

}  // namespace rds::bus

namespace rds::bus::detail {

/// Who may write and read what in a secured domain on Zenoh, as `rds secure init` has written and signed it.
/// Every participant and every router holds the others to it, by the common names in their certificates.
class ZenohAccess {
 public:
  /// @throws BusError if the list cannot be read, or was not signed by the domain's authority.
  explicit ZenohAccess(const Credentials& credentials);

  /// Zenoh's own form (`access_control`): what no rule allows is refused, and so is who has no certificate.
  [[nodiscard]] nlohmann::json rules() const;

  /// @throws BusError if this participant may not write, or read, this topic: the others would not let it.
  void check(const std::string& topic, bool publisher) const;

  [[nodiscard]] const Credentials& credentials() const { return credentials_; }

 private:
  /// Topics with '*' for any text.
  struct Role {
    std::vector<std::string> publishes;
    std::vector<std::string> subscribes;
    bool relays = false;
  };
  void read(const std::string& text);

  Credentials credentials_;
  std::map<std::string, Role> roles_;  // by common name
};

}  // namespace rds::bus::detail
