// SPDX-License-Identifier: Apache-2.0
// Who notices that a service hangs, is stopped, missing or there twice: systemd, the process itself, `rds status`.
#include <algorithm>
#include <thread>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/integration/run_support.hpp"
#include "tests/support/notify_socket.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::string kDomain = "170";

std::vector<std::string> command(const std::string& program, const std::vector<std::string>& arguments = {}) {
  std::vector<std::string> words{std::string(RDS_BIN_DIR) + "/" + program, "--domain", kDomain, "--loopback"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

/// A service that is started again, under the eyes of a supervisor, until it works.
struct Supervised {
  explicit Supervised(const std::string& program, const std::vector<std::string>& arguments = {})
      : process(command(program, arguments), {{"NOTIFY_SOCKET", socket.path()}}) {}
  NotifySocket socket;
  Process process;
};

std::vector<std::string> hang_after(const TemporaryFolder& folder, const std::string& seconds) {
  write_text(folder / "hanging.yaml", "hang_after_s: " + seconds + "\n");
  return {"--config", (folder / "hanging.yaml").string()};
}

TEST(Supervision, AServiceSaysThatItIsReadyThenAliveThenStopping) {
  Supervised transformer("rds-transformer");
  EXPECT_THAT(transformer.socket.read_until("READY", 20s), Contains("READY=1"));
  const auto alive = transformer.socket.read_for(3500ms);
  EXPECT_GE(std::ranges::count(alive, "WATCHDOG=1"), 2);
  transformer.process.send(SIGTERM);
  EXPECT_THAT(transformer.socket.read_until("STOPPING", 10s), Contains("STOPPING=1"));
  EXPECT_EQ(transformer.process.wait(10s), 0);
}

TEST(Supervision, StandByIsReadyAndSaysWhy) {
  Supervised first("rds-transformer");
  ASSERT_THAT(first.socket.read_until("STATUS=active", 20s), Contains(StartsWith("STATUS=active")));
  std::this_thread::sleep_for(1500ms);  // older by more than a status may be under way
  Supervised second("rds-transformer");
  EXPECT_THAT(second.socket.read_until("READY", 20s), Contains("READY=1"));
  EXPECT_THAT(second.socket.read_until("STATUS=stand-by: ", 20s),
              Contains(HasSubstr("another rds-transformer is in this domain")));
  EXPECT_THAT(second.socket.read_for(2500ms), Contains("WATCHDOG=1"));
}

TEST(Supervision, AServiceWhoseWorkerHangsIsNotAlive) {
  const TemporaryFolder folder;
  Supervised hanging("hanging_service", hang_after(folder, "1"));
  const auto before = hanging.socket.read_until("has been silent", 30s);
  EXPECT_THAT(before, Contains("WATCHDOG=1"));
  ASSERT_THAT(before.back(), HasSubstr("STATUS=active: the worker has been silent for"));
  EXPECT_THAT(hanging.socket.read_for(3s), Not(Contains("WATCHDOG=1")));
  EXPECT_TRUE(hanging.process.running());
}

TEST(Supervision, AServiceThatHangsEndsItselfWhereThatIsAskedFor) {
  const TemporaryFolder folder;
  auto arguments = hang_after(folder, "0.5");
  arguments.insert(arguments.end(), {"--exit-when-hung", "2"});
  Process hanging(command("hanging_service", arguments));
  EXPECT_EQ(hanging.wait(30s), 1);
  EXPECT_THAT(hanging.standard_error(), HasSubstr("ended: nothing has been heard of the worker for 2 s"));
}

TEST(Supervision, AServiceThatWasStoppedForLongerThanItMayHangGoesOn) {
  Process transformer(command("rds-transformer", {"--exit-when-hung", "2"}));
  ASSERT_TRUE(transformer.wait_for_output("version", 20s));
  std::this_thread::sleep_for(1s);
  transformer.send(SIGSTOP);
  std::this_thread::sleep_for(4s);
  transformer.send(SIGCONT);
  EXPECT_EQ(transformer.wait(4s), std::nullopt) << transformer.standard_error();
}

class Status : public ::testing::Test {
 protected:
  /// Listens for up to 20 s until all is well, or for the default time.
  static ProcessResult status(const std::vector<std::string>& names, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{rds(), "status", "--domain", kDomain, "--loopback"};
    for (const auto& name : names) words.insert(words.end(), {"--service", name});
    words.insert(words.end(), more.begin(), more.end());
    return run_process(words, 60s);
  }
  static ProcessResult until_well(const std::vector<std::string>& names) {
    return status(names, {"--wait", "20"});
  }
};

TEST_F(Status, ServicesThatWorkAreWell) {
  const Process mapper(command("rds-mapper"));
  const Process transformer(command("rds-transformer"));
  const auto shown = until_well({"mapper", "transformer"});
  EXPECT_EQ(shown.status, 0) << shown.standard_error;
  EXPECT_THAT(shown.standard_output, HasSubstr("rds-mapper"));
  EXPECT_THAT(shown.standard_output, HasSubstr("active"));
  const auto all = status({}, {"--json"});
  EXPECT_EQ(all.status, 1);
  const auto json = nlohmann::json::parse(all.standard_output);
  EXPECT_FALSE(json["well"]);
  EXPECT_EQ(json["services"].size(), 2U) << json;
  EXPECT_EQ(json["problems"].size(), 3U) << json;
  EXPECT_THAT(all.standard_error, HasSubstr("rds-detector is not there"));
}

TEST_F(Status, SeesAProcessThatIsStoppedAndOneThatWasKilled) {
  Process mapper(command("rds-mapper"));
  ASSERT_EQ(until_well({"mapper"}).status, 0);
  mapper.send(SIGSTOP);
  const auto stopped = status({"mapper"});
  EXPECT_EQ(stopped.status, 1) << stopped.standard_output;
  EXPECT_THAT(stopped.standard_error, HasSubstr("rds-mapper"));
  mapper.send(SIGCONT);
  EXPECT_EQ(until_well({"mapper"}).status, 0);
  mapper.kill();
  EXPECT_EQ(status({"mapper"}).status, 1);
}

TEST_F(Status, SeesTwoOfAKind) {
  const Process first(command("rds-transformer"));
  ASSERT_EQ(until_well({"transformer"}).status, 0);
  std::this_thread::sleep_for(1500ms);
  Supervised second("rds-transformer");
  second.socket.read_until("STATUS=stand-by: ", 20s);
  const auto shown = status({"transformer"});
  EXPECT_EQ(shown.status, 1);
  EXPECT_THAT(shown.standard_output, HasSubstr("stand-by"));
  EXPECT_THAT(shown.standard_error, HasSubstr("rds-transformer is there 2 times, 1 of them active"));
}

TEST_F(Status, SeesAWorkerThatHangs) {
  const TemporaryFolder folder;
  Supervised hanging("hanging_service", hang_after(folder, "1"));
  ASSERT_EQ(until_well({"hanging"}).status, 0);
  ASSERT_THAT(hanging.socket.read_until("has been silent", 30s).back(), HasSubstr("has been silent"));
  const auto shown = status({"hanging"});
  EXPECT_EQ(shown.status, 1) << shown.standard_output;
  EXPECT_THAT(shown.standard_error, HasSubstr("the worker has been silent for"));
}

}  // namespace
}  // namespace rds::test
