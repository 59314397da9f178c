// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/backend.hpp"
#include "common/bus/type_version.hpp"

namespace rds::bus::detail {

/// The endpoints that other participants announce, by the key with which a vendor's samples name their
/// writer. Filled by the vendor's discovery before it hands out the first sample of a writer. Thread-safe.
template <class Key>
class EndpointDirectory {
 public:
  /// Writers that have left stay known by their last kRemembered, as samples of theirs may wait to be taken.
  static constexpr std::size_t kRemembered = 256;

  void put(const Key& key, DiscoveredEndpoint endpoint, const Guid& guid) {
    const std::lock_guard lock(mutex_);
    present_[key] = {std::move(endpoint), guid};
    ++revision_;
  }

  void remove(const Key& key) {
    const std::lock_guard lock(mutex_);
    if (const auto entry = present_.find(key); entry != present_.end()) leave(entry);
    ++revision_;
  }

  template <class Predicate>
  void remove_if(Predicate leaves) {
    const std::lock_guard lock(mutex_);
    for (auto entry = present_.begin(); entry != present_.end();)
      entry = leaves(entry->first) ? leave(entry) : std::next(entry);
    ++revision_;
  }

  [[nodiscard]] std::vector<DiscoveredEndpoint> endpoints() const {
    const std::lock_guard lock(mutex_);
    std::vector<DiscoveredEndpoint> result;
    for (const auto& [key, entry] : present_) result.push_back(entry.endpoint);
    return result;
  }

  [[nodiscard]] std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return present_.size();
  }

  /// How many of those who are there are so.
  template <class Predicate>
  [[nodiscard]] int count_if(Predicate is_so) const {
    const std::lock_guard lock(mutex_);
    return static_cast<int>(
        std::ranges::count_if(present_, [&](const auto& entry) { return is_so(entry.second.endpoint); }));
  }

  /// Writers, present and departed, on the topic of `own` whose type differs from its own.
  [[nodiscard]] std::set<Key> writers_of_another_version(const DiscoveredEndpoint& own) const {
    const std::lock_guard lock(mutex_);
    std::set<Key> result;
    const auto insert = [&](const auto& entry) {
      if (entry.second.endpoint.publisher && is_another_version(own, entry.second.endpoint))
        result.insert(entry.first);
    };
    std::for_each(present_.begin(), present_.end(), insert);
    std::for_each(departed_.begin(), departed_.end(), insert);
    return result;
  }

  /// Of an endpoint, present or departed; nullopt if it is not known.
  [[nodiscard]] std::optional<Guid> guid_of(const Key& key) const {
    const std::lock_guard lock(mutex_);
    if (const auto known = present_.find(key); known != present_.end()) return known->second.guid;
    const auto departed = std::ranges::find(departed_, key, &std::pair<Key, Entry>::first);
    return departed == departed_.end() ? std::nullopt : std::optional(departed->second.guid);
  }

  /// Grows with every change.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }

 private:
  struct Entry {
    DiscoveredEndpoint endpoint;
    Guid guid{};
  };
  auto leave(typename std::map<Key, Entry>::iterator entry) {
    if (entry->second.endpoint.publisher) departed_.emplace_back(entry->first, std::move(entry->second));
    if (departed_.size() > kRemembered) departed_.pop_front();
    return present_.erase(entry);
  }

  mutable std::mutex mutex_;
  std::map<Key, Entry> present_;
  std::deque<std::pair<Key, Entry>> departed_;
  std::atomic<std::uint64_t> revision_ = 0;
};

/// Tells a reader whose samples it must not decode. For one thread.
template <class Key>
class VersionCheck {
 public:
  VersionCheck(const EndpointDirectory<Key>& directory, const std::string& topic, const TypeOps& type)
      : directory_(directory), own_{topic, type.dds_name, false, type.type_hash, {}} {}

  /// The writers of another version among those whose samples can be taken now.
  const std::set<Key>& others() {
    const std::uint64_t revision = directory_.revision();
    if (revision != seen_) others_ = directory_.writers_of_another_version(own_);
    seen_ = revision;
    return others_;
  }

 private:
  const EndpointDirectory<Key>& directory_;
  DiscoveredEndpoint own_;
  std::set<Key> others_;
  std::uint64_t seen_ = 0;  // an empty directory has no writers
};

}  // namespace rds::bus::detail
