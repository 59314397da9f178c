// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <gtest/gtest.h>

#include "tools/rds/cli/commands.hpp"

namespace rds::tools {
namespace {

/// Exit status and what stands on stderr.
std::pair<int, std::string> run(std::vector<std::string> arguments) {
  CLI::App app;
  add_simulate_command(app);
  std::reverse(arguments.begin(), arguments.end());
  ::testing::internal::CaptureStderr();
  int status = 0;
  try {
    app.parse(arguments);
  } catch (const CLI::RuntimeError& e) {
    status = e.get_exit_code();
  }
  return {status, ::testing::internal::GetCapturedStderr()};
}

TEST(SimulateCommand, BadValuesEndWithStatus2AndASentence) {
  const std::string out = (std::filesystem::temp_directory_path() / "rds_simulate_never_made").string();
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--path", "spiral"}, "--path spiral: expected static|xyz|rpy|halfsphere|loop"},
      {{"--world", "tower"}, "--world tower: expected room|floor"},
      {{"--world", "floor", "--rooms", "7"}, "--rooms 7: expected 8 … 30"},
      {{"--world", "floor", "--rooms", "31"}, "--rooms 31: expected 8 … 30"},
      {{"--world", "floor", "--path", "loop"}, "--path: expected with --world room only"},
      {{"--rooms", "12"}, "--rooms: expected together with --world floor"},
      {{"--people", "-1"}, "--people -1: expected 0 … 8"},
      {{"--people", "99"}, "--people 99: expected 0 … 8"},
      {{"--seconds", "0"}, "--seconds 0: expected more than 0"},
      {{"--seconds", "nan"}, "--seconds nan: expected more than 0"},
      {{"--size", "640"}, "--size 640: expected WIDTHxHEIGHT, 64 … 4096 px each"},
      {{"--size", "640x480x3"}, "--size 640x480x3: expected WIDTHxHEIGHT"},
      {{"--size", "20x480"}, "--size 20x480: expected WIDTHxHEIGHT"},
      {{"--fps", "0"}, "--fps 0: expected 1 … 240"},
      {{"--distortion", "-5,0,0,0,0"}, "--distortion -5,0,0,0,0: lens: the distortion"},
      {{"--depth-scale", "nan"}, "--depth-scale nan: expected 100 … 13000 units per metre"},
      {{"--threads", "-2"}, "--threads -2: expected 0"}};
  for (const auto& [arguments, sentence] : cases) {
    std::vector<std::string> all{"simulate", "--out", out};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const auto [status, text] = run(all);
    EXPECT_EQ(status, 2) << sentence;
    EXPECT_NE(text.find(sentence), std::string::npos) << text;
    EXPECT_FALSE(std::filesystem::exists(out));
  }
}

TEST(SimulateCommand, AFolderThatCannotBeWrittenEndsWithStatus2) {
  const auto [status, text] =
      run({"simulate", "--out", "/proc/no/such/folder", "--seconds", "0.05", "--people", "0"});
  EXPECT_EQ(status, 2);
  EXPECT_NE(text.find("/proc/no/such/folder"), std::string::npos) << text;
}

}  // namespace
}  // namespace rds::tools
