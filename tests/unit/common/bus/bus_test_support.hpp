// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "common/bus/participant.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/test_domain.hpp"

namespace rds::bus {

using test::kAllVendors;
using test::test_domain;

inline std::unique_ptr<Participant> join(Vendor vendor, const std::string& node_name,
                                         int domain = test_domain()) {
  return Participant::create(
      {.vendor = vendor, .domain = domain, .node_name = node_name, .loopback_only = true});
}

/// Polls because discovery has no event in the API; the deadline only bounds a failing test.
template <class Condition>
bool eventually(Condition condition, std::chrono::seconds deadline = std::chrono::seconds(20)) {
  const auto end = std::chrono::steady_clock::now() + deadline;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

/// Collects what a subscription delivers.
template <class T>
class Inbox {
 public:
  std::function<void(std::shared_ptr<const T>)> callback() {
    return [this](std::shared_ptr<const T> message) {
      const std::lock_guard lock(mutex_);
      messages_.push_back(std::move(message));
    };
  }
  std::vector<std::shared_ptr<const T>> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }
  std::size_t size() const { return messages().size(); }

 private:
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<const T>> messages_;
};

struct VendorPair {
  Vendor writer;
  Vendor reader;
};

inline std::string name_of(const VendorPair& pair) {
  return name_of(pair.writer) + "_to_" + name_of(pair.reader);
}

inline const VendorPair kAllPairs[] = {
    {Vendor::kFastDds, Vendor::kFastDds},    {Vendor::kFastDds, Vendor::kCycloneDds},
    {Vendor::kCycloneDds, Vendor::kFastDds}, {Vendor::kCycloneDds, Vendor::kCycloneDds},
#if RDS_HAS_ZENOH
    {Vendor::kZenoh, Vendor::kZenoh},
#endif
};

}  // namespace rds::bus
