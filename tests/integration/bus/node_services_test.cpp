// SPDX-License-Identifier: Apache-2.0
// What a program of ROS 2 asks of our nodes by services, on both vendors, each in the form of its own rmw.
#include <array>

#include <gmock/gmock.h>

#include "lifecycle_msgs/srv/ChangeState_Request.h"
#include "lifecycle_msgs/srv/ChangeState_Response.h"
#include "lifecycle_msgs/srv/GetAvailableTransitions_Request.h"
#include "lifecycle_msgs/srv/GetAvailableTransitions_Response.h"
#include "lifecycle_msgs/srv/GetState_Request.h"
#include "lifecycle_msgs/srv/GetState_Response.h"
#include "rcl_interfaces/srv/DescribeParameters_Request.h"
#include "rcl_interfaces/srv/DescribeParameters_Response.h"
#include "rcl_interfaces/srv/GetParameters_Request.h"
#include "rcl_interfaces/srv/GetParameters_Response.h"
#include "rcl_interfaces/srv/ListParameters_Request.h"
#include "rcl_interfaces/srv/ListParameters_Response.h"
#include "rcl_interfaces/srv/SetParameters_Request.h"
#include "rcl_interfaces/srv/SetParameters_Response.h"
#include "std_srvs/srv/SetBool_Request.h"
#include "std_srvs/srv/SetBool_Response.h"
#include "std_srvs/srv/Trigger_Request.h"
#include "std_srvs/srv/Trigger_Response.h"
#include "tests/integration/run_support.hpp"
#include "tests/support/service_client.hpp"

namespace rds::test {
namespace {

using namespace lifecycle_msgs::srv;
using namespace rcl_interfaces::srv;
using namespace std_srvs::srv;
using ::testing::Contains;
using ::testing::HasSubstr;

class NodeServices : public ::testing::TestWithParam<bus::Vendor> {
 protected:
  template <class Request, class Response>
  std::optional<Response> ask(const std::string& service, const Request& request) {
    return ServiceClient<Request, Response>(GetParam(), "robot1/rds_tracker/" + service).call(request);
  }

  Process tracker{{std::string(RDS_BIN_DIR) + "/rds-tracker", "--bus", name_of(GetParam()), "--domain",
                   std::to_string(test_domain()), "--loopback", "--ros-args", "-r", "__ns:=/robot1", "-p",
                   "extraction.features:=800"}};
};

TEST_P(NodeServices, TellSettingsAsParameters) {
  ListParameters_Request below;
  below.prefixes({"extraction"});
  const auto listed = ask<ListParameters_Request, ListParameters_Response>("list_parameters", below);
  ASSERT_TRUE(listed) << tracker.standard_error();
  EXPECT_THAT(listed->result().names(), Contains("extraction.features"));
  EXPECT_EQ(listed->result().names().size(), 5U);

  GetParameters_Request names;
  names.names({"extraction.features", "camera.preset", "unheard_of"});
  const auto got = ask<GetParameters_Request, GetParameters_Response>("get_parameters", names);
  ASSERT_TRUE(got);
  ASSERT_EQ(got->values().size(), 3U);
  EXPECT_EQ(got->values()[0].integer_value(), 800);
  EXPECT_EQ(got->values()[1].string_value(), "rds");
  EXPECT_EQ(got->values()[2].type(), 0);

  DescribeParameters_Request described;
  described.names({"extraction.features"});
  const auto description =
      ask<DescribeParameters_Request, DescribeParameters_Response>("describe_parameters", described);
  ASSERT_TRUE(description);
  EXPECT_EQ(description->descriptors().at(0).description(), "wanted per picture");

  SetParameters_Request setting;
  setting.parameters().emplace_back().name("extraction.features");
  const auto refused = ask<SetParameters_Request, SetParameters_Response>("set_parameters", setting);
  ASSERT_TRUE(refused);
  EXPECT_FALSE(refused->results().at(0).successful());
  EXPECT_THAT(refused->results().at(0).reason(), HasSubstr("is read at the start"));
}

TEST_P(NodeServices, CarryOutCommands) {
  const auto state = ask<GetState_Request, GetState_Response>("get_state", {});
  ASSERT_TRUE(state) << tracker.standard_error();
  EXPECT_EQ(state->current_state().label(), "active");
  SetBool_Request pausing;
  pausing.data(true);
  const auto paused = ask<SetBool_Request, SetBool_Response>("pause", pausing);
  ASSERT_TRUE(paused);
  EXPECT_TRUE(paused->success()) << paused->message();
  EXPECT_EQ(paused->message(), "paused");
  const auto resumed = ask<SetBool_Request, SetBool_Response>("pause", {});
  ASSERT_TRUE(resumed);
  EXPECT_EQ(resumed->message(), "resumed");
  const auto reset = ask<Trigger_Request, Trigger_Response>("reset", {});
  ASSERT_TRUE(reset);
  EXPECT_TRUE(reset->success()) << reset->message();
}

TEST_P(NodeServices, GoThroughTheStatesOfALife) {
  const auto change = [&](const std::string& label) {
    ChangeState_Request request;
    request.transition().label(label);
    const auto changed = ask<ChangeState_Request, ChangeState_Response>("change_state", request);
    return changed && changed->success();
  };
  const auto state = [&] {
    const auto told = ask<GetState_Request, GetState_Response>("get_state", {});
    return told ? told->current_state().label() : "";
  };
  EXPECT_EQ(state(), "active") << tracker.standard_error();
  EXPECT_FALSE(change("activate")) << "it is";
  EXPECT_TRUE(change("deactivate"));
  EXPECT_EQ(state(), "inactive");
  const auto available = ask<GetAvailableTransitions_Request, GetAvailableTransitions_Response>("get_available_transitions", {});
  ASSERT_TRUE(available);
  EXPECT_EQ(available->available_transitions().size(), 3U);
  EXPECT_TRUE(change("cleanup"));
  EXPECT_EQ(state(), "unconfigured");
  EXPECT_TRUE(change("configure"));
  EXPECT_TRUE(change("activate"));
  EXPECT_EQ(state(), "active");
  EXPECT_TRUE(change("shutdown"));
  EXPECT_EQ(tracker.wait(std::chrono::seconds(20)), 0);
}

constexpr std::array kVendors{
    bus::Vendor::kFastDds,
    bus::Vendor::kCycloneDds,
#ifdef RDS_HAS_ZENOH
    bus::Vendor::kZenoh,
#endif
};
INSTANTIATE_TEST_SUITE_P(Vendors, NodeServices, ::testing::ValuesIn(kVendors),
                         [](const auto& tested) { return name_of(tested.param); });

}  // namespace
}  // namespace rds::test
