// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace rds::bus {

/// A domain: the user's choice, or one that no other DomainLock on this machine has, held until destruction.
class DomainLock {
 public:
  /// @throws std::runtime_error if all are taken.
  explicit DomainLock(std::optional<int> chosen = {});
  ~DomainLock();
  DomainLock(const DomainLock&) = delete;
  DomainLock& operator=(const DomainLock&) = delete;

  [[nodiscard]] int domain() const { return domain_; }

 private:
  int domain_ = -1;
  int fd_ = -1;
};

}  // namespace rds::bus
