// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/sharing/map_sharing.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace rds::mapper {
namespace {

/// Of steps that wait for the server's thread, some 100 MB: it takes them four times a second.
constexpr std::size_t kMostVoxels = 5'000'000;
constexpr std::size_t kMostMade = 64;
constexpr std::chrono::seconds kKept{10};  // after it was last asked for
constexpr std::uint64_t kMostRevisions = std::numeric_limits<std::uint32_t>::max();

}  // namespace

MapSharing::MapSharing(service::ServiceContext& context, std::uint64_t host)
    : made_count_(context.diagnostics.counter("map updates made")),
      server_(context, topics::kMapper, transfer::kMaps, *this, host) {}

void MapSharing::start(std::function<MapDelta()> make, std::vector<std::string> labels) {
  const std::lock_guard lock(mutex_);
  wants_map_ = false;
  inbox_ = {.is_open = true, .is_torn = true, .whole = std::move(make), .labels = std::move(labels)};
}

void MapSharing::add(const std::shared_ptr<const MapDelta>& delta, const std::vector<std::string>& labels) {
  const std::lock_guard lock(mutex_);
  if (!inbox_.is_open) return;
  inbox_.voxels += delta->log_odds.size() + delta->deleted_keys.size() / 3;
  if (inbox_.voxels > kMostVoxels) {
    inbox_ = {.is_torn = true};
    return;
  }
  inbox_.deltas.push_back(delta);
  inbox_.labels = labels;
}

void MapSharing::begin_map() {
  const std::lock_guard lock(mutex_);
  inbox_ = {.is_torn = true};
}

transfer::ItemMaker::Offers MapSharing::offers(bool has_readers) {
  if (!has_readers) close();
  take_inbox();
  std::erase_if(made_, [](const auto& made) { return transfer::now() - made.second.asked > kKept; });
  {
    const std::lock_guard lock(mutex_);
    wants_map_ = has_readers && !inbox_.is_open;
  }
  if (!voxels_ || voxels_->revision() > kMostRevisions) return {};
  return {voxels_->map_id(), {{transfer::Stream::kMapUpdates, {1, voxels_->revision()}}}};
}

void MapSharing::close() {
  const std::lock_guard lock(mutex_);
  inbox_ = {.is_torn = true};
}

void MapSharing::take_inbox() {
  Inbox taken;
  {
    const std::lock_guard lock(mutex_);
    taken = std::exchange(inbox_, Inbox{.is_open = inbox_.is_open, .labels = inbox_.labels});
  }
  if (taken.is_torn) {
    voxels_.reset();
    made_.clear();
  }
  if (taken.whole) voxels_.emplace(taken.whole());
  const bool follows = std::ranges::all_of(
      taken.deltas, [&](const auto& delta) { return voxels_ && voxels_->add(*delta); });
  if (!follows) close();  // and begin again with the next reader's question
  labels_ = std::move(taken.labels);
}

const MapSharing::Bytes* MapSharing::find(transfer::Stream stream, std::uint64_t number) {
  if (stream != transfer::Stream::kMapUpdates || !voxels_) return nullptr;
  auto found = made_.find(number);
  if (found == made_.end()) {
    auto item = make(span_of(number));
    if (!item) return nullptr;
    ++made_count_;
    if (made_.size() >= kMostMade) made_.erase(longest_unasked());
    found = made_.emplace(number, Made{std::move(*item)}).first;
  }
  found->second.asked = transfer::now();
  return &found->second.bytes;
}

std::map<std::uint64_t, MapSharing::Made>::const_iterator MapSharing::longest_unasked() const {
  return std::ranges::min_element(made_, {}, [](const auto& made) { return made.second.asked; });
}

/// To the newest revision, which may have gone on since it was offered.
std::optional<MapSharing::Bytes> MapSharing::make(const UpdateSpan& span) const {
  if (span.since >= span.until || span.until > voxels_->revision()) return std::nullopt;
  auto delta = voxels_->since(span.since);
  if (!delta) return std::nullopt;
  return pack({std::move(*delta), labels_});
}

}  // namespace rds::mapper
