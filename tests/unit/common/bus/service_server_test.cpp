// SPDX-License-Identifier: Apache-2.0
#include "common/bus/service_server.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <stdexcept>

#include <gtest/gtest.h>

#include "std_srvs/srv/SetBool_Request.h"
#include "std_srvs/srv/SetBool_Response.h"
#include "tests/support/service_client.hpp"
#include "tests/unit/common/bus/bus_test_support.hpp"

namespace rds::bus {
namespace {

using std_srvs::srv::SetBool_Request;
using std_srvs::srv::SetBool_Response;
using Client = test::ServiceClient<SetBool_Request, SetBool_Response>;

SetBool_Request asking(bool data) {
  SetBool_Request request;
  request.data(data);
  return request;
}

SetBool_Response echo(const SetBool_Request& request) {
  SetBool_Response response;
  response.success(request.data());
  response.message("heard");
  return response;
}

/// Of the only service of a participant.
EndpointStatistics statistics_of(const Participant& participant) {
  const auto all = participant.statistics();
  return all.empty() ? EndpointStatistics{} : all.front();
}

class ServiceOf : public ::testing::TestWithParam<Vendor> {
 protected:
  std::unique_ptr<Participant> participant = join(GetParam(), "node");
  Client client{GetParam(), "node/switch"};
};

TEST_P(ServiceOf, AnswersEachRequestWithItsReply) {
  const auto server = serve<SetBool_Request, SetBool_Response>(*participant, "~/switch", &echo);
  const auto first = client.call(asking(true));
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->success());
  EXPECT_EQ(first->message(), "heard");
  const auto second = client.call(asking(false));
  ASSERT_TRUE(second);
  EXPECT_FALSE(second->success());
  EXPECT_EQ(statistics_of(*participant).topic, "node/switch");
  EXPECT_EQ(statistics_of(*participant).dropped, 0U);
}

TEST_P(ServiceOf, AnswersLaterFromAnotherThread) {
  std::promise<Answer<SetBool_Response>> asked;
  std::atomic<int> requests = 0;
  const auto server = serve_later<SetBool_Request, SetBool_Response>(
      *participant, "~/switch", [&](const auto& /*request*/, auto answer) {
        if (requests++ == 0) asked.set_value(std::move(answer));
      });
  ASSERT_TRUE(eventually([&] { return client.is_matched(); }));
  client.send(asking(true));
  const auto answer = asked.get_future().get();
  EXPECT_TRUE(answer(echo(asking(true))));
  EXPECT_TRUE(client.answer(std::chrono::seconds(5)));
}

TEST_P(ServiceOf, DropsWhatIsNoRequestAndGoesOn) {
  const auto server = serve<SetBool_Request, SetBool_Response>(*participant, "~/switch", &echo);
  ASSERT_TRUE(client.call(asking(true)));
  std::uint64_t wrong = 0;
  for (const detail::MessageBytes& bytes : std::vector<detail::MessageBytes>{{0, 1, 0, 0},
                                                                             {0, 1, 0, 0, 7, 7, 7, 7},
                                                                             detail::MessageBytes(100, 255),
                                                                             detail::MessageBytes(21, 0)})
    wrong += client.send_bytes(bytes) ? 1 : 0;
  EXPECT_TRUE(eventually([&] { return statistics_of(*participant).dropped >= wrong - 1; }))
      << statistics_of(*participant).dropped;
  EXPECT_TRUE(client.call(asking(true)));
}

TEST_P(ServiceOf, CountsARequestThatItsHandlerCannotTake) {
  const auto server = serve<SetBool_Request, SetBool_Response>(
      *participant, "~/switch", [](const SetBool_Request& request) -> SetBool_Response {
        if (!request.data()) throw std::runtime_error("no");
        return echo(request);
      });
  ASSERT_TRUE(client.call(asking(true)));
  client.send(asking(false));
  EXPECT_TRUE(eventually([&] { return statistics_of(*participant).dropped == 1; }));
  EXPECT_TRUE(client.call(asking(true)));
}

TEST_P(ServiceOf, KeepsTheNewestRequestsOfAFlood) {
  std::promise<void> go_on;
  std::atomic<int> handled = 0;
  const auto server = serve<SetBool_Request, SetBool_Response>(
      *participant, "~/switch", [&, waiting = go_on.get_future().share()](const SetBool_Request& request) {
        ++handled;
        waiting.wait();
        return echo(request);
      });
  ASSERT_TRUE(eventually([&] { return client.is_matched(); }));
  for (int i = 0; i < 1000; ++i) client.send(asking(true));
  ASSERT_TRUE(eventually([&] { return handled == 1; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // let all arrive
  go_on.set_value();
  EXPECT_TRUE(client.call(asking(true)));
  EXPECT_LE(handled, 25);
}

TEST_P(ServiceOf, AnAnswerAfterItsEndReachesNobody) {
  Answer<SetBool_Response> late;
  {
    std::promise<void> asked;
    std::atomic<int> requests = 0;
    const auto server = serve_later<SetBool_Request, SetBool_Response>(
        *participant, "~/switch", [&](const auto& /*request*/, auto answer) {
          if (requests++ > 0) return;
          late = std::move(answer);
          asked.set_value();
        });
    ASSERT_TRUE(eventually([&] { return client.is_matched(); }));
    client.send(asking(true));
    asked.get_future().wait();
  }
  EXPECT_FALSE(late(echo(asking(true))));
}

TEST_P(ServiceOf, CountsAnAnswerToOneWhoHasLeft) {
  std::promise<Answer<SetBool_Response>> asked;
  std::atomic<int> requests = 0;
  const auto server = serve_later<SetBool_Request, SetBool_Response>(
      *participant, "~/switch", [&](const auto& /*request*/, auto answer) {
        if (requests++ == 0) asked.set_value(std::move(answer));
      });
  auto leaving = std::make_unique<Client>(GetParam(), "node/switch");
  ASSERT_TRUE(eventually([&] { return leaving->is_matched(); }));
  leaving->send(asking(true));
  const auto answer = asked.get_future().get();
  leaving.reset();
  EXPECT_TRUE(eventually([&] { return !answer(echo(asking(true))); }));
  EXPECT_GE(statistics_of(*participant).dropped, 1U);
}

std::string name_of_parameter(const ::testing::TestParamInfo<Vendor>& info) {
  return name_of(info.param);
}
INSTANTIATE_TEST_SUITE_P(Vendors, ServiceOf, ::testing::ValuesIn(kAllVendors), name_of_parameter);

}  // namespace
}  // namespace rds::bus
