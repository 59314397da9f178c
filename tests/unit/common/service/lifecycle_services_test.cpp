// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/lifecycle_services.hpp"

#include <mutex>

#include <gtest/gtest.h>

#include "lifecycle_msgs/srv/ChangeState_Request.h"
#include "lifecycle_msgs/srv/ChangeState_Response.h"
#include "lifecycle_msgs/srv/GetState_Request.h"
#include "lifecycle_msgs/srv/GetState_Response.h"
#include "tests/support/service_client.hpp"

namespace rds::service {
namespace {

using namespace std::chrono_literals;
using namespace lifecycle_msgs::srv;
using test::test_domain;

/// A worker that takes a command and is told when to have carried it out.
class LifecycleServicesTest : public ::testing::Test {
 protected:
  template <class Request, class Response>
  using Client = test::ServiceClient<Request, Response>;

  static ChangeState_Request to(const std::string& label) {
    ChangeState_Request request;
    request.transition().label(label);
    return request;
  }
  std::string state() {
    const auto told =
        Client<GetState_Request, GetState_Response>(bus::Vendor::kFastDds, "worker/get_state").call({});
    return told ? told->current_state().label() : "";
  }
  [[nodiscard]] std::size_t given() {
    const std::lock_guard lock(mutex);
    return commands.size();
  }

  std::unique_ptr<bus::Participant> bus = bus::Participant::create(
      {.vendor = bus::Vendor::kFastDds, .domain = test_domain(), .node_name = "worker", .loopback_only = true});
  std::mutex mutex;
  std::vector<std::function<void(bool)>> commands;  // that are not carried out yet
  LifecycleServices services{*bus,
                             [this](const std::string& /*verb*/, std::function<void(bool)> respond) {
                               const std::lock_guard lock(mutex);
                               commands.push_back(std::move(respond));
                               return true;
                             },
                             [] {}};
};

TEST_F(LifecycleServicesTest, WhatComesDuringATransitionIsRefusedAndDisturbsNothing) {
  Client<ChangeState_Request, ChangeState_Response> manager(bus::Vendor::kFastDds, "worker/change_state");
  while (!manager.is_matched()) std::this_thread::sleep_for(10ms);
  manager.send(to("deactivate"));
  while (given() == 0) std::this_thread::sleep_for(10ms);
  manager.send(to("shutdown"));
  const auto refused = manager.answer(5s);
  ASSERT_TRUE(refused);
  EXPECT_FALSE(refused->success());
  EXPECT_EQ(state(), "deactivating");
  commands.front()(true);
  const auto done = manager.answer(5s);
  ASSERT_TRUE(done);
  EXPECT_TRUE(done->success());
  EXPECT_EQ(state(), "inactive");
}

}  // namespace
}  // namespace rds::service
