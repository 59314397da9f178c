// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rds::run {

/// A DDS domain that no other `rds run` on this machine uses, held until destruction.
class DomainLock {
 public:
  /// @throws std::runtime_error if all are taken.
  DomainLock();
  ~DomainLock();
  DomainLock(const DomainLock&) = delete;
  DomainLock& operator=(const DomainLock&) = delete;

  [[nodiscard]] int domain() const { return domain_; }

 private:
  int domain_ = -1;
  int fd_ = -1;
};

}  // namespace rds::run
