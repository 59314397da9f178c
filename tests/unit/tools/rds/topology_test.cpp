// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/topology/topology.hpp"

#include <gmock/gmock.h>

namespace rds::run {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Endpoints of a detector, a tracker and the player as they report them when all links are up.
std::map<std::string, std::vector<Endpoint>> connected() {
  return {{kDetector,
           {{"rds/keyframe/images", false, 1},
            {"rds/detections", true, 1},
            {"rds/command", false, 1},
            {"rds/command_result", true, 1}}},
          {kTracker,
           {{"camera/color/image_raw", false, 1},
            {"camera/color/camera_info", false, 1},
            {"camera/aligned_depth_to_color/image_raw", false, 1},
            {"rds/odometry", true, 1},
            {"rds/tracking_state", true, 1},
            {"rds/predicted_boxes", true, 1},
            {"rds/features", true, 1},
            {"rds/keyframe/images", true, 1},
            {"rds/keyframe/poses", true, 2},
            {"rds/keyframe/poses", false, 1},
            {"rds/command", false, 1},
            {"rds/command_result", true, 1}}},
          {kPlayer,
           {{"camera/color/image_raw", true, 1},
            {"camera/color/camera_info", true, 1},
            {"camera/aligned_depth_to_color/image_raw", true, 1},
            {"rds/odometry", false, 1},
            {"rds/tracking_state", false, 1},
            {"rds/predicted_boxes", false, 1},
            {"rds/features", false, 1},
            {"rds/keyframe/poses", false, 1},
            {"rds/detections", false, 1},
            {"rds/command", true, 2},
            {"rds/command_result", false, 2}}}};
}

const std::set<std::string> kRunning{kPlayer, kTracker, kDetector};

TEST(MissingLinks, AreNoneWhenEveryRunningPairKnowsEachOther) {
  EXPECT_THAT(missing_links(kRunning, connected()), IsEmpty());
}

TEST(MissingLinks, OfARobotsSensorsAreMissedOnlyWhereTheyArePlayed) {
  for (const char* topic : {"odom", "imu"}) {
    auto endpoints = connected();
    endpoints[kPlayer].push_back({topic, true, 0});
    EXPECT_THAT(missing_links(kRunning, endpoints),
                Contains(HasSubstr(kPlayer + " writes " + topic + ": 0 of 1 readers")));
    endpoints[kPlayer].back().matched = 1;
    endpoints[kTracker].push_back({topic, false, 1});
    EXPECT_THAT(missing_links(kRunning, endpoints), IsEmpty());
  }
}

TEST(MissingLinks, NameTheEndAndTheTopicThatLacksPartners) {
  auto endpoints = connected();
  endpoints[kDetector][0].matched = 0;
  EXPECT_THAT(missing_links(kRunning, endpoints),
              Contains(HasSubstr("rds-detector reads rds/keyframe/images: 0 of 1 writers")));
}

TEST(MissingLinks, AMapperThatLocalizesOnlyNeedsNoKeyframes) {
  auto endpoints = connected();
  endpoints[kMapper] = {{"rds/keyframe/poses", false, 1},
                        {"rds/map/info", true, 1},
                        {"rds/command", false, 1},
                        {"rds/command_result", true, 1}};
  for (auto& [process, its] : endpoints)
    for (Endpoint& e : its) e.matched = 9;  // enough partners
  const std::set<std::string> running{kPlayer, kTracker, kDetector, kMapper};
  const auto names_mapper = Contains(HasSubstr("rds-mapper reads rds/keyframe/images"));
  EXPECT_THAT(missing_links(running, endpoints), names_mapper);
  EXPECT_THAT(missing_links(running, endpoints, true), Not(names_mapper));
}

TEST(MissingLinks, NameAProcessThatDoesNotAnswerOnce) {
  auto endpoints = connected();
  endpoints.erase(kDetector);
  const auto missing = missing_links(kRunning, endpoints);
  EXPECT_EQ(std::ranges::count(missing, "rds-detector does not answer"), 1);
}

TEST(MissingLinks, DoNotAskForProcessesThatDoNotRun) {
  auto endpoints = connected();
  endpoints.erase(kDetector);
  for (Endpoint& e : endpoints[kPlayer])
    if (e.topic == "rds/detections") e.matched = 0;
  for (Endpoint& e : endpoints[kTracker])
    if (e.topic == "rds/keyframe/images") e.matched = 0;
  EXPECT_THAT(missing_links({kPlayer, kTracker}, endpoints), IsEmpty());
}

}  // namespace
}  // namespace rds::run
