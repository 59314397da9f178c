// SPDX-License-Identifier: Apache-2.0
// Services of a kind on one bus: who is active, what is answered, what is told of a worker that hangs or
// fails.
#include "common/service/service_process.hpp"

#include <atomic>
#include <csignal>
#include <map>

#include <gmock/gmock.h>

#include "common/service/process/stop_signals.hpp"
#include "tests/support/test_domain.hpp"

namespace rds::service {
namespace {

using namespace std::chrono_literals;
using rds_msgs::msg::Command;
using rds_msgs::msg::CommandResult;
using rds_msgs::msg::ServiceStatus;
namespace Role = rds_msgs::msg::ServiceStatus_Constants;
using test::test_domain;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::unique_ptr<bus::Participant> join(const std::string& name) {
  return bus::Participant::create({.domain = test_domain(), .node_name = name, .loopback_only = true});
}

template <class Condition>
bool holds_within(std::chrono::seconds limit, Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(10ms);
  }
  return true;
}

std::atomic<bool> goes_on;  // of a worker that hangs

/// Answers `ping`, throws at `throw`, hangs at `hang` until `goes_on`.
class Probe : public Service {
 public:
  Probe(ServiceContext& context, int pace_at_first) : Service(context), pace(pace_at_first) {}
  int pace;
  void run(const std::stop_token& stop) override {
    while (wait(stop, [this] { return !commands_.locked_empty(); })) handle_commands();
  }

 protected:
  CommandOutcome execute(const std::string& verb, const std::string&) override {
    if (verb == "throw") throw std::runtime_error("thrown \xFF");
    if (verb == "hang") goes_on.wait(false);
    return verb == "throw" ? unknown_command(verb) : CommandOutcome{true, fmt::format("done at {}", pace)};
  }
};

/// `pace` may be set live, up to 9; `ping` tells it.
Configured read_probe(config::ConfigReader& reader) {
  int pace = 1;
  int constant = 0;
  reader.value("pace", pace, 0, 9);
  reader.value("constant", constant);
  reader.finish();
  return {.make = [pace](ServiceContext& context) { return std::make_unique<Probe>(context, pace); },
          .live = {"pace"},
          .apply = [pace](Service& service) { dynamic_cast<Probe&>(service).pace = pace; }};
}

/// What a process of the service "probe" does, on a thread.
class Running {
 public:
  explicit Running(std::uint64_t instance)
      : context_{"probe", *bus_, diagnostics_, test_domain(), instance},
        settings_("", YAML::Node(YAML::NodeType::Map), read_probe),
        process_(context_, settings_),
        thread_([this] { status_ = process_.run(); }) {}
  ~Running() {
    process_.request_stop();
    thread_.join();
    EXPECT_EQ(status_, 0);
  }
  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  std::unique_ptr<bus::Participant> bus_ = join("probe");
  Diagnostics diagnostics_;
  ServiceContext context_;
  Settings settings_;
  ServiceProcess process_;
  int status_ = -1;
  std::thread thread_;
};

class OnTheBus : public ::testing::Test {
 protected:
  void SetUp() override { goes_on = false; }
  static void SetUpTestSuite() {
    const sigset_t signals = stop_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  }

  std::optional<std::uint8_t> role_of(std::uint64_t instance) {
    for (const auto& [status, heard, clock_ahead_s] : peers_.present())
      if (status.instance() == instance) return status.role();
    return std::nullopt;
  }
  std::uint8_t level_of(std::uint64_t instance) {
    for (const auto& [status, heard, clock_ahead_s] : peers_.present())
      if (status.instance() == instance) return status.level();
    return kOk;
  }
  std::string message_of(std::uint64_t instance) {
    for (const auto& [status, heard, clock_ahead_s] : peers_.present())
      if (status.instance() == instance) return status.message();
    return "not present";
  }
  std::optional<CommandResult> ask(const std::string& verb, const std::string& argument = "") {
    send(++request_, verb, argument);
    if (!holds_within(5s, [&] { return answers(request_).has_value(); })) return std::nullopt;
    return answers(request_);
  }
  std::optional<CommandResult> answers(std::uint64_t request) {
    const std::lock_guard lock(mutex_);
    const auto found = results_.find(request);
    return found == results_.end() ? std::nullopt : std::optional(found->second);
  }
  void send(std::uint64_t request, const std::string& verb, const std::string& argument = "") {
    Command command;
    command.argument(argument);
    command.request_id(request);
    command.verb(verb);
    commands_.write(command);
  }
  static void go_on() {
    goes_on = true;
    goes_on.notify_all();
  }
  bool connected() {
    return holds_within(10s, [this] { return commands_.matched() > 0 && subscription_.matched() > 0; });
  }

  std::unique_ptr<bus::Participant> bus_ = join("observer");
  std::mutex mutex_;
  std::map<std::uint64_t, CommandResult> results_;
  std::uint64_t request_ = 1000;
  Peers peers_{*bus_};
  bus::Publisher<Command> commands_ = bus_->advertise<Command>("rds/command", bus::kLatchedEvery);
  bus::Subscription subscription_ =
      bus_->subscribe<CommandResult>("rds/command_result", bus::kCommand, [this](const auto& result) {
        const std::lock_guard lock(mutex_);
        results_[result->request_id()] = *result;
      });
};

TEST_F(OnTheBus, OfTwoOfAKindTheNewerWaitsAndTakesOver) {
  auto first = std::make_unique<Running>(2);
  ASSERT_TRUE(holds_within(10s, [&] { return role_of(2) == Role::ACTIVE; }));
  std::this_thread::sleep_for(1200ms);  // older by more than a status may be under way
  const Running second(1);
  EXPECT_TRUE(holds_within(10s, [&] { return role_of(1) == Role::STANDBY; }));
  EXPECT_TRUE(holds_within(10s, [&] { return level_of(1) == kError && level_of(2) == kError; }));
  EXPECT_EQ(role_of(2), Role::ACTIVE);
  first.reset();
  EXPECT_TRUE(holds_within(10s, [&] { return role_of(1) == Role::ACTIVE; }));
}

TEST_F(OnTheBus, AnExceptionIsAnAnswerAndTheWorkerGoesOn) {
  Running probe(1);
  ASSERT_TRUE(connected());
  const auto thrown = ask("throw");
  ASSERT_TRUE(thrown);
  EXPECT_FALSE(thrown->success());
  EXPECT_EQ(thrown->message(), "thrown \\xFF");
  const auto done = ask("ping");
  ASSERT_TRUE(done);
  EXPECT_TRUE(done->success());
  EXPECT_EQ(probe.diagnostics().counter("commands failed"), 1U);
}

TEST_F(OnTheBus, LiveSettingsChangeWithinTheirBoundsAndOthersNever) {
  const Running probe(1);
  ASSERT_TRUE(connected());
  const auto told = [this](const std::string& verb, const std::string& argument = "") {
    const auto result = ask(verb, argument);
    return result ? fmt::format("{}: {}", result->success(), result->message()) : "no answer";
  };
  EXPECT_EQ(told("ping"), "true: done at 1");
  EXPECT_EQ(told("set", "{pace: 7}"), "true: set");
  EXPECT_EQ(told("ping"), "true: done at 7");
  EXPECT_THAT(told("set", "{pace: 10}"), AllOf(HasSubstr("false"), HasSubstr("expected 0 … 9")));
  EXPECT_THAT(told("set", "{pace: fast}"), HasSubstr("false"));
  EXPECT_THAT(told("set", "{pace: 3, constant: 1}"),
              HasSubstr("'constant' does not change while the service runs, expected one of: pace"));
  EXPECT_THAT(told("set", "pace"), HasSubstr("expected a map"));
  EXPECT_EQ(told("ping"), "true: done at 7");
}

TEST_F(OnTheBus, EveryCommandIsAnsweredAlsoThoseThatFindNoRoom) {
  const Running probe(1);
  ASSERT_TRUE(connected());
  send(1, "hang");
  for (std::uint64_t request = 2; request <= 80; ++request) {
    send(request, "ping");
    std::this_thread::sleep_for(2ms);
  }
  EXPECT_TRUE(holds_within(10s, [&] { return answers(80).has_value(); })) << "while the worker hangs";
  go_on();
  ASSERT_TRUE(holds_within(10s, [&] {
    const std::lock_guard lock(mutex_);
    return results_.size() == 80;
  }));
  EXPECT_THAT(answers(80)->message(), HasSubstr("busy"));
  EXPECT_TRUE(answers(2)->success());
}

TEST_F(OnTheBus, AWorkerThatHangsIsAnError) {
  const Running probe(1);
  ASSERT_TRUE(connected());
  send(1, "hang");
  EXPECT_TRUE(holds_within(20s, [&] { return level_of(1) == kError; }))
      << "while it hangs: " << message_of(1);
  go_on();
  EXPECT_TRUE(holds_within(20s, [&] { return level_of(1) == kOk; })) << "when it goes on: " << message_of(1);
}

TEST_F(OnTheBus, APeerOfAnotherVersionIsNamed) {
  bus::TypeOps other = bus::type_ops<Command>();
  other.type_hash = "RIHS01_" + std::string(64, '5');
  const auto peer = join("peer");
  const auto publisher = peer->make_publisher("rds/command", other, bus::kCommand);
  const Running probe(1);
  ASSERT_TRUE(connected());
  EXPECT_TRUE(holds_within(10s, [&] { return level_of(1) == kWarn; }));
  const auto status = ask("status");
  ASSERT_TRUE(status);
  EXPECT_THAT(status->message(), HasSubstr("rds/command: written by 01."));
  EXPECT_THAT(status->message(), HasSubstr(" as " + other.type_hash + ", here it is RIHS01_"));
}

TEST_F(OnTheBus, TextsThatAreNoUtf8AreToldInTheStatus) {
  Running probe(1);
  ASSERT_TRUE(connected());
  probe.diagnostics().reject("camera", Rejection::kInvalid, "encoding '\xFF\xFF'");
  probe.diagnostics().counter("name \xFF") = 1;
  const auto status = ask("status");
  ASSERT_TRUE(status);
  EXPECT_THAT(status->message(), HasSubstr("rejected camera: invalid"));
}

}  // namespace
}  // namespace rds::service
