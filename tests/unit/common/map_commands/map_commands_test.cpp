// SPDX-License-Identifier: Apache-2.0
#include "common/map_commands/map_commands.hpp"

#include <future>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::map_commands {
namespace {

using namespace std::chrono_literals;
using service::CommandOutcome;
using ::testing::HasSubstr;

class MapCommandsTest : public ::testing::Test {
 protected:
  service::PendingCommand command(const std::string& verb, const std::string& argument) {
    return {verb, argument, [this](const CommandOutcome& outcome) { answers.push_back(outcome); }, 7};
  }
  void save(const std::string& argument) {
    commands->save(
        command("save", argument),
        [] { return map_file::MapPart{"mapper", {{"mapper", {1}}}, {{"map.ot", {2}}}}; }, "a map");
  }
  void load(const std::string& name) {
    commands->load(command("load", name),
                   [this](const map_file::Folder& map, const map_file::FileLimits& limits)
                       -> tl::expected<MapCommands::Completion, std::string> {
                     if (block.valid()) block.wait();
                     const auto saved = map_file::read_saved_map(map, {"mapper"}, limits);
                     if (!saved) return tl::unexpected(saved.error());
                     return [this]() -> CommandOutcome {
                       ++taken_over;
                       return {true, "taken over"};
                     };
                   });
  }
  /// What a worker does, until so many answers are there or nothing comes for 20 s.
  void work(std::size_t expected_answers) {
    while (answers.size() < expected_answers)
      if (mailbox.wait_for({}, 20s, [this] { return commands->locked_ready(); }))
        commands->settle();
      else
        break;
    ASSERT_EQ(answers.size(), expected_answers);
  }

  test::TemporaryFolder maps;
  concurrency::Mailbox mailbox;
  std::vector<CommandOutcome> answers;
  std::shared_future<void> block;
  int taken_over = 0;
  store::MapsConfig config{.maps_dir = maps.path().string()};
  std::unique_ptr<MapCommands> commands = std::make_unique<MapCommands>(mailbox, config, "mapper");
};

TEST_F(MapCommandsTest, WhatWasSavedIsLoadedByItsName) {
  save("kitchen");
  work(1);
  ASSERT_TRUE(answers[0].success) << answers[0].message;
  const auto json = nlohmann::json::parse(answers[0].message);
  EXPECT_EQ(json["state"], "published");
  EXPECT_EQ(json["folder"], (maps / "kitchen").string());
  EXPECT_EQ(json["saved"], "a map");
  load("kitchen");
  work(2);
  EXPECT_EQ(answers[1].message, "taken over");
  EXPECT_EQ(taken_over, 1);
}

TEST_F(MapCommandsTest, PathsLinksPipesDevicesAndFoldersAreRefused) {
  std::filesystem::create_directories(maps / "pipe");
  std::filesystem::create_directories(maps / "folder" / "map.rds");
  std::filesystem::create_directories(maps / "device");
  ASSERT_EQ(mkfifo((maps / "pipe" / "map.rds").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", maps / "device" / "map.rds");
  std::filesystem::create_symlink("/dev", maps / "link");
  std::size_t refused = 0;
  for (const char* name : {"/dev/zero", "../etc", "pipe", "folder", "device", "link", "none"}) {
    load(name);
    work(++refused);
    EXPECT_FALSE(answers.back().success) << name;
  }
  EXPECT_THAT(answers[0].message, HasSubstr("not the name of a map"));
  EXPECT_THAT(answers[2].message, HasSubstr("is no regular file"));
  EXPECT_EQ(taken_over, 0);
}

TEST_F(MapCommandsTest, AFileThatIsTooLargeIsNotRead) {
  save("kitchen");
  work(1);
  std::filesystem::resize_file(maps / "kitchen" / "map.rds", 1'000'001);
  config.max_map_mb = 1;
  commands = std::make_unique<MapCommands>(mailbox, config, "mapper");
  load("kitchen");
  work(2);
  EXPECT_THAT(answers[1].message, HasSubstr("has 1000001 bytes, expected at most 1000000"));
}

TEST_F(MapCommandsTest, WhileADiskHangsTheWorkerGoesOnAndAnswersInTime) {
  commands = std::make_unique<MapCommands>(mailbox, config, "mapper", 300ms);
  std::filesystem::create_directories(maps / "kitchen");
  std::promise<void> hangs;
  block = hangs.get_future().share();
  load("kitchen");
  EXPECT_TRUE(answers.empty()) << "the worker does not wait";
  save("other");
  EXPECT_THAT(answers.at(0).message, HasSubstr("busy"));
  while (answers.size() < 2) {  // a worker looks again now and then
    mailbox.wait_for({}, 50ms, [this] { return commands->locked_ready(); });
    commands->settle();
  }
  EXPECT_THAT(answers[1].message, HasSubstr("not done within 0.3 s"));
  load("kitchen");
  EXPECT_THAT(answers.at(2).message, HasSubstr("busy")) << "the disk still hangs";
  hangs.set_value();
  while (!mailbox.wait_for({}, 20s, [this] { return commands->locked_ready(); })) FAIL();
  commands->settle();
  EXPECT_EQ(answers.size(), 3U) << "what comes too late is thrown away";
  save("other");
  work(4);
  EXPECT_TRUE(answers[3].success) << answers[3].message;
}

TEST_F(MapCommandsTest, AnExceptionIsAnAnswer) {
  std::filesystem::create_directories(maps / "kitchen");
  commands->load(command("load", "kitchen"),
                 [](const auto&, const auto&) -> tl::expected<MapCommands::Completion, std::string> {
                   throw std::runtime_error("spoiled");
                 });
  work(1);
  EXPECT_EQ(answers[0].message, "spoiled");
}

TEST_F(MapCommandsTest, AFullDiskIsSaidAndLeavesTheEarlierMap) {
  save("kitchen");
  work(1);
  {
    const test::FileSizeLimit limit(50);
    save("kitchen");
    work(2);
  }
  EXPECT_FALSE(answers[1].success);
  EXPECT_THAT(answers[1].message, HasSubstr("cannot be written"));
  load("kitchen");
  work(3);
  EXPECT_TRUE(answers[2].success) << answers[2].message;
}

TEST_F(MapCommandsTest, WhatIsUnderWayAtAStopIsAnswered) {
  std::filesystem::create_directories(maps / "kitchen");
  load("kitchen");
  commands.reset();
  EXPECT_EQ(answers.at(0).message, "the service has stopped");
}

}  // namespace
}  // namespace rds::map_commands
