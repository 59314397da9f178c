// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/map_services.hpp"

#include <gmock/gmock.h>

#include "nav_msgs/srv/GetMap_Request.h"
#include "nav_msgs/srv/GetMap_Response.h"
#include "octomap_msgs/srv/GetOctomap_Request.h"
#include "octomap_msgs/srv/GetOctomap_Response.h"
#include "tests/support/service_client.hpp"
#include "tests/unit/services/mapper/mapper_on_the_bus.hpp"

namespace rds::mapper {
namespace {

using GridClient = ::rds::test::ServiceClient<nav_msgs::srv::GetMap_Request, nav_msgs::srv::GetMap_Response>;
using OctomapClient =
    ::rds::test::ServiceClient<octomap_msgs::srv::GetOctomap_Request, octomap_msgs::srv::GetOctomap_Response>;
constexpr auto kVendor = bus::Vendor::kFastDds;

TEST_F(MapperOnTheBus, AnswersWithItsMap) {
  auto upright = config();
  upright.mapper.grid.up = "-y";
  start(upright);
  for (std::uint64_t id = 0; id < 2; ++id) send(id);
  ASSERT_TRUE(has_revision(2));
  const auto full = OctomapClient(kVendor, "octomap_full").call({});
  ASSERT_TRUE(full);
  EXPECT_EQ(full->map().id(), "ColorOcTree");
  EXPECT_FALSE(full->map().binary());
  const std::vector<std::uint8_t> tree = saved_tree();
  EXPECT_TRUE(std::equal(full->map().data().begin(), full->map().data().end(), tree.begin(), tree.end(),
                         [](std::int8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; }));
  const auto binary = OctomapClient(kVendor, "octomap_binary").call({});
  ASSERT_TRUE(binary);
  EXPECT_EQ(binary->map().id(), "OcTree");
  EXPECT_TRUE(binary->map().binary());
  EXPECT_LT(binary->map().data().size(), full->map().data().size());
  const auto grid = GridClient(kVendor, "mapper/map").call({});
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->map().header().frame_id(), "map");
  EXPECT_EQ(grid->map().data().size(), std::size_t{grid->map().info().width()} * grid->map().info().height());
  EXPECT_THAT(grid->map().data(), ::testing::Contains(100));
}

TEST_F(MapperOnTheBus, AnswersBeforeThereIsAMap) {
  start(config());
  const auto grid = GridClient(kVendor, "mapper/map").call({});
  ASSERT_TRUE(grid);
  EXPECT_TRUE(grid->map().data().empty());
  ASSERT_TRUE(OctomapClient(kVendor, "octomap_full").call({}));
}

}  // namespace
}  // namespace rds::mapper
