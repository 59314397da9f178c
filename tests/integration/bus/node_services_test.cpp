// SPDX-License-Identifier: Apache-2.0
// What a program of ROS 2 asks of our nodes by services, on each bus, each in the form of its own rmw.
#include <array>

#include <gmock/gmock.h>

#include "bond/msg/Status.h"
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
#include "rcl_interfaces/srv/SetParametersAtomically_Request.h"
#include "rcl_interfaces/srv/SetParametersAtomically_Response.h"
#include "rcl_interfaces/srv/SetParameters_Request.h"
#include "rcl_interfaces/srv/SetParameters_Response.h"
#include "rds_msgs/srv/LoadMap_Request.h"
#include "rds_msgs/srv/LoadMap_Response.h"
#include "rds_msgs/srv/SaveMap_Request.h"
#include "rds_msgs/srv/SaveMap_Response.h"
#include "std_srvs/srv/SetBool_Request.h"
#include "std_srvs/srv/SetBool_Response.h"
#include "std_srvs/srv/Trigger_Request.h"
#include "std_srvs/srv/Trigger_Response.h"
#include "tests/integration/run_support.hpp"
#include "tests/support/service_client.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

using namespace lifecycle_msgs::srv;
using namespace rcl_interfaces::srv;
using namespace std_srvs::srv;
using ::testing::Contains;
using ::testing::HasSubstr;

class NodeServices : public ::testing::TestWithParam<bus::Vendor> {
 protected:
  explicit NodeServices(const std::string& managed = "false")
      : tracker({std::string(RDS_BIN_DIR) + "/rds-tracker", "--bus", name_of(GetParam()), "--domain",
                 std::to_string(test_domain()), "--loopback", "--ros-args", "-r", "__ns:=/robot1", "-p",
                 "extraction.features:=800", "-p", "managed:=" + managed}) {}
  template <class Request, class Response>
  std::optional<Response> ask(const std::string& service, const Request& request) {
    return ServiceClient<Request, Response>(GetParam(), "robot1/rds_tracker/" + service).call(request);
  }
  bool change(const std::string& label) {
    ChangeState_Request request;
    request.transition().label(label);
    const auto changed = ask<ChangeState_Request, ChangeState_Response>("change_state", request);
    return changed && changed->success();
  }
  std::string state() {
    const auto told = ask<GetState_Request, GetState_Response>("get_state", {});
    return told ? told->current_state().label() : "";
  }

  Process tracker;
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

rcl_interfaces::msg::Parameter parameter(const std::string& name, double value) {
  rcl_interfaces::msg::Parameter parameter;
  parameter.name(name);
  parameter.value().type(3);
  parameter.value().double_value(value);
  return parameter;
}

TEST_P(NodeServices, SetLiveSettings) {
  SetParameters_Request setting;
  setting.parameters({parameter("keyframe.static_interval_s", 2.5),
                      parameter("keyframe.movable_interval_s", 0), parameter("extraction.scale_factor", 1.5),
                      parameter("frames.publish_tf", 1)});
  const auto told = ask<SetParameters_Request, SetParameters_Response>("set_parameters", setting);
  ASSERT_TRUE(told) << tracker.standard_error();
  ASSERT_EQ(told->results().size(), 4U);
  EXPECT_TRUE(told->results()[0].successful()) << told->results()[0].reason();
  EXPECT_THAT(told->results()[1].reason(), HasSubstr("keyframe.movable_interval_s: 0, expected 0.01"));
  EXPECT_THAT(told->results()[2].reason(), HasSubstr("is read at the start"));
  EXPECT_THAT(told->results()[3].reason(), HasSubstr("is of type boolean, not double"));

  SetParametersAtomically_Request together;
  together.parameters(
      {parameter("keyframe.static_interval_s", 3), parameter("keyframe.movable_interval_s", 0)});
  const auto refused = ask<SetParametersAtomically_Request, SetParametersAtomically_Response>(
      "set_parameters_atomically", together);
  ASSERT_TRUE(refused);
  EXPECT_FALSE(refused->result().successful());

  GetParameters_Request names;
  names.names({"keyframe.static_interval_s", "keyframe.movable_interval_s"});
  const auto got = ask<GetParameters_Request, GetParameters_Response>("get_parameters", names);
  ASSERT_TRUE(got);
  EXPECT_EQ(got->values().at(0).double_value(), 2.5);
  EXPECT_EQ(got->values().at(1).double_value(), 0.1);
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
  EXPECT_EQ(state(), "active") << tracker.standard_error();
  EXPECT_FALSE(change("activate")) << "it is";
  EXPECT_TRUE(change("deactivate"));
  EXPECT_EQ(state(), "inactive");
  const auto available =
      ask<GetAvailableTransitions_Request, GetAvailableTransitions_Response>("get_available_transitions", {});
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

/// Tracker and mapper in one folder of maps.
class NodesWithAMap : public ::testing::TestWithParam<bus::Vendor> {
 protected:
  std::unique_ptr<Process> start(const std::string& service) {
    return std::make_unique<Process>(
        std::vector<std::string>{std::string(RDS_BIN_DIR) + "/" + service, "--bus", name_of(GetParam()),
                                 "--domain", std::to_string(test_domain()), "--loopback", "--namespace",
                                 "robot1"},
        Process::Environment{{"RDS_MAPS_DIR", maps.path().string()}});
  }
  /// Asks once, as who waits for what takes its time. @return the answer, with "done: " or "not done: "
  /// before.
  template <class Request, class Response>
  std::string ask(const std::string& service, const std::string& name) {
    ServiceClient<Request, Response> client(GetParam(), "robot1/rds_tracker/" + service);
    for (int i = 0; i < 200 && !client.is_matched(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    Request request;
    request.name(name);
    client.send(request);
    const auto told = client.answer(std::chrono::seconds(20));
    if (!told) return "no answer";
    return (told->success() ? "done: " : "not done: ") + told->message();
  }
  std::string save(const std::string& name) {
    return ask<rds_msgs::srv::SaveMap_Request, rds_msgs::srv::SaveMap_Response>("save_map", name);
  }
  std::string load(const std::string& name) {
    return ask<rds_msgs::srv::LoadMap_Request, rds_msgs::srv::LoadMap_Response>("load_map", name);
  }

  TemporaryFolder maps;
  std::unique_ptr<Process> tracker = start("rds-tracker");
};

TEST_P(NodesWithAMap, SaveAndLoadItByName) {
  EXPECT_EQ(save("kitchen"), "not done: rds-mapper does not answer, expected it to be running");
  EXPECT_THAT(save("../kitchen"), HasSubstr("not done: "));
  const auto mapper = start("rds-mapper");
  ASSERT_TRUE(mapper->wait_for_output("version", std::chrono::seconds(20)));
  EXPECT_EQ(save("kitchen"), "done: saved as kitchen in " + (maps.path() / "kitchen").string());
  EXPECT_TRUE(std::filesystem::exists(maps.path() / "kitchen" / "map.rds"));
  EXPECT_THAT(load("kitchen"),
              ::testing::AllOf(HasSubstr("done: rds-mapper: map of"), HasSubstr("; rds-tracker: map of")));
  EXPECT_THAT(load("cellar"), ::testing::AllOf(HasSubstr("not done: rds-tracker: "), HasSubstr("cellar")));
}

/// The end of a bond that Nav2's lifecycle manager holds: it tells ten times a second that it lives.
class ManagersBond {
 public:
  ManagersBond(bus::Vendor vendor, const std::string& id)
      : bus_(bus::Participant::create(
            {.vendor = vendor, .domain = test_domain(), .node_name = "manager", .loopback_only = true})),
        publisher_(bus_->advertise<bond::msg::Status>("robot1/bond", {.reliable = true, .depth = 5})),
        subscription_(bus_->subscribe<bond::msg::Status>("robot1/bond", {.reliable = true, .depth = 100},
                                                         [this, id](const auto& m) {
                                                           const std::lock_guard lock(mutex_);
                                                           if (m->id() == id && m->instance_id() != kInstance)
                                                             heard_ = *m;
                                                         })) {
    status_.id(id);
    status_.instance_id(kInstance);
  }
  /// @return the newest answer to heartbeats of half a second; nullopt if there is none.
  std::optional<bond::msg::Status> tell(bool active) {
    status_.active(active);
    {
      const std::lock_guard lock(mutex_);
      heard_.reset();
    }
    for (int i = 0; i < 5; ++i) {
      publisher_.write(status_);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    const std::lock_guard lock(mutex_);
    return heard_;
  }
  /// Nav2 waits two seconds for a bond to form; a busy machine may take longer.
  bool forms() {
    for (int i = 0; i < 20; ++i)
      if (const auto heard = tell(true); heard && heard->active()) return true;
    return false;
  }

 private:
  static constexpr const char* kInstance = "0d7a9d3c-manager";
  std::unique_ptr<bus::Participant> bus_;
  bond::msg::Status status_;
  std::mutex mutex_;
  std::optional<bond::msg::Status> heard_;
  bus::Publisher<bond::msg::Status> publisher_;
  bus::Subscription subscription_;
};

class ManagedNode : public NodeServices {
 protected:
  ManagedNode() : NodeServices("true") {}
};

TEST_P(ManagedNode, IsBroughtUpByAManagerWithABond) {
  EXPECT_EQ(state(), "unconfigured") << tracker.standard_error();
  EXPECT_FALSE(change("activate")) << "before it is configured";
  EXPECT_TRUE(change("configure"));
  ManagersBond bond(GetParam(), "rds_tracker");
  EXPECT_FALSE(bond.tell(true)) << "before it is active";
  EXPECT_TRUE(change("activate"));
  EXPECT_EQ(state(), "active");
  ASSERT_TRUE(bond.forms());
  ManagersBond of_another(GetParam(), "rds_mapper");
  EXPECT_FALSE(of_another.tell(true));
  EXPECT_TRUE(change("deactivate"));
  const auto parting = bond.tell(true);
  ASSERT_TRUE(parting) << "it says that it lives no more";
  EXPECT_FALSE(parting->active());
  EXPECT_FALSE(bond.tell(true)) << "once";
  EXPECT_TRUE(change("activate"));
  ASSERT_TRUE(bond.forms());
  const auto end = bond.tell(false);
  ASSERT_TRUE(end) << "the manager ends it";
  EXPECT_FALSE(end->active());
}

INSTANTIATE_TEST_SUITE_P(Vendors, NodeServices, ::testing::ValuesIn(kAllVendors), vendor_name);
INSTANTIATE_TEST_SUITE_P(Vendors, NodesWithAMap, ::testing::ValuesIn(kAllVendors), vendor_name);
INSTANTIATE_TEST_SUITE_P(Vendors, ManagedNode, ::testing::ValuesIn(kAllVendors), vendor_name);

}  // namespace
}  // namespace rds::test
