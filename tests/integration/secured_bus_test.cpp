// SPDX-License-Identifier: Apache-2.0
// A secured domain, with real processes on either vendor: who has no certificate sees and changes nothing,
// who has one does what its permissions say.
#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "common/geometry/trajectory.hpp"
#include "services/mapper/reader/map_follower.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

constexpr const char* kDomain = "28";
constexpr int kShort = 6;    // seconds in which a peer that may hear something does
constexpr int kEnough = 40;  // also on a machine that is busy

std::vector<std::string> operator+(std::vector<std::string> left, const std::vector<std::string>& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

std::string make_secured(const std::filesystem::path& folder) {
  const ProcessResult made = run_process({rds(), "secure", "init", folder.string()}, 20s);
  EXPECT_EQ(made.status, 0) << made.standard_error;
  return folder.string();
}

class SecuredBus : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    make_small_dataset(place_ / "data", 30);
    write_text(place_ / "detections.jsonl", "");
    write_text(place_ / "rds-detector.yaml",
               "detections_file: " + (place_ / "detections.jsonl").string() + "\n");
    write_text(place_ / "poses.txt", standing_poses());
    write_text(place_ / "rds-tracker.yaml", "poses_file: " + (place_ / "poses.txt").string() + "\n");
    secured_ = make_secured(place_ / "secured");
  }

  /// A camera that stands for five minutes from the recording's first stamp on, so that there is a map.
  static std::string standing_poses() {
    std::string text;
    for (int i = 0; i < 300 * 30; ++i) text += fmt::format("{:.6f} 0 0 0 0 0 0 1\n", 10 + i / 30.0);
    return text;
  }

  std::vector<std::string> on_the_bus() const {
    return {"--bus", GetParam(), "--domain", kDomain, "--loopback"};
  }

  /// The five services and a player of recordings.
  /// @param secure  {"--secure", FOLDER}, or nothing.
  void start(const std::vector<std::string>& secure) {
    for (const char* name :
         {"rds-tracker", "rds-detector", "rds-transformer", "rds-mapper", "rds-loop-closer"}) {
      std::vector<std::string> line{std::string(RDS_BIN_DIR) + "/" + name};
      const std::filesystem::path config = place_ / (std::string(name) + ".yaml");
      if (exists(config)) line = line + std::vector<std::string>{"--config", config};
      services_.push_back(std::make_unique<Process>(line + on_the_bus() + secure));
    }
    for (const auto& service : services_)
      ASSERT_TRUE(service->wait_for_output("version", 20s)) << service->standard_error();
    player_ = std::make_unique<Process>(std::vector<std::string>{rds(), "play", place_ / "data", "--loop"} +
                                        on_the_bus() + secure);
  }

  /// What somebody hears who tries to give the tracker this command all the time, until he has heard all that
  /// he may or for so many seconds.
  json report(const std::string& verb, const std::vector<std::string>& credentials, int seconds) {
    const ProcessResult peer = run_process(std::vector<std::string>{RDS_BIN_DIR "/secured_peer", GetParam(),
                                                                    kDomain, std::to_string(seconds), verb} +
                                               credentials,
                                           60s);
    EXPECT_EQ(peer.status, 0) << peer.standard_error;
    return json::parse(peer.standard_output);
  }

  ProcessResult echo(const std::string& topic, const std::vector<std::string>& secure) {
    return run_process(
        std::vector<std::string>{rds(), "topic", "echo", topic, "--count", "1", "--timeout", "5"} +
            on_the_bus() + secure,
        60s);
  }

  /// The tracker answers, and tracks nothing.
  void expect_paused(const std::vector<std::string>& credentials) {
    const json heard = report("status", credentials, 2 * kShort);
    EXPECT_GT(heard["samples"]["rds/command_result"], 0);
    EXPECT_EQ(heard["samples"]["rds/tracking_state"], 0);
  }

  void expect_all_alive() {
    for (const auto& service : services_) EXPECT_TRUE(service->running()) << service->standard_error();
  }

  TemporaryFolder place_;
  std::string secured_;
  std::vector<std::unique_ptr<Process>> services_;
  std::unique_ptr<Process> player_;
};

/// What the next test relies on: this peer hears and commands where nothing forbids it.
TEST_P(SecuredBus, OnAnOpenBusAnybodyHearsAndCommands) {
  start({});
  const json heard = report("status", {}, kEnough);
  for (const auto& [topic, samples] : heard["samples"].items()) EXPECT_GT(samples, 0) << topic;
  report("pause", {}, kShort);
  expect_paused({});
}

TEST_P(SecuredBus, AStrangerHearsNothingAndChangesNothing) {
  start({"--secure", secured_});
  for (const auto& [topic, samples] : report("pause", {}, kShort)["samples"].items())
    EXPECT_EQ(samples, 0) << topic;
  const std::string foreign = make_secured(place_ / "foreign");
  for (const auto& [topic, samples] : report("pause", {foreign, "operator"}, kShort)["samples"].items())
    EXPECT_EQ(samples, 0) << topic << ", with another authority's certificate";
  const ProcessResult echoed = echo("rds/tracking_state", {});
  EXPECT_EQ(echoed.status, 1) << echoed.standard_output;
  EXPECT_EQ(echoed.standard_output, "");
  expect_all_alive();
  EXPECT_GT(report("status", {secured_, "reader"}, kEnough)["samples"]["rds/tracking_state"], 0)
      << "nobody has paused it";
}

TEST_P(SecuredBus, AReaderOnAnotherMachineAsksForTheMap) {
  start({"--secure", secured_});
  const auto bus =
      bus::Participant::create({.vendor = bus::vendor_from_name(GetParam()),
                                .domain = std::stoi(kDomain),
                                .node_name = "reader",
                                .loopback_only = true,
                                .credentials = bus::read_credentials(secured_, "reader").value()});
  service::Diagnostics diagnostics;
  service::ServiceContext context{"reader", *bus, diagnostics};
  constexpr std::uint64_t kElsewhere = 1;
  const mapper::MapFollower reader(context, kElsewhere);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(kEnough);
  while (reader.map().place().revision == 0 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(50ms);
  EXPECT_GT(reader.map().place().revision, 0U);
  EXPECT_EQ(reader.where(), mapper::MapFollower::Where::kElsewhere);
}

TEST_P(SecuredBus, AReaderReadsTheMapAndDoesNotCommand) {
  start({"--secure", secured_});
  const json heard = report("pause", {secured_, "reader"}, kEnough);
  EXPECT_THAT(heard["refused"],
              UnorderedElementsAre("camera/color/image_raw", "rds/command_result", "rds/command"));
  EXPECT_GT(heard["samples"]["rds/map/full"], 0);
  EXPECT_GT(heard["samples"]["rds/tracking_state"], 0);
  const ProcessResult echoed = echo("rds/map/full", {"--secure", secured_, "--identity", "reader"});
  EXPECT_EQ(echoed.status, 0) << echoed.standard_error;
  const ProcessResult refused =
      echo("camera/color/image_raw", {"--secure", secured_, "--identity", "reader"});
  EXPECT_EQ(refused.status, 2) << refused.standard_output;
  EXPECT_THAT(refused.standard_error, HasSubstr("the permissions of 'reader' must allow"));
}

TEST_P(SecuredBus, AnOperatorHearsAllAndCommands) {
  start({"--secure", secured_});
  const json heard = report("status", {secured_, "operator"}, kEnough);
  EXPECT_TRUE(heard["refused"].empty()) << heard;
  for (const auto& [topic, samples] : heard["samples"].items()) EXPECT_GT(samples, 0) << topic;
  report("pause", {secured_, "operator"}, kShort);
  expect_paused({secured_, "operator"});
  expect_all_alive();
}

/// Zenoh's strangers are in zenoh_secured_test.py.
class SecuredDds : public SecuredBus {};

/// PyPI's Cyclone DDS knows no DDS Security, which makes it a stranger that nobody here has written.
TEST_P(SecuredDds, AForeignClientHearsNothing) {
  const char* python = std::getenv("RDS_PYTHON");
  const std::string interpreter = python == nullptr ? "python3" : python;
  if (run_process({interpreter, "-c", "import cyclonedds.idl"}, 20s).status != 0)
    GTEST_SKIP() << "no Python package cyclonedds (set RDS_PYTHON)";
  start({"--secure", secured_});
  const ProcessResult client = run_process(
      {interpreter, "-B", RDS_SOURCE_DIR "/tests/integration/bus/external_client.py", "--domain", kDomain,
       "--seconds", "6", "--loopback", "--topic", "rds/odometry", "--topic", "rds/map/full"},
      60s);
  EXPECT_EQ(client.status, 1) << client.standard_output << client.standard_error;
  const json counts = json::parse(client.standard_output)["counts"];
  EXPECT_EQ(counts["rds/odometry"], 0);
  EXPECT_EQ(counts["rds/map/full"], 0);
  expect_all_alive();
}

/// With what a robot senses beside pictures: an IMU that lies still, and odometry that follows the truth.
TEST_P(SecuredBus, ARunGivesTheSameBytesAsOnAnOpenBus) {
  RDS_REQUIRE_SHARED("data/7scenes_kitchen");
  make_excerpt(shared() / "data/7scenes_kitchen", place_ / "kitchen", 60);
  const auto stamps = geometry::read_trajectory(place_ / "kitchen/groundtruth.txt").value();
  std::string imu;
  for (const auto& pose : stamps)
    imu += fmt::format("{:.6f} 0 -9.81 0 0 0 0\n", 1e-9 * static_cast<double>(pose.stamp_ns));
  write_text(place_ / "kitchen/imu.txt", imu);
  for (const auto& [out, secure] : {std::pair<std::string, std::vector<std::string>>{"open", {}},
                                    {"secured_run", {"--secure", secured_}}}) {
    const ProcessResult done =
        run(place_ / "kitchen", place_ / out,
            std::vector<std::string>{"--rate", "max", "--bus", GetParam(), "--imu",
                                     "--odometry=" + (place_ / "kitchen/groundtruth.txt").string()} +
                secure);
    ASSERT_EQ(done.status, 0) << done.standard_error;
    EXPECT_THAT(read_text(place_ / out / "log/rds-tracker.log"), Not(HasSubstr("has come on")));
  }
  for (const char* file :
       {"trajectory.txt", "detections.jsonl", "predictions.jsonl", "objects.json", "map.ot"})
    EXPECT_TRUE(read_text(place_ / "open" / file) == read_text(place_ / "secured_run" / file)) << file;
}

INSTANTIATE_TEST_SUITE_P(On, SecuredBus, ::testing::ValuesIn(all_vendor_names()), given_name);
INSTANTIATE_TEST_SUITE_P(On, SecuredDds, ::testing::Values("fastdds", "cyclonedds"),
                         [](const auto& each) { return each.param; });

class BadCredentials : public ::testing::Test {
 protected:
  void SetUp() override { secured_ = make_secured(place_ / "secured"); }

  /// One sentence with these words, and exit status 2.
  static void expect_refused(const std::vector<std::string>& command, const std::string& words) {
    const ProcessResult result = run_process(command, 30s);
    EXPECT_EQ(result.status, 2) << result.standard_error;
    EXPECT_THAT(result.standard_error, HasSubstr(words));
    EXPECT_EQ(std::ranges::count(result.standard_error, '\n'), 1) << result.standard_error;
  }
  std::vector<std::string> tracker() const {
    return {RDS_BIN_DIR "/rds-tracker", "--domain", kDomain, "--loopback", "--secure", secured_};
  }

  TemporaryFolder place_;
  std::string secured_;
};

TEST_F(BadCredentials, OfAServiceAreOneSentence) {
  write_text(place_ / "secured/tracker/permissions.p7s",
             read_text(place_ / "secured/mapper/permissions.p7s"));
  expect_refused(tracker(), "tracker/permissions.p7s: are of 'CN=mapper,O=RDS-SLAM'");
  write_text(place_ / "secured/tracker/cert.pem", "-----BEGIN");
  expect_refused(tracker(), "tracker/cert.pem: is damaged");
  std::filesystem::remove_all(secured_);
  expect_refused(tracker(), "secured: no such folder");
}

TEST_F(BadCredentials, OfAToolAreOneSentence) {
  const std::vector<std::string> list{rds(), "topic", "list", "--domain", kDomain, "--loopback", "--secure"};
  expect_refused(list + std::vector<std::string>{secured_, "--identity", "nobody"}, "nobody: no such folder");
  make_secured(place_ / "foreign");
  write_text(place_ / "secured/ca.pem", read_text(place_ / "foreign/ca.pem"));
  expect_refused(list + std::vector<std::string>{secured_}, "operator/cert.pem: was not signed by");
}

TEST_F(BadCredentials, AMixtureOfVendorsIsRefused) {
  make_small_dataset(place_ / "data", 3);
  expect_refused({rds(), "run", "--dataset", place_ / "data", "--out", place_ / "out", "--secure", secured_,
                  "--bus", "tracker=cyclonedds"},
                 "expected one vendor for all of a secured domain");
}

TEST_F(BadCredentials, AnExistingFolderIsLeftAlone) {
  const std::string before = read_text(place_ / "secured/ca.pem");
  expect_refused({rds(), "secure", "init", secured_}, "secured: exists");
  EXPECT_EQ(read_text(place_ / "secured/ca.pem"), before);
}

TEST_F(BadCredentials, TheTwoHighestDomainsCannotBeSecured) {
  for (const char* vendor : {"fastdds", "cyclonedds"})
    expect_refused(
        {RDS_BIN_DIR "/rds-tracker", "--bus", vendor, "--domain", "231", "--loopback", "--secure", secured_},
        "DDS domain 231, expected 0 to 230 for a secured one");
}

}  // namespace
}  // namespace rds::test
