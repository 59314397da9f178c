// SPDX-License-Identifier: Apache-2.0
// Commands that name what they should not: the services answer each, go on, and stop when told to.
#include <csignal>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "common/bus/participant.hpp"
#include "common/commander/commander.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/rds/topology/topology.hpp"

namespace rds::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

constexpr int kDomain = 160;
constexpr long kMaxKilobytes = 400'000;  // of a service that reads no gigabytes
const std::vector<std::string> kServices{run::kTracker, run::kMapper, run::kLoopCloser};

/// Resident memory [kB].
long memory_of(pid_t pid) {
  std::istringstream status(read_text(fs::path("/proc") / std::to_string(pid) / "status"));
  std::string word;
  while (status >> word && word != "VmRSS:") {
  }
  long kilobytes = 0;
  status >> kilobytes;
  return kilobytes;
}

/// Three services with a folder of maps, and somebody who may command them.
class MapCommands : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    for (const std::string& service : kServices)
      processes[service] = std::make_unique<Process>(
          std::vector<std::string>{(fs::path(rds()).parent_path() / service).string(), "--bus", GetParam(),
                                   "--domain", std::to_string(kDomain), "--loopback"},
          Process::Environment{{"RDS_MAPS_DIR", maps.path().string()}});
    const auto all_answer = [&] { return commander.ask_status(3, {}, 500ms).size() == 3; };
    for (int i = 0; i < 60 && !all_answer(); ++i) {
    }
    ASSERT_TRUE(all_answer());
  }
  commander::CommandReply ask(const std::string& service, const std::string& verb,
                              const std::string& argument) {
    return commander.ask(service, verb, argument, {}, 10s)
        .value_or(commander::CommandReply{false, "no answer"});
  }
  void expect_refused(const std::string& service, const std::string& verb, const std::string& argument) {
    const auto reply = ask(service, verb, argument);
    EXPECT_FALSE(reply.success) << service << " " << verb << " " << argument;
    EXPECT_NE(reply.message, "no answer") << service << " " << verb << " " << argument;
    EXPECT_LT(memory_of(processes[service]->pid()), kMaxKilobytes)
        << service << " " << verb << " " << argument;
  }

  TemporaryFolder maps;
  TemporaryFolder outside;
  std::unique_ptr<bus::Participant> bus =
      bus::Participant::create({.vendor = bus::vendor_from_name(GetParam()),
                                .domain = kDomain,
                                .node_name = "commander",
                                .loopback_only = true});
  commander::Commander commander{*bus};
  std::map<std::string, std::unique_ptr<Process>> processes;
};

TEST_P(MapCommands, ThatNameDevicesPipesLinksAndPathsAreRefusedAndTheServicesGoOn) {
  ASSERT_EQ(mkfifo((outside / "pipe").c_str(), 0600), 0);
  fs::create_directories(maps / "pipe");
  ASSERT_EQ(mkfifo((maps / "pipe" / "map.rds").c_str(), 0600), 0);
  fs::create_directories(maps / "zero");
  fs::create_symlink("/dev/zero", maps / "zero" / "map.rds");
  fs::create_symlink("/dev/zero", maps / "zero" / "map.ot");
  fs::create_symlink(outside.path(), maps / "link");
  fs::create_directories(maps / "closed" / "map.rds");
  for (const std::string& service : kServices) {
    for (const std::string& name :
         std::vector<std::string>{"/dev/zero", (outside / "pipe").string(), "pipe", "zero", "link", "closed",
                                  "none", "..", "", std::string(5000, 'x')})
      expect_refused(service, "load", name);
    for (const std::string& name :
         std::vector<std::string>{outside.path().string(), "link", "../x", "", "{}",
                                  R"({"name": "x", "id": "../y", "parts": ["mapper"]})"})
      expect_refused(service, "save", name);
    EXPECT_TRUE(fs::exists(outside / "pipe"));
  }
  expect_refused(run::kMapper, "finish", R"({"poses_revision": "x"})");
  EXPECT_EQ(std::distance(fs::directory_iterator(outside.path()), {}), 1) << "nothing but the pipe";
  EXPECT_EQ(commander.ask_status(3, {}, 5s).size(), 3U);
  for (auto& [service, process] : processes) {
    process->send(SIGTERM);
    EXPECT_EQ(process->wait(3s), 0) << service;
  }
}

TEST_P(MapCommands, PartsOfASaveArePublishedTogether) {
  const std::string order =
      R"({"name": "kitchen", "id": "one", "parts": ["tracker", "mapper", "loop_closer"]})";
  for (const std::string& service : {run::kTracker, run::kMapper}) {
    const auto reply = ask(service, "save", order);
    ASSERT_TRUE(reply.success) << reply.message;
    EXPECT_EQ(nlohmann::json::parse(reply.message)["state"], "waits");
    EXPECT_FALSE(fs::exists(maps / "kitchen"));
  }
  const auto last = ask(run::kLoopCloser, "save", order);
  EXPECT_EQ(nlohmann::json::parse(last.message)["state"], "published") << last.message;
  std::vector<std::string> files;
  for (const auto& file : fs::directory_iterator(maps / "kitchen")) files.push_back(file.path().filename());
  EXPECT_THAT(files, UnorderedElementsAre("map.rds", "map.ot", "objects.json", "grid.pgm", "grid.yaml"));
  for (const std::string& service : kServices) {
    const auto loaded = ask(service, "load", "kitchen");
    EXPECT_TRUE(loaded.success) << service << ": " << loaded.message;
  }
}

TEST_P(MapCommands, OfTheCommandLineNameMaps) {
  const auto command = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {rds(), "map"});
    return run_process(words, 60s, {{"RDS_MAPS_DIR", maps.path().string()}});
  };
  const std::vector<std::string> on_the_bus{"--bus", GetParam(), "--domain", std::to_string(kDomain),
                                            "--loopback"};
  const auto with_bus = [&](std::vector<std::string> words) {
    words.insert(words.end(), on_the_bus.begin(), on_the_bus.end());
    return command(words);
  };
  const auto saved = with_bus({"save", "kitchen"});
  ASSERT_EQ(saved.status, 0) << saved.standard_error;
  EXPECT_THAT(saved.standard_output, AllOf(HasSubstr("rds-mapper: map of"),
                                           HasSubstr("saved as kitchen in " + (maps / "kitchen").string())));
  EXPECT_THAT(command({"list"}).standard_output,
              AllOf(HasSubstr("kitchen"), HasSubstr("tracker, mapper, loop_closer")));
  EXPECT_EQ(with_bus({"load", "kitchen"}).status, 0);
  EXPECT_EQ(with_bus({"load", "none"}).status, 1);
  EXPECT_EQ(with_bus({"save", (outside / "map.rds").string()}).status, 0);
  EXPECT_EQ(read_text(outside / "map.rds"), read_text(maps / "kitchen" / "map.rds"));
  EXPECT_THAT(command({"list"}).standard_output, testing::Not(HasSubstr("for-rds-map-save")));
}

INSTANTIATE_TEST_SUITE_P(Vendors, MapCommands, ::testing::ValuesIn(all_vendor_names()), given_name);

}  // namespace
}  // namespace rds::test
