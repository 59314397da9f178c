// SPDX-License-Identifier: Apache-2.0
// Bad input: one sentence that names the place, exit status 2, and nothing that looks like a result.
#include <fstream>

#include <gmock/gmock.h>

#include "tests/integration/run_support.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

using ::testing::HasSubstr;

class BadInput : public ::testing::Test {
 protected:
  void SetUp() override { make_small_dataset(data(), 6); }
  std::filesystem::path data() const { return place_ / "data"; }

  void replace(const std::string& file, const std::string& from, const std::string& to) const {
    std::string text = read_text(data() / file);
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write_text(data() / file, text.replace(at, from.size(), to));
  }

  /// Runs and expects exit status 2 and a sentence with these words.
  void expect_refused(const std::vector<std::string>& words,
                      const std::vector<std::string>& arguments = {}) const {
    std::vector<std::string> all{"--rate", "max", "--no-dynamics"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProcessResult result = run(data(), place_ / "out", all, std::chrono::seconds(60));
    EXPECT_EQ(result.status, 2) << result.standard_error;
    for (const std::string& word : words) EXPECT_THAT(result.standard_error, HasSubstr(word));
    EXPECT_FALSE(exists(place_ / "out" / "summary.json"));
  }

  TemporaryFolder place_;
};

TEST_F(BadInput, MissingFolder) {
  std::filesystem::remove_all(data());
  expect_refused({data().string()});
}

TEST_F(BadInput, BagsThatAreNone) {
  std::filesystem::remove_all(data());
  for (const std::string name : {"a.mcap", "a.db3"}) {
    const auto file = place_ / name;
    write_text(file,
               "this is text, and long enough to have the header of a file of either kind, and more of it\n");
    const ProcessResult result = run(file, place_ / "out", {"--rate", "max"}, std::chrono::seconds(60));
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.standard_error, HasSubstr(name));
    EXPECT_EQ(std::ranges::count(result.standard_error, '\n'), 1) << result.standard_error;
  }
}

TEST_F(BadInput, MissingList) {
  std::filesystem::remove(data() / "depth.txt");
  expect_refused({"depth.txt"});
}

TEST_F(BadInput, MalformedLineIsNamedWithItsNumber) {
  const std::string text = read_text(data() / "rgb.txt");
  write_text(data() / "rgb.txt", text + "not a stamp\n");
  const auto lines = std::ranges::count(text, '\n') + 1;
  expect_refused({"rgb.txt:" + std::to_string(lines)});
}

TEST_F(BadInput, NegativeFocalLengthAndUnknownKey) {
  replace("camera.yaml", "fx: ", "fx: -");
  expect_refused({"camera.yaml", "fx"});
}

TEST_F(BadInput, FirstPictureCutShort) {
  const auto picture = std::filesystem::directory_iterator(data() / "rgb")->path();
  for (const auto& entry : std::filesystem::directory_iterator(data() / "rgb"))
    std::filesystem::resize_file(entry.path(), 100);
  expect_refused({"rgb/"});
}

TEST_F(BadInput, UnknownOptionAndValue) {
  expect_refused({"--speed"}, {"--speed", "3"});
  expect_refused({"--bus"}, {"--bus", "zeromq"});
  expect_refused({"--bus: expected zenoh for all processes or for none, it does not meet DDS"},
                 {"--bus", "tracker=zenoh"});
}

TEST_F(BadInput, ConfigurationWithAllItsFaultsAtOnce) {
  const std::string file = place_ / "config.yaml";
  write_text(file,
             "tracker:\n  extraction: {features: -5, colour: red}\n  typo: 1\nmapper:\n  lockstep: "
             "perhaps\nwheels: 4\n");
  expect_refused({file + ": tracker.extraction.features: -5", "tracker.extraction.colour: unknown key",
                  "tracker.typo: unknown key", "mapper.lockstep: perhaps", "wheels: unknown key"},
                 {"--config", file});
}

TEST_F(BadInput, PosesThatCannotBeFollowed) {
  const auto poses = place_ / "poses.txt";
  const std::vector<std::string> arguments{"--poses", poses.string()};
  expect_refused({"poses.txt: cannot be read"}, arguments);
  write_text(poses, "10.0 0 0 0 0 0 0 1\n10.1 0 0 0 0 0 0 0\n");
  expect_refused({"poses.txt:2: expected"}, arguments);
  write_text(poses, "10.1 0 0 0 0 0 0 1\n10.0 0 0 0 0 0 0 1\n");
  expect_refused({"poses.txt:2: stamp 10.0 goes back"}, arguments);
  write_text(poses, "90.0 0 0 0 0 0 0 1\n");
  expect_refused({"poses.txt: expected poses between 10.000000 and"}, arguments);
}

TEST_F(BadInput, OutputThatHoldsSomethingElse) {
  write_text(place_ / "out" / "thesis.tex", "precious");
  expect_refused({(place_ / "out").string()}, {"--force"});
  EXPECT_TRUE(exists(place_ / "out" / "thesis.tex"));
}

TEST_F(BadInput, MissingNetworkSaysHowToGetIt) {
  const ProcessResult result =
      run_process({rds(), "run", "--dataset", data().string(), "--out", (place_ / "out").string(), "--model",
                   "yolox_nano"},
                  std::chrono::seconds(60),
                  {{"RDS_SHARED", place_.path().string()}, {"XDG_CACHE_HOME", place_.path().string()}});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.standard_error, HasSubstr("yolox_nano"));
}

TEST(BadPeers, ANameThatNobodyHasIsRefusedInASentence) {
  const ProcessResult result =
      run_process({RDS_BIN_DIR "/rds-tracker", "--domain", "7", "--peers", "127.0.0.1,no-such-host.invalid"},
                  std::chrono::seconds(60));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.standard_error, HasSubstr("peer 'no-such-host.invalid': "));
  EXPECT_EQ(std::ranges::count(result.standard_error, '\n'), 1) << result.standard_error;
}

}  // namespace
}  // namespace rds::test
