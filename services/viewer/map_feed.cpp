// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/map_feed.hpp"

#include <utility>

#include "services/viewer/scene_frames.hpp"

namespace rds::viewer {

MapFeed::MapFeed(service::ServiceContext& context, Board& board, std::function<void()> notify)
    : board_(board),
      notify_(std::move(notify)),
      map_(context, transfer::this_host(), [this](const auto* applied) {
        {
          const std::lock_guard lock(mutex_);
          changed_.add(applied);
        }
        notify_();
      }) {}

/// What the map has by now may be newer than the changes that are taken here; the next ones say the same
/// again.
void MapFeed::take() {
  ChangedChunks changed;
  {
    const std::lock_guard lock(mutex_);
    changed = std::exchange(changed_, {});
  }
  map_.map().look([&](const mapper::OctreeReplica& map, const std::vector<std::string>& labels) {
    board_.map.show(map, changed);
    if (labels == labels_) return;
    labels_ = labels;
    board_.put(Kind::kLabels, labels_frame(labels));
  });
}

}  // namespace rds::viewer
