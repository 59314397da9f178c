// SPDX-License-Identifier: Apache-2.0
// `rds run --hosts` on three machines, as its users start it: one folder of results, as of a run on one
// machine.
#include <optional>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "common/bus/participant.hpp"
#include "tests/hosts/host_network.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/shared_data.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr auto kLimit = 200s;
const std::string kFrames = "90";

/// Names of all files of a run.
std::set<std::string> files_of(const fs::path& out) {
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(out))
    if (entry.is_regular_file()) files.insert(fs::relative(entry.path(), out).string());
  return files;
}

nlohmann::json summary_of(const fs::path& out) {
  return nlohmann::json::parse(read_text(out / "summary.json"));
}

class HostsRun : public testing::TestWithParam<bus::Vendor> {
 protected:
  void SetUp() override {
    if (const auto reason = HostNetwork::why_not(); !reason.empty()) GTEST_SKIP() << reason;
    network_.emplace(std::vector<std::string>{"A", "B", "C"}, Link{});
    write_text(hosts_, "domain: 3\nmachines:\n  robot: {address: " + network_->address("A") +
                           ", services: [tracker]}\n  desk: {address: " + network_->address("B") +
                           ", services: [detector, transformer]}\n  nas: {address: " +
                           network_->address("C") + ", services: [mapper, loop_closer]}\n");
  }

  /// On a host, as this machine of the file.
  std::vector<std::string> on(const std::string& host, const std::string& machine,
                              const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command{rds(),       "run",   "--hosts", hosts_.string(),
                                     "--machine", machine, "--bus",   bus::name_of(GetParam())};
    command.insert(command.end(), more.begin(), more.end());
    return network_->on(host, command);
  }
  std::vector<std::string> with_camera(const fs::path& out, const std::string& rate) const {
    return on("A", "robot",
              {"--dataset", recording_.string(), "--out", out.string(), "--frames", kFrames, "--rate", rate});
  }

  void run_on_three(const fs::path& out, const std::string& rate);

  TemporaryFolder folder_;
  fs::path hosts_ = folder_ / "hosts.yaml";
  fs::path temporary_ = folder_ / "tmp";
  fs::path recording_ = recording_with_people().folder;
  std::optional<HostNetwork> network_;
};

/// One run on the three machines, each of which ends well and leaves nothing where it ran.
void HostsRun::run_on_three(const fs::path& out, const std::string& rate) {
  fs::create_directories(temporary_);
  Process desk(on("B", "desk"), {{"TMPDIR", temporary_}});
  Process nas(on("C", "nas"), {{"TMPDIR", temporary_}});
  const auto robot = run_process(with_camera(out, rate), kLimit);
  ASSERT_EQ(robot.status, 0) << robot.standard_error << desk.standard_error() << nas.standard_error();
  EXPECT_EQ(desk.wait(20s), 0) << desk.standard_error();
  EXPECT_EQ(nas.wait(20s), 0) << nas.standard_error();
  EXPECT_TRUE(fs::is_empty(temporary_));
}

TEST_P(HostsRun, LeavesOneFolderWithTheFilesOfOneMachine) {
  const fs::path one = folder_ / "one";
  const fs::path three = folder_ / "three";
  ASSERT_EQ(
      run(recording_, one, {"--frames", kFrames, "--rate", "max", "--bus", bus::name_of(GetParam())}, kLimit)
          .status,
      0);
  ASSERT_NO_FATAL_FAILURE(run_on_three(three, "1.0"));
  EXPECT_EQ(files_of(three), files_of(one));
  const auto summary = summary_of(three);
  EXPECT_EQ(summary["processes"].size(), 5U);
  for (const auto& [service, process] : summary["processes"].items())
    EXPECT_GT(process["cpu_s"].get<double>(), 0) << service;
  EXPECT_EQ(summary["frames"]["dropped"], 0);
  EXPECT_EQ(run_process({rds(), "map", "info", "--map", (three / "map.rds").string()}, kLimit).status, 0);
}

TEST_P(HostsRun, GivesTheSameBytesEveryTimeAtRateMax) {
  for (const char* out : {"first", "second"}) ASSERT_NO_FATAL_FAILURE(run_on_three(folder_ / out, "max"));
  for (const char* file : {"trajectory.txt", "trajectory_optimized.txt", "predictions.jsonl",
                           "detections.jsonl", "objects.json", "map.ot"})
    EXPECT_TRUE(read_text(folder_ / "first" / file) == read_text(folder_ / "second" / file)) << file;
}

TEST_P(HostsRun, EndsWithASentenceWhereTheFilesDiffer) {
  Process nas(on("C", "nas"));
  ASSERT_TRUE(nas.wait_for_output("waiting", 20s));
  write_text(hosts_, "machines:\n  robot: {address: " + network_->address("A") +
                         ", services: [tracker]}\n  nas: {address: " + network_->address("C") +
                         ", services: [detector, transformer, mapper, loop_closer]}\ndomain: 3\n");
  const auto robot = run_process(with_camera(folder_ / "out", "max"), kLimit);
  EXPECT_EQ(robot.status, 2);
  EXPECT_THAT(robot.standard_error, HasSubstr("nas: the hosts file of nas has rds-loop-closer, rds-mapper"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  EXPECT_TRUE(nas.running()) << "it may have a right run after a wrong one";
}

TEST_P(HostsRun, EndsOnEveryMachineWhenItIsInterrupted) {
  Process desk(on("B", "desk"));
  Process nas(on("C", "nas"));
  Process robot(with_camera(folder_ / "out", "0.2"));
  ASSERT_TRUE(nas.wait_for_output("begun", 60s));
  std::this_thread::sleep_for(2s);
  robot.send(SIGINT);
  EXPECT_EQ(robot.wait(20s), 1);
  EXPECT_EQ(desk.wait(20s), 1);
  EXPECT_EQ(nas.wait(20s), 1);
  EXPECT_THAT(nas.standard_error(), HasSubstr("the run has failed where the camera is"));
}

INSTANTIATE_TEST_SUITE_P(Each, HostsRun, testing::ValuesIn(kAllVendors), vendor_name);

}  // namespace
}  // namespace rds::test
