// SPDX-License-Identifier: Apache-2.0
#include "common/bus/domain_lock.hpp"

#include <filesystem>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

namespace rds::bus {
namespace {
// People use low domains by hand; above 101 the ports collide with Linux's ephemeral ones (7400 + 250 ×
// domain).
constexpr int kFirst = 30;
constexpr int kLast = 100;
}  // namespace

DomainLock::DomainLock(std::optional<int> chosen) : domain_(chosen.value_or(-1)) {
  if (chosen) return;
  const auto folder = std::filesystem::temp_directory_path();
  for (int domain = kFirst; domain <= kLast; ++domain) {
    const auto path = folder / fmt::format("rds-slam-domain-{}.lock", domain);
    fd_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (fd_ < 0) continue;
    if (flock(fd_, LOCK_EX | LOCK_NB) == 0) {
      domain_ = domain;
      return;
    }
    close(fd_);
  }
  throw std::runtime_error(fmt::format("all DDS domains {} to {} are in use by other runs", kFirst, kLast));
}

DomainLock::~DomainLock() {
  if (fd_ >= 0) close(fd_);
}

}  // namespace rds::bus
