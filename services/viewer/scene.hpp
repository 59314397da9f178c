// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/messages/keyframe_pose_table.hpp"
#include "common/service/peers/peers.hpp"
#include "common/service/service.hpp"
#include "diagnostic_msgs/msg/DiagnosticArray.h"
#include "nav_msgs/msg/OccupancyGrid.h"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "rds_msgs/msg/PredictedBoxes.h"
#include "rds_msgs/msg/TrackingState.h"
#include "sensor_msgs/msg/CameraInfo.h"
#include "services/viewer/core/board/board.hpp"
#include "services/viewer/core/figures/metrics.hpp"
#include "services/viewer/map_feed.hpp"
#include "services/viewer/picture_feed.hpp"
#include "services/viewer/scene_frames.hpp"
#include "services/viewer/submap_view.hpp"
#include "vision_msgs/msg/Detection3DArray.h"

namespace rds::viewer {

/// What is on the bus, put on the board: bus callbacks fill inboxes, the worker takes.
class Scene {
 public:
  /// @param notify  called when something has come (any thread): take() is due.
  Scene(service::ServiceContext& context, const ViewerServiceConfig& config, Board& board,
        std::function<void()> notify);

  /// Takes what has come.
  void take();
  /// Once a second: the services' figures, with how long ago each was heard.
  void put_services(double now_s) {
    board_.put(Kind::kServices, text_frame(Kind::kServices, services_.to_json(now_s)));
  }
  void want_picture(bool wanted) { picture_.want(wanted); }
  void set_picture(double hz, int quality) { picture_.set(hz, quality); }
  /// Another map begins: the path of the one before goes.
  void forget_path() { board_.path.clear(); }
  [[nodiscard]] std::string metrics(double now_s, std::size_t clients);

 private:
  template <class Message>
  using Of = std::shared_ptr<const Message>;
  using State = Of<rds_msgs::msg::TrackingState>;
  using Boxes = Of<rds_msgs::msg::PredictedBoxes>;
  using Poses = Of<rds_msgs::msg::KeyFramePoses>;
  using Objects = Of<vision_msgs::msg::Detection3DArray>;
  using Grid = Of<nav_msgs::msg::OccupancyGrid>;
  using Report = Of<diagnostic_msgs::msg::DiagnosticArray>;
  using CameraInfo = Of<sensor_msgs::msg::CameraInfo>;

  template <class Message>
  void listen(const topics::Topic<Message>& topic, concurrency::Inbox<Of<Message>>& inbox);
  template <class Message>
  void listen_to_instances(const topics::Topic<Message>& topic, concurrency::Inbox<Of<Message>>& inbox);
  void show(Kind kind, const char* topic, Expected<Bytes> frame);
  void take(const State& state);
  void take(const Poses& poses);
  void take_of_tracker(const Poses& poses);
  void show_submap() { board_.put(Kind::kSubmap, keyframes_frame(Kind::kSubmap, submap_.keyframes(), {})); }
  void take(const Report& report);

  service::ServiceContext& context_;
  Board& board_;
  std::function<void()> notify_;
  service::FollowedWriter tracker_;
  service::InstanceOwners owners_;
  std::uint64_t map_epoch_ = 0;
  messages::KeyframePoseTable keyframes_;
  SubmapView submap_;
  std::vector<Loop> loops_;
  SceneFigures figures_;
  FrameTimes frame_times_;
  ServiceTable services_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<State> states_;
  concurrency::Inbox<Boxes> boxes_;
  concurrency::Inbox<Poses> poses_;
  concurrency::Inbox<Objects> objects_;
  concurrency::Inbox<Grid> grids_;
  concurrency::Inbox<Report> reports_;
  concurrency::Inbox<CameraInfo> camera_infos_;
  PictureFeed picture_;
  MapFeed map_;
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks fill the inboxes
};

}  // namespace rds::viewer
