// SPDX-License-Identifier: Apache-2.0
#include "common/service/peers/peers.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "common/service/process/printable.hpp"
#include "common/topics/topics.hpp"

namespace rds::service {
namespace {

using rds_msgs::msg::ServiceStatus;
namespace Role = rds_msgs::msg::ServiceStatus_Constants;

constexpr std::size_t kMaxPeers = 256;
constexpr std::size_t kMostText = 1024;  // bytes of a status

/// Not one that a stranger has made long: kMaxPeers are kept.
bool is_short(const ServiceStatus& status) {
  return status.header().frame_id().size() + status.service().size() + status.version().size() +
             status.machine().size() + status.message().size() <=
         kMostText;
}

}  // namespace

std::string name_of(const ServiceStatus& status) {
  const std::string kind = printable(status.service(), 32);
  return status.machine().empty() ? kind : fmt::format("{} on {}", kind, printable(status.machine(), 64));
}

Peers::Peers(bus::Participant& bus, std::function<void()> changed, const bus::Qos& qos)
    : changed_(std::move(changed)),
      subscription_(bus.subscribe<ServiceStatus>(
          topics::kServiceStatus.name, qos,
          owners_.only_owned([this](const auto& status) { take(*status); }, [] {}))) {}

void Peers::take(const ServiceStatus& status) {
  if (!is_short(status)) return;
  bool changed = false;
  {
    const std::lock_guard lock(mutex_);
    const auto known = peers_.find(status.instance());
    if (known == peers_.end()) forget_silent();
    if (known == peers_.end() && peers_.size() >= kMaxPeers) return;
    changed = known == peers_.end() || known->second.status.role() != status.role();
    const std::chrono::duration<double> here = std::chrono::system_clock::now().time_since_epoch();
    const double there = status.header().stamp().sec() + status.header().stamp().nanosec() * 1e-9;
    peers_[status.instance()] = {status, Clock::now(), there - here.count()};
  }
  if (changed && changed_) changed_();
}

void Peers::forget_silent() {
  const auto now = Clock::now();
  std::erase_if(peers_, [&](const auto& entry) { return now - entry.second.heard > kGoneAfter; });
}

bool Peers::is_active(const Peer& peer) {
  return peer.status.role() == Role::ACTIVE && Clock::now() - peer.heard <= kGoneAfter;
}

bool Peers::is_present(const Peer& peer) {
  return peer.status.role() != Role::STOPPED && Clock::now() - peer.heard <= kGoneAfter;
}

bool Peers::hears_another_than(std::uint64_t instance) const {
  const std::lock_guard lock(mutex_);
  return std::ranges::any_of(
      peers_, [&](const auto& entry) { return entry.first != instance && is_present(entry.second); });
}

bool Peers::is_there(std::uint64_t instance) const {
  const std::lock_guard lock(mutex_);
  const auto peer = peers_.find(instance);
  return peer != peers_.end() && is_active(peer->second);
}

bool Peers::has_active(std::string_view kind) const {
  const std::lock_guard lock(mutex_);
  return std::ranges::any_of(peers_, [&](const auto& entry) {
    return entry.second.status.service() == kind && is_active(entry.second);
  });
}

std::optional<Peers::Clock::duration> Peers::silent_for(std::uint64_t instance) const {
  const std::lock_guard lock(mutex_);
  const auto peer = peers_.find(instance);
  return peer == peers_.end() ? std::nullopt : std::optional(Clock::now() - peer->second.heard);
}

std::optional<std::string> Peers::name_of(std::uint64_t instance) const {
  const std::lock_guard lock(mutex_);
  const auto peer = peers_.find(instance);
  return peer == peers_.end() ? std::nullopt : std::optional(service::name_of(peer->second.status));
}

bool Peers::has_left(std::uint64_t instance) const {
  const std::lock_guard lock(mutex_);
  const auto peer = peers_.find(instance);
  return peer != peers_.end() && peer->second.status.role() != Role::ACTIVE;
}

std::vector<Peer> Peers::known() const {
  const std::lock_guard lock(mutex_);
  std::vector<Peer> known;
  for (const auto& entry : peers_) known.push_back(entry.second);
  return known;
}

std::vector<Peer> Peers::present() const {
  std::vector<Peer> present;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [instance, peer] : peers_)
      if (is_present(peer)) present.push_back(peer);
  }
  std::ranges::sort(present, {},
                    [](const Peer& p) { return std::pair(p.status.service(), p.status.instance()); });
  return present;
}

bool FollowedWriter::accept(std::uint64_t instance, bool same_map) {
  const bool accepted = !follows_ ? peers_.is_there(instance) || !peers_.has_active(kind_)
                                  : instance == followed_ || may_replace(instance, same_map);
  if (!accepted) return false;
  follows_ = true;
  followed_ = instance;
  last_used_ = Peers::Clock::now();
  return true;
}

bool FollowedWriter::may_replace(std::uint64_t newcomer, bool same_map) const {
  const bool goes_on = same_map && (peers_.is_there(newcomer) || !peers_.is_there(followed_));
  return goes_on || is_gone(newcomer);
}

/// Who tells no status is gone when it writes no more, or when a service comes that does.
bool FollowedWriter::is_gone(std::uint64_t newcomer) const {
  if (peers_.has_left(followed_)) return true;
  const auto told = peers_.silent_for(followed_);
  const bool service_comes = peers_.is_there(newcomer);
  if (!told && service_comes) return true;
  const auto silent = told.value_or(Peers::Clock::now() - last_used_);
  return silent > Peers::kGoneAfter || (service_comes && silent > Peers::kReplacedAfter);
}

}  // namespace rds::service
